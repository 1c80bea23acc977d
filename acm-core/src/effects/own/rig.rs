//! A plan on one rig: which signals its names are, and its parameters in their units.

use super::definition::{Definition, Parameter, Place};
use super::fault::OwnError;
use super::plan::Plan;
use super::sound::CARRIER;
use super::units::{Dimension, Unit, parse};
use crate::effects::actuation::actuators;
use crate::effects::frame::frames;
use crate::effects::output::carrying;
use crate::effects::{Carrier, ParameterSpec, Rig, guesses};
use crate::rig::Signal;

/// Where the names of a definition are on one rig.
#[derive(Debug, Clone)]
pub struct Ports {
    /// Columns that it acts on: for each name of the plan, one for each lane.
    pub lanes: Vec<Vec<usize>>,
    /// The signal of each input; the rig as a whole stands for what carries the effect.
    pub inputs: Vec<Carrier>,
    /// Its possible carriers.
    pub carriers: Vec<Carrier>,
}

/// Initial guesses at most, all parameters together, and for each column that has them alone.
const MOST_GUESSES: usize = 100;
const ALONE: usize = 6;
const FEW: usize = 6;

impl Ports {
    /// Finds the signals.
    ///
    /// # Errors
    /// A signal that the rig lacks, or that is in another unit.
    pub fn new(definition: &Definition, plan: &Plan, rig: &Rig) -> Result<Self, OwnError> {
        let lanes = lanes(definition, plan, rig)?;
        let inputs = definition.inputs.iter().zip(&plan.inputs).map(|((name, input), unit)| {
            if input.signal == CARRIER {
                return Ok(Carrier::Rig);
            }
            let key = format!("inputs.{name}");
            let carrier = named(&input.signal, rig).ok_or_else(|| {
                let what = format!("reads {:?}, which is no signal of these data", input.signal);
                OwnError::new(&key, what, format!("signals: {}", signals(rig)))
            })?;
            is_in(&key, carrier, unit, rig)?;
            Ok(carrier)
        });
        let inputs = inputs.collect::<Result<Vec<_>, _>>()?;
        let carriers = carriers(definition, plan, &lanes, rig)?;
        Ok(Self { lanes, inputs, carriers })
    }
}

fn signals(rig: &Rig) -> String {
    rig.actuators.iter().chain(&rig.contexts).map(|signal| signal.name.clone()).collect::<Vec<_>>().join(" ")
}

fn named(name: &str, rig: &Rig) -> Option<Carrier> {
    let actuator = rig.actuators.iter().position(|q| q.name == name).map(Carrier::Actuator);
    actuator.or_else(|| rig.contexts.iter().position(|c| c.name == name).map(Carrier::Context))
}

fn is_in(key: &str, carrier: Carrier, unit: &Unit, rig: &Rig) -> Result<(), OwnError> {
    let Some(signal) = carrier.signal(rig) else { return Ok(()) };
    fits(key, signal, unit)
}

/// Whether a signal has the dimension that the definition says.
fn fits(key: &str, signal: &Signal, unit: &Unit) -> Result<(), OwnError> {
    let open = unit.dimension == Dimension::COLUMN || unit.dimension == Dimension::CARRIER;
    let found = parse(&signal.unit, &[]).map(|unit| unit.dimension);
    if open || found.as_ref() == Ok(&unit.dimension) {
        return Ok(());
    }
    let what = format!("says {} of {:?}, which is in {}", unit.dimension, signal.name, signal.unit);
    Err(OwnError::new(key, what, "write the unit that the data have, or name another signal"))
}

fn lanes(definition: &Definition, plan: &Plan, rig: &Rig) -> Result<Vec<Vec<usize>>, OwnError> {
    let all = match definition.place {
        Place::Actuators => &rig.actuators,
        Place::Outputs | Place::Frame => &rig.outputs,
    };
    if definition.place == Place::Frame {
        if let Some(name) = definition.columns.first() {
            let help = "leave it out: all markers are in one frame";
            return Err(OwnError::new("columns", format!("names {name:?}"), help));
        }
        if frames::any(rig).is_empty() {
            let help = "choose place = \"outputs\", or give data whose outputs are x, y, z of markers in m";
            return Err(OwnError::new("place", "is `frame`, and these data have none", help));
        }
        return Ok((0..3).map(|k| (k..rig.outputs.len()).step_by(3).collect()).collect());
    }
    let found = |name: &String| {
        all.iter().position(|signal| signal.name == *name).ok_or_else(|| {
            let known = all.iter().map(|signal| signal.name.as_str()).collect::<Vec<_>>().join(" ");
            OwnError::new("columns", format!("names {name:?}, which these data lack"), format!("there are: {known}"))
        })
    };
    let lanes: Vec<usize> = match &definition.columns[..] {
        [] => (0..all.len()).collect(),
        names => names.iter().map(found).collect::<Result<_, _>>()?,
    };
    let mut once = lanes.clone();
    once.sort_unstable();
    once.dedup();
    if once.len() < lanes.len() {
        return Err(OwnError::new("columns", "names one signal twice", "name each once"));
    }
    if let Some(unit) = &plan.column {
        lanes.iter().try_for_each(|&column| fits("unit", &all[column], unit))?;
    }
    Ok(vec![lanes])
}

/// The columns of the first name.
fn columns<'a>(definition: &Definition, lanes: &[Vec<usize>], rig: &'a Rig) -> Vec<&'a Signal> {
    let all = if definition.place == Place::Actuators { &rig.actuators } else { &rig.outputs };
    lanes[0].iter().map(|&column| &all[column]).collect()
}

fn carriers(definition: &Definition, plan: &Plan, lanes: &[Vec<usize>], rig: &Rig) -> Result<Vec<Carrier>, OwnError> {
    let moves = match definition.place {
        Place::Frame => rig.outputs.iter().any(Signal::varies),
        _ => columns(definition, lanes, rig).into_iter().any(Signal::varies),
    };
    if !moves {
        return Ok(vec![]);
    }
    if definition.carriers.is_empty() {
        return Ok(vec![Carrier::Rig]);
    }
    let unit = definition.inputs.values().zip(&plan.inputs).find(|(input, _)| input.signal == CARRIER);
    let mut all = vec![];
    for name in &definition.carriers {
        let group: Vec<Carrier> = match name.as_str() {
            "actuators" => (0..rig.actuators.len()).map(Carrier::Actuator).collect(),
            "contexts" => (0..rig.contexts.len()).map(Carrier::Context).collect(),
            _ => {
                let carrier = named(name, rig).ok_or_else(|| {
                    let what = format!("names {name:?}, which is no signal of these data");
                    OwnError::new("carriers", what, format!("write actuators, contexts, or of these: {}", signals(rig)))
                })?;
                if let Some((_, unit)) = unit {
                    is_in("carriers", carrier, unit, rig)?;
                }
                vec![carrier]
            }
        };
        // Of a group, those that move and have the unit.
        let can = |c: &Carrier| {
            let moves = c.signal(rig).is_some_and(Signal::varies);
            moves && unit.is_none_or(|(_, unit)| is_in("", *c, unit, rig).is_ok())
        };
        all.extend(group.into_iter().filter(can));
    }
    all.dedup();
    Ok(all)
}

/// Parameters of a definition as a fit sees them, and where each begins.
pub struct Parameters {
    /// All.
    pub specs: Vec<ParameterSpec>,
    /// First place of each parameter of the definition, and whether each column has its own.
    pub slots: Vec<(usize, bool)>,
    /// The value at which each size does nothing, SI, by parameter of the definition.
    pub silent: Vec<(usize, f64)>,
    /// To start a fit from.
    pub guesses: Vec<Vec<f64>>,
}

/// A parameter of the definition for one lane, SI.
struct Scaled {
    lower: f64,
    upper: f64,
    silent: Option<f64>,
    guesses: Vec<f64>,
    unit: String,
}

impl Parameters {
    /// Of this rig and carrier.
    pub fn new(definition: &Definition, plan: &Plan, ports: &Ports, rig: &Rig, carrier: Carrier) -> Self {
        let columns = columns(definition, &ports.lanes, rig);
        let (mut specs, mut slots, mut silent, mut lists) = (vec![], vec![], vec![], vec![]);
        for ((p, (name, parameter)), unit) in definition.parameters.iter().enumerate().zip(&plan.units) {
            slots.push((specs.len(), parameter.each));
            let own = if parameter.each { &columns[..] } else { &columns[..1] };
            for column in own {
                let name = if parameter.each { format!("{name}_{}", column.name) } else { name.clone() };
                let widest = columns.iter().map(|q| range(q)).fold(0.0, f64::max);
                let scaled =
                    scaled(parameter, unit, column, if parameter.each { None } else { Some(widest) }, (rig, carrier));
                if specs.len() == slots[p].0 {
                    silent.extend(scaled.silent.map(|value| (p, value)));
                }
                specs.push(spec(name, &scaled, plan.is_additive));
                lists.push(scaled.guesses);
            }
        }
        let guesses = all_guesses(definition, (&specs, &lists), &slots, &columns, plan.is_additive);
        Self { specs, slots, silent, guesses }
    }
}

fn range(signal: &Signal) -> f64 {
    actuators::travel(signal)
}

/// Numbers in SI: times the unit's scale and the ranges of signals whose units it names.
fn scaled(
    parameter: &Parameter,
    unit: &Unit,
    column: &Signal,
    widest: Option<f64>,
    (rig, carrier): (&Rig, Carrier),
) -> Scaled {
    let [of_column, of_carrier] = unit.dimension.open();
    let carried = carrying::range(rig, carrier);
    // An actuator at rest has sizes between 0 and 0, also where its range divides.
    let own = widest.unwrap_or_else(|| range(column));
    let powered = |range: f64, power: f64| if power == 0.0 { 1.0 } else { range.powf(power) };
    let factor = unit.scale * powered(own, of_column) * powered(carried.1, of_carrier);
    let factor = if factor.is_finite() { factor } else { 0.0 };
    let named = [("q", column.unit.as_str()), ("y", column.unit.as_str()), (CARRIER, carried.0.as_str())];
    Scaled {
        lower: factor * parameter.bounds[0],
        upper: factor * parameter.bounds[1],
        silent: parameter.silent.map(|value| factor * value),
        guesses: parameter.guesses.iter().map(|guess| factor * guess).collect(),
        unit: unit.si(&named),
    }
}

fn middle(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

fn spec(name: String, scaled: &Scaled, is_additive: bool) -> ParameterSpec {
    let typical = middle(&scaled.guesses);
    let bounded = |spec: ParameterSpec| spec.within(scaled.lower, scaled.upper);
    match scaled.silent {
        Some(silent) => {
            let scale = (typical - silent).abs();
            let spec = ParameterSpec { neutral: silent, ..ParameterSpec::size(name, &scaled.unit, scale) };
            ParameterSpec { linear: is_additive, ..bounded(spec) }
        }
        None => {
            let reach = 0.25 * (scaled.upper - scaled.lower);
            let scale = if typical == 0.0 { reach } else { typical.abs().min(reach) };
            bounded(ParameterSpec::shape(name, &scaled.unit, typical, scale))
        }
    }
}

/// All combinations of guesses, thinned; then, where columns have their own sizes, each alone.
fn all_guesses(
    definition: &Definition,
    (specs, lists): (&[ParameterSpec], &[Vec<f64>]),
    slots: &[(usize, bool)],
    columns: &[&Signal],
    is_additive: bool,
) -> Vec<Vec<f64>> {
    // Number of guesses in each parameter's list.
    let counts: Vec<usize> = definition
        .parameters
        .values()
        .map(|p| if is_additive && p.silent.is_some() { 1 } else { p.guesses.len() })
        .collect();
    let total = counts.iter().fold(1usize, |all, n| all.saturating_mul(*n));
    let chosen: Vec<usize> = if total <= MOST_GUESSES {
        (0..total).collect()
    } else {
        (0..MOST_GUESSES).map(|k| (k as u128 * (total - 1) as u128 / (MOST_GUESSES as u128 - 1)) as usize).collect()
    };
    let point = |mut k: usize| -> Vec<usize> {
        let digit = |n: &usize| {
            let digit = k % n;
            k /= n;
            digit
        };
        counts.iter().map(digit).collect()
    };
    let points: Vec<Vec<usize>> = chosen.into_iter().map(point).collect();
    let at = |point: &Vec<usize>, alone: Option<usize>| -> Vec<f64> {
        let mut theta: Vec<f64> = specs.iter().map(|spec| spec.neutral).collect();
        for ((p, parameter), &(first, is_each)) in definition.parameters.values().enumerate().zip(slots) {
            for lane in 0..if is_each { columns.len() } else { 1 } {
                let spec = &specs[first + lane];
                let is_size = parameter.silent.is_some();
                if is_each && is_size && alone.is_some_and(|one| one != lane) {
                    continue;
                }
                // All columns begin from the same entries of their lists.
                let guess =
                    if is_additive && is_size { spec.neutral + spec.scale } else { lists[first + lane][point[p]] };
                theta[first + lane] = spec.inside(guess);
            }
        }
        theta
    };
    let mut all: Vec<Vec<f64>> = points.iter().map(|point| at(point, None)).collect();
    let moving: Vec<usize> = (0..columns.len()).filter(|&lane| range(columns[lane]) > 0.0).collect();
    let has_own = definition.parameters.values().any(|p| p.each && p.silent.is_some());
    if has_own && !is_additive && (2..=FEW).contains(&moving.len()) {
        let few = guesses::thinned(&points, ALONE);
        all.extend(
            moving
                .iter()
                .flat_map(|&lane| few.iter().map(move |point| (lane, point)))
                .map(|(lane, point)| at(point, Some(lane))),
        );
    }
    all
}
