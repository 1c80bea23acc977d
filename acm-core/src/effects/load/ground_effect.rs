//! Ground effect: near the ground the rotors' flow along the arm changes.
//!
//! ```text
//! g = b u exp(−max(h, 0)/h_0),   w_wash = g (1 − d),   w_near = g d,   free = w,   held = −c w
//! ```
//!
//! | symbol | meaning                                                                          | unit              |
//! | `b`    | drag over stiffness for a unit of throttle on the ground; either sign            | 1/m³ per throttle |
//! | `u`    | throttle                                                                         | of the signal     |
//! | `h`    | altitude over the ground, the carrier                                            | m                 |
//! | `h_0`  | altitude at which a share 1/e of it is left                                      | m                 |
//! | `d`    | share that the jet loses over one arm length, linearly with depth                | 1                 |
//! | `c`    | share of the mean bending that the tendons hold                                  | 1                 |
//!
//! Cheeseman & Bennett (1955), ARC R&M 3021, for its fall with altitude; the exponential stands for their 1/h².

use super::arms;
use crate::effects::output::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Values};

/// See the head of this file.
pub struct GroundEffect;

impl Effect for GroundEffect {
    fn name(&self) -> &'static str {
        "ground_effect"
    }

    fn meaning(&self) -> &'static str {
        "the rotors' flow pushes the arm more, or less, near the ground"
    }

    fn site(&self) -> Site {
        Site::Load
    }

    fn source(&self) -> &'static str {
        "Cheeseman & Bennett (1955), ARC R&M 3021"
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        let blows = |&e: &usize| rig.contexts.get(e).is_some_and(|throttle| throttle.magnitude() > 0.0);
        if rig.throttle.filter(blows).is_some() { arms::carried_by(rig, rig.altitude) } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![
            arms::spread_by_throttle(rig, "drag"),
            ParameterSpec::shape("height", "m", 0.5, 0.5).within(0.1, 4.0),
            arms::decay(),
            arms::held(),
            ParameterSpec::known("throttle_context", "1", rig.throttle.unwrap_or(0) as f64),
        ]
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        let starts = [(0.3, 0.8), (1.0, 0.8), (0.6, 0.0)];
        starts.iter().map(|&(height, held)| arms::guess(&specs, &[(1, height), (3, held)])).collect()
    }

    fn proceed(&self, carrier: Carrier, values: Values, record: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        let throttle = record.contexts.get(values.at(4, 0) as usize);
        let (Some(throttle), Some(altitude)) = (throttle, carrying::signal(record, carrier)) else { return };
        let near = |t: usize| (-altitude[t].max(0.0) / values.at(1, t)).exp();
        let drag = |t: usize| values.at(0, t) * throttle[t] * near(t);
        arms::jet(columns, |t| values.at(2, t), |t| values.at(3, t), drag);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fields::{Field, Load};

    /// Oracle: by hand; at one height h_0 a share 1/e is left, and below the ground it is as on the ground.
    #[test]
    fn it_fades_with_altitude() {
        let record = Record::new(vec![0.0, 1.0, 2.0], vec![], vec![vec![-0.1, 0.0, 0.7], vec![0.5; 3]], vec![]);
        let mut columns = vec![vec![0.0; 3]; Field::ALL.len()];
        GroundEffect.act(
            Carrier::Context(0),
            Values::constant(&[], &[-4.0, 0.7, 0.0, 0.0, 1.0]),
            &record,
            &mut columns,
        );
        for (load, expected) in
            columns[Field::Free(Load::Wash).column()].iter().zip([-2.0, -2.0, -2.0 / std::f64::consts::E])
        {
            assert!((load - expected).abs() < 1e-15);
        }
    }
}
