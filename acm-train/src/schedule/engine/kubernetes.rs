//! Runs as pods of an Indexed Job of Kubernetes. Nothing is submitted: the manifest is written, and `kubectl apply` takes it.
//!
//! | file, below the folder | what                                                             |
//! | ---------------------- | ---------------------------------------------------------------- |
//! | `kubernetes/0001.json` | the runs, by index, with all that a pod must know                |
//! | `kubernetes/0001.yaml` | the Job; its pods call `acm-train --task` with the list          |
//!
//! A pod finds its run by `JOB_COMPLETION_INDEX`. The folder is the truth, as with Slurm: a run is done when its record is
//! there, and two pods on one run write the same bits.

mod job;
pub mod options;
pub(super) mod write;

pub use options::Options;
