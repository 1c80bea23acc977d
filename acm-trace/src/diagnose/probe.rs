//! Linear probe: part of the residual that a regression on recorded inputs and their past predicts on blocks left out.
//!
//! Columns are those of `probe/features.rs`; ridge, blocks left out and significance those of
//! [`crate::diagnose::readout`].

mod features;

use crate::diagnose::readout::readout;
use crate::diagnose::remainder::Remainder;
use crate::finding::Probe;
use features::features;

/// Tests whether the recorded inputs predict the residual. Where the data are too few, it returns a probe that explains
/// nothing, with p = 1.
pub fn probe(remainder: &Remainder, seed: u64) -> Probe {
    readout(remainder, seed, |rows, most| features(remainder, rows, most, seed))
}
