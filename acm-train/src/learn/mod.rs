//! Fitting one network to windows.
//!
//! ```text
//! Series ─► standardised f32 columns ─► batches ─► forward, loss, backward ─► clip ─► optimizer
//!           windows                     order      acm-models, loss           clip    optimizer
//!                                            └── epoch ──► validation ─► checkpoint ─► best epoch
//!                                                          evaluate      checkpoint    fit
//! ```
//!
//! Everything follows from the seed: first weights (acm-models), order of windows ([`order`]). Nothing here reads the
//! clock, and no number depends on threads.

pub mod adam;
pub mod baseline;
pub mod batch;
pub mod checkpoint;
pub mod clip;
pub mod conformal;
pub mod correction;
pub mod ensemble;
mod epoch;
mod error;
pub mod evaluate;
mod examples;
mod fit;
pub mod import;
mod learned;
pub mod loss;
pub mod moments;
mod not_finite;
pub mod optimizer;
pub mod order;
pub mod progress;
mod projection;
pub mod rmsprop;
pub mod schedule;
pub mod sequences;
mod start;
mod task;
mod windows;

pub use epoch::Epoch;
pub use error::LearnError;
pub use evaluate::predict;
pub use examples::Examples;
pub use fit::fit;
pub use learned::Learned;
pub use not_finite::NotFinite;
pub use projection::Projection;
pub use sequences::SequenceExamples;
pub use task::{Control, Ended, Fitted, Task};
pub use windows::{Scalers, WindowSet};
