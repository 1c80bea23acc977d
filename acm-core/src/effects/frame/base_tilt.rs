//! Base tilt: the carrier leans as it accelerates, and the arm with it.
//!
//! ```text
//! p̃ = exp(w) p,   w = −(k/g) (d × a)
//! ```
//!
//! | symbol | meaning                                                                           | unit |
//! | `w`    | rotation vector of the base, about a horizontal axis                              | rad  |
//! | `a`    | acceleration of the carrier in the measurement frame; its vertical part drops out | m/s² |
//! | `d`    | unit vector downwards; against z where the rig does not know it                    | 1    |
//! | `k`    | 1 for a carrier that hangs, or that accelerates by leaning its thrust              | 1    |
//! | `g`    | 9.80665                                                                           | m/s² |
//!
//! With k = 1 the base's own downward direction follows d − a/g. Rotation about the origin of the measurement frame.
//! Mahony, Kumar & Corke (2012), IEEE Robotics & Automation Magazine 19(3).

use nalgebra::Vector3;

use super::frames;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Values, guesses};
use crate::se3;

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.80665;

/// See the head of this file.
pub struct BaseTilt;

impl Effect for BaseTilt {
    fn name(&self) -> &'static str {
        "base_tilt"
    }

    fn meaning(&self) -> &'static str {
        "the base tilts as its carrier accelerates"
    }

    fn site(&self) -> Site {
        Site::Frame
    }

    fn source(&self) -> &'static str {
        "Mahony, Kumar & Corke (2012), IEEE Robotics & Automation Magazine 19(3)"
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        if rig.carried { frames::any(rig) } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let down = frames::down(rig);
        vec![
            ParameterSpec::size("gain", "1", 0.5).within(-3.0, 3.0),
            ParameterSpec::known("down_x", "1", down.x),
            ParameterSpec::known("down_y", "1", down.y),
            ParameterSpec::known("down_z", "1", down.z),
        ]
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        vec![guesses::guess(&self.parameters(rig, carrier), 1.0)]
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        let [x, y, z] = &record.acceleration[..] else { return };
        let down = Vector3::new(values.at(1, 0), values.at(2, 0), values.at(3, 0));
        frames::each(columns, |t, place| {
            let lean = down.cross(&Vector3::new(x[t], y[t], z[t])) * (-values.at(0, t) / GRAVITY);
            se3::rotation(&lean) * place
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a hanging point in a carrier that accelerates along x with g hangs back by 1 rad, that is sin 1 and cos 1.
    #[test]
    fn a_hanging_point_lags_behind_its_carrier() {
        let record =
            Record { time: vec![0.0], acceleration: vec![vec![GRAVITY], vec![0.0], vec![3.0]], ..Record::default() };
        let mut columns = vec![vec![0.0], vec![0.0], vec![-2.0]];
        let values = [1.0, 0.0, 0.0, -1.0];
        BaseTilt.act(Carrier::Rig, Values::constant(&[], &values), &record, &mut columns);
        assert!((columns[0][0] + 2.0 * 1f64.sin()).abs() < 1e-15, "{columns:?}");
        assert!(columns[1][0].abs() < 1e-15);
        assert!((columns[2][0] + 2.0 * 1f64.cos()).abs() < 1e-15);
    }
}
