//! Downwash: the rotors' jet pushes the arm where it crosses the jet.
//!
//! ```text
//! w_wash = b u (1 − d),   w_near = b u d,   free = w,   held = −c w
//! ```
//!
//! | symbol | meaning                                                                     | unit              |
//! | `b`    | drag per length over bending stiffness, for a unit of throttle               | 1/m³ per throttle |
//! | `u`    | throttle, taken as proportional to the jet's dynamic pressure                | of the signal     |
//! | `d`    | share that the jet loses over one arm length, linearly with depth            | 1                 |
//! | `c`    | share of the mean bending that the tendons hold                             | 1                 |
//!
//! Cross-flow drag of a slender body: Hoerner (1965), Fluid-Dynamic Drag, ch. III.

use super::arms;
use crate::effects::output::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Values};

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
        vec![arms::positive(arms::spread_by_throttle(rig, "drag")), arms::decay(), arms::held()]
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        [(0.0, 0.0), (0.7, 0.8)].iter().map(|&(decay, held)| arms::guess(&specs, &[(1, decay), (2, held)])).collect()
    }

    fn proceed(&self, carrier: Carrier, values: Values, record: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        let Some(throttle) = carrying::signal(record, carrier) else { return };
        arms::jet(columns, |t| values.at(1, t), |t| values.at(2, t), |t| values.at(0, t) * throttle[t]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fields::{Field, Load};

    /// Oracle: by hand; what one field loses, the other has, and tendons hold half of both.
    #[test]
    fn decay_moves_the_load_to_the_near_field() {
        let record = Record::new(vec![0.0, 1.0], vec![], vec![vec![7.0, 7.0], vec![0.5, 1.0]], vec![]);
        let mut columns = vec![vec![1.0; 2]; Field::ALL.len()];
        Downwash.act(Carrier::Context(1), Values::constant(&[], &[4.0, 0.25, 0.5]), &record, &mut columns);
        assert_eq!(columns[Field::Free(Load::Wash).column()], [2.5, 4.0]);
        assert_eq!(columns[Field::Free(Load::WashNear).column()], [1.5, 2.0]);
        assert_eq!(columns[Field::Held(Load::Wash).column()], [0.25, -0.5]);
        assert_eq!(columns[Field::Held(Load::WashNear).column()], [0.75, 0.5]);
        assert!(columns[0].iter().all(|load| *load == 1.0));
    }
}
