//! Fitting one network to windows: the loop between the data and the record.
//!
//! ```text
//! Series ─► standardised f32 columns ─► batches ─► forward, loss, backward ─► clip ─► optimizer
//!           batch                       order      acm-models, loss           clip    optimizer
//!                                            └── epoch ──► validation ─► checkpoint ─► best epoch
//!                                                          evaluate      checkpoint    fit
//! ```
//!
//! Everything follows from the seed: first weights (acm-models), order of windows ([`order`]). Nothing here reads the
//! clock, and no number depends on threads.

pub mod adam;
pub mod batch;
pub mod checkpoint;
pub mod clip;
pub mod config;
pub mod device;
pub mod error;
pub mod evaluate;
pub mod examples;
pub mod fit;
pub mod loss;
pub mod not_finite;
pub mod optimizer;
pub mod order;
pub mod progress;
pub mod rmsprop;
pub mod schedule;
pub mod sequences;

pub use batch::{Scalers, WindowSet};
pub use config::{TrainingConfig, TrainingFault};
pub use device::device;
pub use error::LearnError;
pub use evaluate::predict;
pub use examples::Examples;
pub use fit::{Control, Ended, Fitted, Task, fit};
pub use loss::Loss;
pub use not_finite::NotFinite;
pub use sequences::SequenceExamples;
