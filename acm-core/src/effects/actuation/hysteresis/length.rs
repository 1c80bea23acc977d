//! A length along the travel of actuators.

use crate::effects::actuation::actuators::travel;
use crate::effects::{ParameterSpec, Rig, Values, guesses};
use crate::rig::Signal;

/// A length along the travel that all actuators share: in their unit where it is the same; otherwise a share of each
/// one's travel, with the travels as known values.
pub struct Length {
    /// Unit of the actuators, or 1 for shares.
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

    /// A length, neutral at `share` of a travel, between `lower` and `upper` of it.
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

/// Factor of a shared length for actuator `j`: its travel, where travels follow the first `own` parameters.
pub fn unit_of_length(values: Values, own: usize, j: usize) -> f64 {
    if values.count() > own { values.at(own + j, 0) } else { 1.0 }
}
