//! Marker offset: the marker does not sit on its disk where the nominal model has it.
//!
//! ```text
//! p̃ = p + R(q) d
//! ```
//!
//! | symbol | meaning                                                            | unit |
//! | `d`    | offset along the disk's own axes, the same for every marker         | m    |
//! | `R`    | disk frame in the measurement frame ([`crate::fields::Field`])      | 1    |
//!
//! Mooring, Roth & Driels (1991), Fundamentals of Manipulator Calibration, ch. 3.

use crate::effects::load::arms;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};
use crate::fields::Field;

/// See the head of this file.
pub struct MarkerOffset;

/// Typical and largest offset as shares of the arm's length.
const SHARES: [f64; 2] = [0.01, 0.2];

const FIELDS: [Field; 3] = [Field::MarkerX, Field::MarkerY, Field::MarkerZ];

impl Effect for MarkerOffset {
    fn name(&self) -> &'static str {
        "marker_offset"
    }

    fn meaning(&self) -> &'static str {
        "the marker sits beside its nominal place on the arm"
    }

    fn site(&self) -> Site {
        Site::Marker
    }

    fn source(&self) -> &'static str {
        "Mooring, Roth & Driels (1991), Fundamentals of Manipulator Calibration, ch. 3"
    }

    fn traits(&self) -> Traits {
        Traits { is_static: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        arms::any(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let length = rig.arm.as_ref().map_or(1.0, |arm| arm.length);
        let [typical, largest] = SHARES.map(|share| share * length);
        ["dx", "dy", "dz"].map(|name| ParameterSpec::size(name, "m", typical).within(-largest, largest)).into()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        vec![guesses::guess(&self.parameters(rig, carrier), 0.5)]
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        for (axis, field) in FIELDS.into_iter().enumerate() {
            arms::add(columns, field, |t| values.at(axis, t));
        }
    }
}
