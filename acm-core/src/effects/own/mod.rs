//! Effects of one's own: equations from a file, traced, compared, saved and streamed like those of the library.
//!
//! ```text
//! static    x' = f(x, u, t; θ)
//! update    z_k = f(z_{k−1}, x_k, u_k; θ),   x'_k = g(z_k, x_k, u_k; θ)
//! rate      ż = f(z, x, u, t; θ),            x' = g(z, x, u, t; θ)
//! ```
//!
//! | symbol | meaning                                                                    |
//! | ------ | -------------------------------------------------------------------------- |
//! | `x`    | the column: `q` of actuators, `y` of outputs, `x`, `y`, `z` of a frame     |
//! | `z`    | states; at the first sample of a trial as `start` says, else 0             |
//! | `u`    | inputs: signals and their derivatives, straight between samples, as x is   |
//! | `t`    | time since the first sample, s                                             |
//! | `θ`    | parameters and constants                                                   |
//!
//! | room                                  | what                                                  |
//! | ------------------------------------- | ----------------------------------------------------- |
//! | [`definition`]                        | the file's tables                                     |
//! | `sound`                               | whether names and numbers can be used                 |
//! | `expression`, `function`, `units`, `dimensions` | expressions, and whether their units fit    |
//! | `affine`, `phi`                       | whether a rate is linear, and its exact step          |
//! | `program`, `plan`, `run`              | from a definition to numbers                          |
//! | `rig`                                 | a plan on one rig                                     |
//!
//! A rate that is linear in states and inputs, with coefficients of parameters and constants alone, is integrated exactly; any
//! other by the classical Runge–Kutta method, in a number of steps that does not depend on the parameters. Where all sizes are
//! at their silent values, the column is unchanged. Pieces of any length give the same bits.

mod affine;
pub mod definition;
mod dimensions;
mod expression;
mod fault;
mod function;
mod phi;
mod plan;
mod program;
mod rig;
mod run;
mod sound;
mod units;

use std::sync::Arc;

use serde::Deserialize;

use super::{Carrier, Commutes, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values};
use definition::{Definition, Derived, Place};
pub use fault::OwnError;
use plan::{Form, Plan};
use rig::{Parameters, Ports};
use run::{Piece, Track};

/// An effect of one's own on one rig.
pub struct Own {
    definition: Definition,
    plan: Plan,
    ports: Ports,
    /// For each of the carriers.
    parameters: Vec<Parameters>,
    meaning: String,
    source: String,
}

/// A file of effects.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    effect: Vec<Definition>,
}

/// Reads the text of a file of effects, `[[effect]]` for each, and checks what can be checked without a rig; `file` is its name,
/// for errors and results.
///
/// # Errors
/// An invalid file, or an invalid effect: with effect, key, value and remedy.
pub fn read(text: &str, file: &str) -> Result<Vec<Definition>, OwnError> {
    let read: File = toml::from_str(text).map_err(|error| {
        let help = "see the chapter \"Effects of one's own\" of the book for the keys";
        OwnError::new("", error.to_string().trim_end().to_string(), help).of(file, "")
    })?;
    if read.effect.is_empty() {
        return Err(OwnError::new("effect", "is empty", "write one [[effect]] at least").of(file, ""));
    }
    check(read.effect, file)
}

/// Checks what can be checked of definitions without a rig; `file` is the name of what holds them.
///
/// # Errors
/// As [`read`].
pub fn check(definitions: Vec<Definition>, file: &str) -> Result<Vec<Definition>, OwnError> {
    let mut all: Vec<Definition> = vec![];
    for mut definition in definitions {
        let wrong = |fault: OwnError| fault.of(file, &definition.name);
        if all.iter().any(|other| other.name == definition.name) {
            return Err(wrong(OwnError::new("name", "is there twice", "give each effect a name of its own")));
        }
        if !definition.file.is_empty() {
            return Err(wrong(OwnError::new("file", "is filled in on reading", "leave it out")));
        }
        Plan::new(&definition).map_err(wrong)?;
        definition.file = file.to_string();
        all.push(definition);
    }
    Ok(all)
}

impl Own {
    /// The effect on a rig.
    ///
    /// # Errors
    /// A definition that is invalid there: a signal that is missing or has another unit, values without a finite result, or
    /// sizes that are not silent where they should be.
    pub fn new(definition: &Definition, rig: &Rig) -> Result<Arc<Self>, OwnError> {
        let wrong = |fault: OwnError| fault.of(&definition.file, &definition.name);
        let plan = Plan::new(definition).map_err(wrong)?;
        let ports = Ports::new(definition, &plan, rig).map_err(wrong)?;
        let of = |carrier: &Carrier| Parameters::new(definition, &plan, &ports, rig, *carrier);
        let parameters = ports.carriers.iter().map(of).collect();
        let words = |text: &str, other: String| if text.is_empty() { other } else { text.to_string() };
        let own = format!("an effect of {}", if definition.file.is_empty() { "one's own" } else { &definition.file });
        let source = if definition.source.is_empty() { own.clone() } else { format!("{own}; {}", definition.source) };
        let effect = Self {
            meaning: words(&definition.meaning, own),
            source,
            definition: definition.clone(),
            plan,
            ports,
            parameters,
        };
        effect.is_sound(rig).map_err(wrong)?;
        Ok(Arc::new(effect))
    }

    /// As it was written.
    pub fn definition(&self) -> &Definition {
        &self.definition
    }

    /// Whether its rate is integrated exactly; none without a rate.
    pub fn is_exact(&self) -> Option<bool> {
        match self.plan.form {
            Form::Linear(_) => Some(true),
            Form::RungeKutta { .. } => Some(false),
            _ => None,
        }
    }

    /// Of an effect that is not silent.
    fn remedy(&self) -> &'static str {
        match self.plan.form {
            Form::RungeKutta { .. } => {
                "a rate that is not linear cannot be infinitely fast: let a size multiply what is added, as in \
                 q + a*(z - q), and bound time constants away from 0"
            }
            _ => "correct the equation, or `silent`: there the column must stay as it is",
        }
    }

    fn of(&self, carrier: Carrier) -> Option<&Parameters> {
        let at = self.ports.carriers.iter().position(|own| *own == carrier)?;
        self.parameters.get(at)
    }

    /// Tests it on waves over the rig's ranges: finite at every guess, and almost silent close to its silent values.
    fn is_sound(&self, rig: &Rig) -> Result<(), OwnError> {
        let (record, outputs) = waves(rig);
        for (carrier, parameters) in self.ports.carriers.iter().zip(&self.parameters) {
            let act = |theta: &[f64]| {
                let mut columns =
                    if self.site() == Site::Actuation { record.actuators.clone() } else { outputs.clone() };
                let before = columns.clone();
                self.act(*carrier, Values::constant(&parameters.specs, theta), &record, &mut columns);
                (before, columns)
            };
            let told = |theta: &[f64]| -> String {
                let each = parameters
                    .specs
                    .iter()
                    .zip(theta)
                    .map(|(spec, value)| format!("{} = {value} {}", spec.name, spec.unit));
                each.collect::<Vec<_>>().join(", ")
            };
            if let Some(theta) =
                parameters.guesses.iter().find(|theta| !act(theta).1.iter().flatten().all(|x| x.is_finite()))
            {
                let what = format!("has no finite result at {}", told(theta));
                let help = "bound what divides away from 0; a rate that is not linear and fast needs more `steps`";
                return Err(OwnError::new("guesses", what, help));
            }
            let Some(guess) = parameters.guesses.first() else { continue };
            let near = |(spec, value): (&ParameterSpec, &f64)| match spec.may_vary {
                true => spec.neutral + NEXT * (value - spec.neutral),
                false => *value,
            };
            let theta: Vec<f64> = parameters.specs.iter().zip(guess).map(near).collect();
            let (before, after) = act(&theta);
            let spread =
                |x: &[f64]| x.iter().fold(f64::MIN, |m, x| m.max(*x)) - x.iter().fold(f64::MAX, |m, x| m.min(*x));
            let off = |(a, b): (&Vec<f64>, &Vec<f64>)| {
                // A constant column is measured by a thousandth of its value; one at 0 is not tested.
                let size = spread(a).max(1e-3 * a.iter().fold(0.0, |most, x| x.abs().max(most)));
                let off = a.iter().zip(b).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
                if size > 0.0 { off / size } else { 0.0 }
            };
            let off = before.iter().zip(&after).map(off).fold(0.0, f64::max);
            if !(off < SILENT) {
                let much = if off < 10.0 { format!("{:.0} % of its range", 100.0 * off) } else { "without end".into() };
                let (near, what) = (told(&theta), "is not silent where it should be: next to its silent values");
                let what = format!("{what} ({near}) it changes a column by {much}");
                return Err(OwnError::new("silent", what, self.remedy()));
            }
        }
        Ok(())
    }
}

/// Distance from the silent values in that test, as a share of a guess, and largest effect there, as a share of a range.
const NEXT: f64 = 1e-7;
const SILENT: f64 = 1e-3;

/// Every signal as a wave over its range.
fn waves(rig: &Rig) -> (Record, Vec<Vec<f64>>) {
    let step = if rig.step > 0.0 && rig.step.is_finite() { rig.step } else { 1.0 };
    let time: Vec<f64> = (0..WAVES).map(|k| k as f64 * step).collect();
    let mut number = 0;
    let mut wave = |signal: &crate::rig::Signal| -> Vec<f64> {
        number += 1;
        let of =
            |k: usize| 0.5 * (1.0 + (0.11 * (1.0 + 0.3 * f64::from(number % 5)) * k as f64 + f64::from(number)).sin());
        (0..WAVES).map(|k| signal.low + signal.span() * of(k)).collect()
    };
    let actuators = rig.actuators.iter().map(&mut wave).collect();
    let contexts = rig.contexts.iter().map(&mut wave).collect();
    let outputs = rig.outputs.iter().map(&mut wave).collect();
    let acceleration = vec![vec![0.0; WAVES]; if rig.carried { 3 } else { 0 }];
    (Record::new(time, actuators, contexts, acceleration), outputs)
}

const WAVES: usize = 96;

impl std::fmt::Debug for Own {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} of {}", self.definition.name, self.definition.file)
    }
}

impl Effect for Own {
    fn name(&self) -> &str {
        &self.definition.name
    }

    fn meaning(&self) -> &str {
        &self.meaning
    }

    fn site(&self) -> Site {
        match self.definition.place {
            Place::Actuators => Site::Actuation,
            Place::Outputs => Site::Output,
            Place::Frame => Site::Frame,
        }
    }

    fn source(&self) -> &str {
        &self.source
    }

    fn traits(&self) -> Traits {
        let linear = matches!(self.plan.form, Form::Linear(_)) && self.site() == Site::Actuation;
        let all = self.definition.columns.is_empty() && self.definition.inputs.is_empty();
        let alike = self.definition.parameters.values().all(|p| !p.each);
        Traits {
            is_static: self.plan.is_static,
            is_output_filter: self.plan.is_filter && self.site() == Site::Output && self.definition.columns.is_empty(),
            commutes: if linear && all && alike { Commutes::WithFilters } else { Commutes::No },
            shows_against_rate: self.definition.inputs.values().any(|input| input.derivative.is_some()),
            ..Traits::default()
        }
    }

    fn carriers(&self, _: &Rig) -> Vec<Carrier> {
        self.ports.carriers.clone()
    }

    fn parameters(&self, _: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        self.of(carrier).map_or(vec![], |own| own.specs.clone())
    }

    fn initial_guesses(&self, _: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        self.of(carrier).map_or(vec![], |own| own.guesses.clone())
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        let Some(parameters) = self.of(carrier) else { return };
        let (start, is_whole) = (memory.start(&record.time), memory.is_whole());
        let [track] = memory.states::<Track>(1) else { return };
        let signal = |input: &Carrier| match if *input == Carrier::Rig { carrier } else { *input } {
            Carrier::Rig => None,
            Carrier::Actuator(a) => record.actuators.get(a),
            Carrier::Context(c) => record.contexts.get(c),
        };
        let inputs = self.definition.inputs.values();
        track.derivatives.resize_with(inputs.len(), Default::default);
        track.derived.resize_with(inputs.len(), Vec::new);
        let mut signals: [Option<&[f64]>; MOST_INPUTS] = [None; MOST_INPUTS];
        for (k, (input, port)) in inputs.zip(&self.ports.inputs).enumerate() {
            let Some(signal) = signal(port) else { return };
            match input.derivative {
                None => signals[k] = Some(signal),
                Some(derivative) => {
                    let window = input
                        .window
                        .as_ref()
                        .and_then(|name| self.definition.parameters.keys().position(|p| p == name));
                    let window = window.map_or(0.0, |p| values.at(parameters.slots[p].0, 0));
                    let stream = (!is_whole).then_some(&mut track.derivatives[k]);
                    let found = record.derivatives(signal, window, stream);
                    track.derived[k].clear();
                    track.derived[k].extend(found.iter().map(|d| match derivative {
                        Derived::Rate => d.rate,
                        Derived::Acceleration => d.acceleration,
                    }));
                }
            }
        }
        let piece = Piece {
            time: &record.time,
            start,
            inputs: &signals[..self.ports.inputs.len()],
            values,
            slots: &parameters.slots,
            silent: &parameters.silent,
            lanes: &self.ports.lanes,
        };
        self.plan.proceed(&piece, track, columns);
    }

    /// Of a linear rate: one over the real part of its slowest pole.
    fn memory(&self, values: Values) -> Option<f64> {
        let parameters = self.parameters.first()?;
        let slowest = self.plan.slowest(&values, &parameters.slots)?;
        (slowest > 0.0 && slowest.is_finite()).then_some(1.0 / slowest)
    }
}

/// As many as a definition may have.
const MOST_INPUTS: usize = 40;
