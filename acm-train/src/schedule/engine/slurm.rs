//! Runs as tasks of Slurm's job arrays.
//!
//! ```text
//! open runs ─► list of those that are neither queued nor at work ─► arrays ─► tasks: one run, one record each
//!    ▲          slurm/0001.json                            sbatch             --task
//!    └─────────────── the same call again, by hand, by --wait, or by the collector after the last task
//! ```
//!
//! The folder is the truth. A run is done when its record is there, whatever Slurm says of the task; Slurm is asked only
//! what is still queued, so that nothing is submitted twice. Were it submitted twice all the same, the lock of the run
//! lets one task work, and both would have written the same bits.
//!
//! | file, below the folder      | what                                                             |
//! | --------------------------- | ---------------------------------------------------------------- |
//! | `slurm/0001.json`           | the runs of one array, by index, with all that a task must know  |
//! | `slurm/0001.sh`             | the script that was given to sbatch                              |
//! | `slurm/0001.job`            | the job that Slurm made of it                                    |
//! | `slurm/collector.sh`        | the script of the last collector                                 |
//! | `slurm/logs/0001_7.log`     | what the task of index 7 said                                    |
//! | `slurm/logs/collector.log`  | what the collectors said, tables at the end                      |
//! | `slurm/tries/<run>.json`    | when work on a run was begun, and how it ended                   |
//! | `slurm/tries/<run>.lock`    | held while a process works on the run                             |

pub mod array;
pub(crate) mod asked;
pub(super) mod bring;
pub(crate) mod commands;
mod folder;
pub mod options;
mod round;
mod submissions;
mod summary;
mod tries;
mod unchanged;
mod wait;

pub use asked::Slurm;
pub use commands::SlurmError;
pub use options::Options;
pub use unchanged::{fingerprint, refuse_changes};
