//! A request to Slurm.

use super::options::Options;

/// Request to Slurm.
#[derive(Debug, Clone)]
pub struct Slurm {
    /// Options of the command line.
    pub options: Options,
    /// The arguments of this call, for the collector, which repeats it.
    pub arguments: Vec<String>,
    /// SHA-256 of the configuration files, which a collector checks.
    pub fingerprint: String,
}
