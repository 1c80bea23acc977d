//! Settings that all runs of an experiment share.

use acm_datasets::Channel;

use super::{data::Data, record::NominalRecord};
use crate::config::Experiment;

/// Settings that all runs of a job share.
#[derive(Debug, Clone, Copy)]
pub struct Setting<'a> {
    /// Configuration of the runs.
    pub experiment: &'a Experiment,
    /// Data after the domain filter.
    pub data: &'a Data,
    /// The network's inputs.
    pub channels: &'a [Channel],
    /// Calibrations of the nominal model.
    pub nominal: &'a NominalRecord,
}
