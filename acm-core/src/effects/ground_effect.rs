//! Ground effect: near the ground the rotors' flow along the arm is another one.
//!
//! ```text
//! w_wash = c u exp(−max(h, 0)/h_0)
//! ```
//!
//! | symbol | meaning                                                                          | unit              |
//! | `c`    | drag over stiffness for a unit of throttle on the ground; either sign            | 1/m³ per throttle |
//! | `u`    | throttle                                                                         | of the signal     |
//! | `h`    | altitude over the ground, the carrier                                            | m                 |
//! | `h_0`  | altitude at which a share 1/e of it is left                                      | m                 |
//!
//! Cheeseman & Bennett (1955), ARC R&M 3021, for its fall with altitude; the exponential stands for their 1/h².

use super::{Carrier, Effect, ParameterSpec, Record, Rig, Site, Values, actuators, arms, carrying};
use crate::fields::Field;

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
            ParameterSpec::known("throttle_context", "1", rig.throttle.unwrap_or(0) as f64),
        ]
    }

    fn starts(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        [0.3, 1.0].iter().map(|&height| actuators::start_with(&specs, 0.5, 1, height)).collect()
    }

    fn act(&self, carrier: Carrier, values: Values, record: &Record, columns: &mut [Vec<f64>]) {
        let throttle = record.contexts.get(values.at(2, 0) as usize);
        let (Some(throttle), Some(altitude)) = (throttle, carrying::signal(record, carrier)) else { return };
        let near = |t: usize| (-altitude[t].max(0.0) / values.at(1, t)).exp();
        arms::add(columns, Field::Wash, |t| values.at(0, t) * throttle[t] * near(t));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand; at one height h_0 a share 1/e is left, and below the ground it is as on the ground.
    #[test]
    fn it_fades_with_altitude() {
        let record = Record::new(vec![0.0, 1.0, 2.0], vec![], vec![vec![-0.1, 0.0, 0.7], vec![0.5; 3]], vec![]);
        let mut columns = vec![vec![0.0; 3]; Field::ALL.len()];
        GroundEffect.act(Carrier::Context(0), Values::constant(&[], &[-4.0, 0.7, 1.0]), &record, &mut columns);
        for (load, expected) in columns[Field::Wash.column()].iter().zip([-2.0, -2.0, -2.0 / std::f64::consts::E]) {
            assert!((load - expected).abs() < 1e-15);
        }
    }
}
