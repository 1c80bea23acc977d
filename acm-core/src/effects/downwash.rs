//! Downwash: the rotors' jet pushes the arm where it crosses the jet.
//!
//! ```text
//! w_wash = c u (1 − d),   w_near = c u d
//! ```
//!
//! | symbol | meaning                                                                     | unit              |
//! | `c`    | drag per length over bending stiffness, for a unit of throttle               | 1/m³ per throttle |
//! | `u`    | throttle, taken as proportional to the jet's dynamic pressure                | of the signal     |
//! | `d`    | share that the jet loses over one arm length, linearly with depth            | 1                 |
//!
//! Cross-flow drag of a slender body: Hoerner (1965), Fluid-Dynamic Drag, ch. III.

use super::{Carrier, Effect, ParameterSpec, Record, Rig, Site, Values, actuators, arms, carrying};
use crate::fields::Field;

/// See the head of this file.
pub struct Downwash;

impl Effect for Downwash {
    fn name(&self) -> &'static str {
        "downwash"
    }

    fn meaning(&self) -> &'static str {
        "the rotors' downwash pushes the arm"
    }

    fn site(&self) -> Site {
        Site::Load
    }

    fn source(&self) -> &'static str {
        "Hoerner (1965), Fluid-Dynamic Drag, ch. III"
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        arms::carried_by(rig, rig.throttle)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![
            arms::positive(arms::spread_by_throttle(rig, "drag")),
            ParameterSpec::shape("decay", "1", 0.0, 0.3).within(0.0, 1.0),
        ]
    }

    fn starts(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        [0.0, 0.7].iter().map(|&decay| actuators::start_with(&specs, 0.5, 1, decay)).collect()
    }

    fn act(&self, carrier: Carrier, values: Values, record: &Record, columns: &mut [Vec<f64>]) {
        let Some(throttle) = carrying::signal(record, carrier) else { return };
        let drag = |t: usize| values.at(0, t) * throttle[t];
        arms::add(columns, Field::Wash, |t| drag(t) * (1.0 - values.at(1, t)));
        arms::add(columns, Field::WashNear, |t| drag(t) * values.at(1, t));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand; what one field loses, the other has.
    #[test]
    fn decay_moves_the_load_to_the_near_field() {
        let record = Record::new(vec![0.0, 1.0], vec![], vec![vec![7.0, 7.0], vec![0.5, 1.0]], vec![]);
        let mut columns = vec![vec![1.0; 2]; Field::ALL.len()];
        Downwash.act(Carrier::Context(1), Values::constant(&[], &[4.0, 0.25]), &record, &mut columns);
        assert_eq!(columns[Field::Wash.column()], [2.5, 4.0]);
        assert_eq!(columns[Field::WashNear.column()], [1.5, 2.0]);
        assert!(columns[0].iter().all(|load| *load == 1.0));
    }
}
