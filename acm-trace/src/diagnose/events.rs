//! Signatures of events that do not carry over from one trial to the next.
//!
//! ```text
//! share = (what the signature takes from Σ‖r‖², less what chance takes) / (Σ‖r‖² − N · floor²)
//! ```
//!
//! | kind | signature | in |
//! | --- | --- | --- |
//! | `slip` | one actuator steps, and stays there to the end of the trial | [`crate::diagnose::slip`] |
//! | `spectral line` | a sinusoid of one frequency, with phases of its own in each trial | [`crate::diagnose::spectral_line`] |
//! | `offset of one trial`, `offset of each trial` | constant within a trial | [`crate::diagnose::offset`] |
//!
//! Shares do not add up: a slip at the beginning of a trial is nearly an offset of it.

use crate::diagnose::offset::offsets;
use crate::diagnose::remainder::Remainder;
use crate::diagnose::samples::{residuals, samples};
use crate::diagnose::slip::slip;
use crate::diagnose::spectral_line::spectral_line;
use crate::finding::Event;

/// Smallest share that is reported.
const LEAST_SHARE: f64 = 0.05;

/// The excess counts as this share of the noise at least, so that chance is not divided by nothing.
const LEAST_EXCESS: f64 = 0.02;

/// A signature before it is put in relation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Signature {
    /// As in [`Event::kind`].
    pub kind: &'static str,
    /// Reduction of the sum of squares, less the reduction by chance.
    pub taken: f64,
    /// In words.
    pub what: String,
}

/// Signatures that explain a twentieth of the excess or more, the largest first.
pub fn events(remainder: &Remainder) -> Vec<Event> {
    let rows = samples(remainder, usize::MAX);
    let squares: f64 = residuals(remainder, &rows).iter().map(|r| r * r).sum();
    let noise = rows.len() as f64 * remainder.floor.powi(2);
    let excess = (squares - noise).max(LEAST_EXCESS * noise);
    if !(squares > 0.0 && excess > 0.0) {
        return vec![];
    }
    let found = [slip(remainder), spectral_line(remainder), offsets(remainder)];
    let mut events: Vec<Event> = found
        .into_iter()
        .flatten()
        .map(|s| Event { kind: s.kind.into(), share: (s.taken / excess).min(1.0), what: s.what })
        .filter(|event| event.share >= LEAST_SHARE)
        .collect();
    events.sort_by(|a, b| b.share.total_cmp(&a.share));
    events
}

/// χ²/degrees that chance exceeds as rarely as a normal variable exceeds `z`. Wilson & Hilferty (1931), PNAS 17(12).
pub(crate) fn chi_square_ratio(degrees: f64, z: f64) -> f64 {
    let spread = 2.0 / (9.0 * degrees.max(1.0));
    (1.0 - spread + z * spread.sqrt()).powi(3)
}

/// The unit of the residual: that of the outputs where it is one.
pub(crate) fn unit<'a>(remainder: &Remainder<'a>) -> &'a str {
    let outputs = &remainder.rig.outputs;
    let first = outputs.first().map_or("", |output| output.unit.as_str());
    if outputs.iter().all(|output| output.unit == first) { first } else { "" }
}
