//! Fitting one network to windows.
//!
//! ```text
//! Series ─► standardised f32 columns ─► batches ─► forward, loss, backward ─► clip ─► optimizer
//!           windows                     order      acm-models, loss           clip    optimizer
//!                                            └── epoch ──► validation ─► checkpoint ─► best epoch
//!                                                          evaluate      checkpoint    fit
//! ```
//!
//! Everything follows from the seed: first weights (acm-models), order of windows ([`examples::order`]), masks ([`dropout`]). Nothing here
//! reads the clock, and no number depends on threads.

pub mod baseline;
pub mod checkpoint;
pub mod conformal;
pub mod correction;
pub mod dropout;
pub mod ensemble;
mod error;
pub mod examples;
pub mod fit;
pub mod import;
pub mod loss;
pub mod optimizer;
mod projection;
pub mod straight;

pub use error::LearnError;
pub use examples::Examples;
pub use examples::learned::Learned;
pub use examples::sequences::SequenceExamples;
pub use examples::spans::Spans;
pub use examples::windows::{Scalers, WindowSet};
pub use fit::epoch::Epoch;
pub use fit::evaluate::predict;
pub use fit::fit;
pub use fit::not_finite::NotFinite;
pub use fit::task::{Control, Ended, Fitted, Task};
pub use projection::Projection;
