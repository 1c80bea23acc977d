//! Figures of a finding: one question and one file each, listed in [`ALL`].
//!
//! To add one: a file with a `QUESTION` and a `draw`, and a line in the list. The contract test draws every entry from
//! made-up findings. What the figures say is in the finding already; only means and places on paper are computed.

mod autocorrelation;
pub(crate) mod axes;
mod carrier;
pub(crate) mod colours;
mod intervals;
pub mod matrix;
pub(crate) mod scale;
pub(crate) mod sheet;
mod trace;
mod trials;

use acm_trace::finding::Finding;

use crate::figures::Drawing;

/// Figure: its question, and how the finding answers.
pub struct Figure {
    /// Name of the files, and of the anchor on the page.
    pub name: &'static str,
    /// Question that the figure answers; title of the caption.
    pub question: &'static str,
    /// Function that draws it: none where the finding lacks the data, several where there are several effects.
    pub draw: fn(&Finding) -> Vec<Drawing>,
}

/// Error before and after.
pub const INTERVALS: Figure = Figure { name: "intervals", question: intervals::QUESTION, draw: intervals::draw };
/// Residual against what carries the effect.
pub const CARRIER: Figure = Figure { name: "carrier", question: carrier::QUESTION, draw: carrier::draw };
/// A stretch of time.
pub const TRACE: Figure = Figure { name: "trace", question: trace::QUESTION, draw: trace::draw };
/// Error of each trial.
pub const TRIALS: Figure = Figure { name: "trials", question: trials::QUESTION, draw: trials::draw };
/// Figure that tests whether noise is left.
pub const AUTOCORRELATION: Figure =
    Figure { name: "autocorrelation", question: autocorrelation::QUESTION, draw: autocorrelation::draw };

/// Every figure, in the order of the page.
pub const ALL: &[Figure] = &[INTERVALS, CARRIER, TRACE, TRIALS, AUTOCORRELATION];
