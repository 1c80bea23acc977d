//! What effects of the actuation share: one size for each actuator, and lengths along the travel of all of them.
//!
//! An actuator that does not move gets a size between 0 and 0, which no fit can change.

use super::{Carrier, ParameterSpec, Rig, Values, guesses};
use crate::rig::Signal;

/// Width of the range, 0 for an actuator that does not move.
pub fn travel(q: &Signal) -> f64 {
    if q.varies() { q.span() } else { 0.0 }
}

/// The rig as a whole where any actuator moves, else nothing.
pub fn moving(rig: &Rig) -> Vec<Carrier> {
    if rig.actuators.iter().any(Signal::varies) { vec![Carrier::Rig] } else { vec![] }
}

/// One size for each actuator in its own unit; scale, smallest and largest as shares of its travel.
pub fn sizes<'a>(
    rig: &'a Rig,
    name: &'a str,
    [scale, lower, upper]: [f64; 3],
) -> impl Iterator<Item = ParameterSpec> + 'a {
    rig.actuators.iter().map(move |q| {
        let travel = travel(q);
        ParameterSpec::size(format!("{name}_{}", q.name), &q.unit, scale * travel)
            .within(lower * travel, upper * travel)
    })
}

/// One size without unit for each actuator; scale, smallest and largest as they are.
pub fn shares<'a>(
    rig: &'a Rig,
    name: &'a str,
    [scale, lower, upper]: [f64; 3],
) -> impl Iterator<Item = ParameterSpec> + 'a {
    rig.actuators.iter().map(move |q| {
        let moves = if q.varies() { 1.0 } else { 0.0 };
        ParameterSpec::size(format!("{name}_{}", q.name), "1", scale).within(moves * lower, moves * upper)
    })
}

/// Ends of each actuator's range as known values: all upper ends, then all lower ends.
pub fn ends(rig: &Rig) -> impl Iterator<Item = ParameterSpec> + '_ {
    let known = |name: &str, q: &Signal, value: f64| ParameterSpec::known(format!("{name}_{}", q.name), &q.unit, value);
    let high = rig.actuators.iter().map(move |q| known("high", q, q.high));
    high.chain(rig.actuators.iter().map(move |q| known("low", q, q.low)))
}

/// Middle of actuator `j`'s range and half its width, where [`ends`] follow the first `own` parameters.
pub fn middle_and_half(values: Values, own: usize, count: usize, j: usize) -> (f64, f64) {
    let (high, low) = (values.at(own + j, 0), values.at(own + count + j, 0));
    (0.5 * (high + low), 0.5 * (high - low))
}

/// Whether a range of that half width around `middle` is one: an actuator at rest has none.
pub fn is_range(middle: f64, half: f64) -> bool {
    2.0 * half > 1e-9 * (middle.abs() + half)
}

/// A length along the travel that all actuators share: in their unit where they have one unit; otherwise a share of each
/// one's travel, and the travels follow as known values.
pub struct Length {
    /// 1, or `share` of each actuator's travel.
    pub unit: String,
    /// What a share of 1 is in that unit.
    pub whole: f64,
    known: Vec<ParameterSpec>,
}

impl Length {
    /// For this rig.
    pub fn of(rig: &Rig) -> Self {
        let widest = rig.actuators.iter().map(travel).fold(0.0, f64::max);
        match rig.actuators.split_first() {
            Some((first, rest)) if rest.iter().all(|q| q.unit == first.unit) => {
                Self { unit: first.unit.clone(), whole: widest, known: vec![] }
            }
            _ => {
                let known = |q: &Signal| ParameterSpec::known(format!("travel_{}", q.name), &q.unit, travel(q));
                Self { unit: "1".into(), whole: 1.0, known: rig.actuators.iter().map(known).collect() }
            }
        }
    }

    /// A length at rest at `share` of the travel, between `lower` and `upper` of it.
    pub fn shape(&self, name: &str, share: f64, lower: f64, upper: f64) -> ParameterSpec {
        let part = |share: f64| share * self.whole;
        ParameterSpec::shape(name, &self.unit, part(share), part(share)).within(part(lower), part(upper))
    }

    /// The same values to start from in every effect, in the unit of the length.
    pub fn grid(&self) -> Vec<f64> {
        guesses::lengths().into_iter().map(|share| share * self.whole).collect()
    }

    /// The travels of actuators in several units, last in the list of parameters.
    pub fn known(self) -> Vec<ParameterSpec> {
        self.known
    }
}

/// What a shared length is multiplied with for actuator `j`: its travel where travels follow the first `own` parameters.
pub fn unit_of_length(values: Values, own: usize, j: usize) -> f64 {
    if values.count() > own { values.at(own + j, 0) } else { 1.0 }
}
