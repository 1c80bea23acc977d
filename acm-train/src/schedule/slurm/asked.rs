//! What was asked of Slurm.

use super::options::Options;

/// What was asked of Slurm.
#[derive(Debug, Clone)]
pub struct Slurm {
    /// By the command line.
    pub options: Options,
    /// The arguments of this call, for the collector, which repeats it.
    pub arguments: Vec<String>,
    /// Of the files that ask, which a collector is to find as they are.
    pub fingerprint: String,
}
