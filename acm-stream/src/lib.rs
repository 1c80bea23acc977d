//! A trained estimator beside a robot: one sample in, one answer out, at once.
//!
//! ```text
//! y_k = p_k + r_k,   r_k = spread · network(z_k, Δt_k, h_{k−1}) + mean,   z = (x − mean)/spread
//! ```
//!
//! | symbol | meaning                                                                    | unit |
//! | ------ | -------------------------------------------------------------------------- | ---- |
//! | `x`    | channels: signals, or their rates of change                                | SI   |
//! | `p`    | nominal model, with its effects                                            | SI   |
//! | `r`    | what the network adds                                                      | SI   |
//! | `Δt`   | time since the sample before                                               | s    |
//! | `h`    | the network's state, as the [`StateRule`] has it                           | –    |
//!
//! [`Parts`] are what a robot's program reads from a file: `acm-eval stream RUN --save FILE` writes it, and
//! [`Parts::from_json`] reads it and finds any bit that has changed. With serde they go into other formats too.
//!
//! An [`Average`] is the mean over several estimators.
//!
//! Beside each answer stands whether the network was trained there, [`Estimator::in_range`], and an [`Interval`] about it where
//! the run has one. What is not finite, in a sample
//! or in an answer, is a [`StepError`], and the estimator then is as it was before the sample.
//!
//! All memory is taken in [`Estimator::new`]: a step allocates nothing, starts no thread and reads no clock. Data become
//! single precision here, as they do in training, where the network begins.

mod alone;
mod average;
mod channel;
mod estimator;
mod interval;
mod moved;
mod nominal;
mod parts;
mod range;
mod residual;
mod saved;
mod scaler;
mod stored;

pub use acm_kernels::Shape;
pub use average::{Average, AverageError, AverageParts, MemberParts};
pub use channel::{Channel, Source};
pub use estimator::{Estimator, StepError};
pub use interval::Interval;
pub use nominal::Nominal;
pub use parts::{Parts, PartsError, Signals};
pub use range::ChannelRange;
pub use residual::StateRule;
pub use saved::SavedError;
pub use scaler::Scaler;
