//! Result of one search for a signature, and functions that such searches share.

use crate::diagnose::remainder::Remainder;

/// A signature, without its share of the excess.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Signature {
    /// Kind, as in [`Event::kind`](crate::finding::Event::kind).
    pub kind: &'static str,
    /// Reduction of the sum of squares, less the reduction by chance.
    pub taken: f64,
    /// Description in words.
    pub what: String,
}

/// Returns the ratio χ²/degrees that chance exceeds as rarely as a normal variable exceeds `z`. Wilson & Hilferty
/// (1931), PNAS 17(12).
pub(crate) fn chi_square_ratio(degrees: f64, z: f64) -> f64 {
    let spread = 2.0 / (9.0 * degrees.max(1.0));
    (1.0 - spread + z * spread.sqrt()).powi(3)
}

/// Returns the unit of the residual if all outputs have the same.
pub(crate) fn unit<'a>(remainder: &Remainder<'a>) -> &'a str {
    let outputs = &remainder.rig.outputs;
    let first = outputs.first().map_or("", |output| output.unit.as_str());
    if outputs.iter().all(|output| output.unit == first) { first } else { "" }
}
