//! Training examples, gathered into batches.
//!
//! Examples are windows of series, longer runs of their samples ([`spans`]) or whole sequences ([`sequences`]); [`order`] shuffles
//! them for each epoch.

pub mod batch;
pub(super) mod learned;
pub mod order;
pub mod sequences;
pub mod single;
pub mod spans;
pub(super) mod windows;

use std::ops::Range;

use acm_datasets::Standardizer;
use acm_models::Keep;

use batch::Batch;

/// Number of windows predicted at a time: more would not be faster, and memory stays small.
const BATCH: usize = 1024;

/// Examples of one part of the data, standardised.
pub trait Examples {
    /// Returns the number of examples.
    fn len(&self) -> usize;

    /// Returns whether there is none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the number of channels C.
    fn channels(&self) -> usize;

    /// Returns the number of outputs O.
    fn outputs(&self) -> usize;

    /// Returns the number of the network's outputs: those of the examples, and the actuators that it corrects.
    fn said(&self) -> usize {
        self.outputs()
    }

    /// Returns the order of an epoch, which is cut into batches, from a shuffled one. Examples of unequal length may
    /// put those of like length together, so that little is padded.
    fn arrange(&self, shuffled: Vec<usize>, _batch: usize) -> Vec<usize> {
        shuffled
    }

    /// Returns the examples that are predicted together, in order.
    fn batches(&self) -> Vec<Range<usize>> {
        (0..self.len()).step_by(BATCH).map(|first| first..self.len().min(first + BATCH)).collect()
    }

    /// Replaces the contents of `batch` by the examples `chosen`. Examples that define themselves which of their steps
    /// count ignore `supervise`.
    fn gather(&self, chosen: &[usize], supervise: Keep, batch: &mut Batch);

    /// Returns whether the state is carried over all samples of a trial.
    fn carry_state(&self) -> bool {
        false
    }

    /// Returns the scaler of the targets, where these are the residual of a nominal model.
    fn residual(&self) -> Option<&Standardizer> {
        None
    }

    /// Returns the name of the trial of an example.
    fn whose(&self, index: usize) -> String {
        format!("example {index}")
    }

    /// Returns the SHA-256 over all that a fit sees of these examples, in hexadecimal.
    fn fingerprint(&self) -> String;
}
