//! Candidate terms of a sparse formula.
//!
//! | term | of |
//! | --- | --- |
//! | 1, q, q², q_i q_j, q³ | actuators |
//! | v, \|v\|, sgn v, q sgn v, \|q\| sgn v, q \|v\|, v² | actuators and their rates |
//! | c, c q, c v, c sgn v, c², and all with c − c₀ for c | context signals; c₀ is the middle of the range |
//! | t, q t | time since the trial began |
//! | a | acceleration of the carrier |
//!
//! sgn is smoothed within a tenth of the typical speed, because rates are no more accurate.

use acm_core::display::significant;
use acm_core::record::Record;
use acm_core::rig::Signal;

use crate::diagnose::remainder::Remainder;
use crate::diagnose::samples::{Sample, gather, moments};

/// Width of the smoothed sign: sgn v = tanh(v / (BEND · typical speed)).
const BEND: f64 = 0.1;

/// Largest number of actuators for which a product may act on actuators that it does not contain.
const FEW_ACTUATORS: usize = 3;

/// One term at N samples.
#[derive(Debug, Clone)]
pub(crate) struct Term {
    /// Name in the formula.
    pub name: String,
    /// Values [N], divided by `scale`.
    pub values: Vec<f64>,
    /// Root mean square of the term, SI.
    pub scale: f64,
    /// Number of factors; of equally good terms the simpler one is chosen.
    pub factors: usize,
    /// Actuators in the term.
    of: Vec<usize>,
}

impl Term {
    /// Returns whether the term may act on actuator `on`, or on an output (none).
    pub fn may_stand(&self, on: Option<usize>, actuators: usize) -> bool {
        let few = actuators <= FEW_ACTUATORS;
        match on {
            Some(a) => few || self.of.is_empty() || self.of.contains(&a) || self.factors == 1,
            None => few || self.of.len() <= 1,
        }
    }
}

/// Returns all terms that vary at `samples`, and the constant.
pub(crate) fn terms(remainder: &Remainder, samples: &[Sample]) -> Vec<Term> {
    let signals = Signals::of(remainder, samples);
    let mut terms = vec![term("1", vec![1.0; samples.len()], 0, &[])];
    terms.extend(of_actuators(&signals));
    for context in &signals.contexts {
        terms.extend(of_context(context, &signals));
    }
    let time = &signals.time;
    terms.push(term("t", time.clone(), 1, &[]));
    terms
        .extend(signals.actuators.iter().map(|q| term(format!("{}·t", q.name), times(&q.values, time), 2, &[q.index])));
    let axes = ["x", "y", "z"].iter().zip(&signals.acceleration);
    terms.extend(axes.map(|(axis, a)| term(format!("a_{axis}"), a.clone(), 1, &[])));
    terms.retain(|term| term.scale > 0.0 && term.scale.is_finite());
    terms
}

struct Moving {
    index: usize,
    name: String,
    values: Vec<f64>,
    rate: Vec<f64>,
    sign: Vec<f64>,
}

struct Signals {
    actuators: Vec<Moving>,
    /// Contexts with their names: as recorded, and from the middle of the range.
    contexts: Vec<(String, Vec<f64>)>,
    time: Vec<f64>,
    acceleration: Vec<Vec<f64>>,
}

impl Signals {
    fn of(remainder: &Remainder, samples: &[Sample]) -> Self {
        let of =
            |column: &(dyn Fn(&Record) -> Vec<f64> + Sync)| gather(remainder, samples, |trial| column(trial.record));
        let rig = remainder.rig;
        let moving = |(index, signal): (usize, &Signal)| {
            let rate = of(&|r| r.actuator_rates[index].clone());
            let (mean, sd) = moments(&rate);
            let bend = (BEND * mean.hypot(sd)).max(f64::MIN_POSITIVE);
            let sign = rate.iter().map(|v| (v / bend).tanh()).collect();
            Moving { index, name: signal.name.clone(), values: of(&|r| r.actuators[index].clone()), rate, sign }
        };
        let mut contexts = Vec::new();
        for (e, signal) in rig.contexts.iter().enumerate().filter(|(_, signal)| signal.varies()) {
            let values = of(&|r| r.contexts[e].clone());
            let middle = 0.5 * (signal.low + signal.high);
            if middle.abs() > 0.1 * signal.span() {
                // As the formula prints it, so that a reader can compute it.
                let middle: f64 = format!("{middle:.2e}").parse().unwrap_or(middle);
                let sign = if middle < 0.0 { "+" } else { "−" };
                let name = format!("({} {sign} {})", signal.name, significant(middle.abs(), 3));
                contexts.push((name, values.iter().map(|c| c - middle).collect()));
            }
            contexts.push((signal.name.clone(), values));
        }
        Self {
            actuators: rig.actuators.iter().enumerate().filter(|(_, q)| q.varies()).map(moving).collect(),
            contexts,
            time: of(&|r| r.time.iter().map(|t| t - r.time[0]).collect()),
            acceleration: if rig.carried {
                (0..3).map(|k| of(&|r| r.acceleration.get(k).cloned().unwrap_or_default())).collect()
            } else {
                vec![]
            },
        }
    }
}

fn of_actuators(signals: &Signals) -> Vec<Term> {
    let mut terms = Vec::new();
    for (i, q) in signals.actuators.iter().enumerate() {
        let (name, x, v, sign) = (&q.name, &q.values, &q.rate, &q.sign);
        let (size, speed, own) = (magnitude(x), magnitude(v), [q.index]);
        terms.extend([
            term(name, x.clone(), 1, &own),
            term(format!("{name}²"), times(x, x), 2, &own),
            term(format!("{name}³"), times(x, &times(x, x)), 3, &own),
            term(rate(name), v.clone(), 1, &own),
            term(format!("|{}|", rate(name)), speed.clone(), 2, &own),
            term(format!("sgn({})", rate(name)), sign.clone(), 1, &own),
            term(format!("{name}·sgn({})", rate(name)), times(x, sign), 2, &own),
            term(format!("|{name}|·sgn({})", rate(name)), times(&size, sign), 3, &own),
            term(format!("{name}·|{}|", rate(name)), times(x, &speed), 3, &own),
            term(format!("({})²", rate(name)), times(v, v), 2, &own),
        ]);
        let pair = |other: &Moving| {
            term(format!("{name}·{}", other.name), times(x, &other.values), 2, &[q.index, other.index])
        };
        terms.extend(signals.actuators[i + 1..].iter().map(pair));
    }
    terms
}

fn of_context((name, c): &(String, Vec<f64>), signals: &Signals) -> Vec<Term> {
    let mut terms = vec![term(name, c.clone(), 1, &[]), term(format!("{name}²"), times(c, c), 2, &[])];
    for q in &signals.actuators {
        let own = [q.index];
        terms.extend([
            term(format!("{name}·{}", q.name), times(c, &q.values), 2, &own),
            term(format!("{name}·{}", rate(&q.name)), times(c, &q.rate), 2, &own),
            term(format!("{name}·sgn({})", rate(&q.name)), times(c, &q.sign), 2, &own),
        ]);
    }
    terms
}

fn rate(name: &str) -> String {
    format!("d{name}/dt")
}

fn term(name: impl Into<String>, values: Vec<f64>, factors: usize, of: &[usize]) -> Term {
    let (mean, sd) = moments(&values);
    let scale = mean.hypot(sd);
    let values = values.into_iter().map(|x| x / scale.max(f64::MIN_POSITIVE)).collect();
    Term { name: name.into(), values, scale, factors, of: of.to_vec() }
}

fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

fn magnitude(a: &[f64]) -> Vec<f64> {
    a.iter().map(|a| a.abs()).collect()
}
