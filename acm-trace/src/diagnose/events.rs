//! Signatures of events that do not transfer between trials.
//!
//! ```text
//! share = (what the signature takes from Σ‖r‖², less what chance takes) / (Σ‖r‖² − N · floor²)
//! ```
//!
//! | kind | signature | in |
//! | --- | --- | --- |
//! | `slip` | one actuator steps, and stays there to the end of the trial | `slip.rs` |
//! | `spectral line` | a sinusoid of one frequency, with phases of its own in each trial | `spectral_line.rs` |
//! | `offset of one trial`, `offset of each trial` | constant within a trial | `offset.rs` |
//!
//! Shares do not add up: a slip at the beginning of a trial is nearly an offset of it.

mod offset;
mod signature;
mod slip;
mod spectral_line;

use crate::diagnose::events::offset::offsets;
use crate::diagnose::events::slip::slip;
use crate::diagnose::events::spectral_line::spectral_line;
use crate::diagnose::remainder::Remainder;
use crate::diagnose::samples::{residuals, samples};
use crate::finding::Event;

/// Smallest share that is reported.
const LEAST_SHARE: f64 = 0.05;

/// Smallest excess, as a share of the noise: it avoids a division by almost zero.
const LEAST_EXCESS: f64 = 0.02;

/// Returns the signatures that explain a twentieth of the excess or more, the largest first.
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
