//! Scale: the measurement frame has another unit of length, as after a wrong wand or a stretched image.
//!
//! ```text
//! p̃ = (1 + s) p
//! ```
//!
//! | symbol | meaning                                           | unit |
//! | `s`    | error of scale about the origin of the frame      | 1    |
//!
//! Umeyama (1991), IEEE PAMI 13(4): similarity transforms.

use super::frames;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};

/// See the head of this file.
pub struct Scale;

impl Effect for Scale {
    fn name(&self) -> &'static str {
        "scale"
    }

    fn meaning(&self) -> &'static str {
        "lengths are measured too long or too short"
    }

    fn site(&self) -> Site {
        Site::Frame
    }

    fn source(&self) -> &'static str {
        "Umeyama (1991), IEEE PAMI 13(4)"
    }

    fn traits(&self) -> Traits {
        Traits { is_static: true, is_calibrated_away: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        frames::any(rig)
    }

    fn parameters(&self, _: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![ParameterSpec::size("scale", "1", 0.02).within(-0.5, 0.5)]
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        vec![guesses::guess(&self.parameters(rig, carrier), 0.5)]
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        frames::each(columns, |t, place| place * (1.0 + values.at(0, t)));
    }
}
