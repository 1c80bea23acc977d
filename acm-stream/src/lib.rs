//! A trained estimator for the control loop: one sample in, one tip position out.
//!
//! # Where to begin
//!
//! | task | begin with |
//! | --- | --- |
//! | read an estimator that `acm-eval stream RUN --save FILE` wrote | [`Parts::from_json`], which checks its SHA-256 |
//! | answer sample by sample | [`Estimator::new`], [`Estimator::step`] |
//! | run a nominal model without a network | [`Parts::alone`] |
//! | average several estimators | [`Average`] |
//! | know whether the network was trained at this input | [`Estimator::in_range`] |
//! | know the prediction interval | [`Interval`] |
//!
//! ```
//! use acm_stream::{Estimator, Nominal, Parts, Signals};
//!
//! // The nominal model's prediction comes with each sample: inputs are the actuator, then the prediction.
//! let signals = Signals { actuators: vec!["q1".into()], contexts: vec![] };
//! let mut estimator = Estimator::new(Parts::alone(signals, Nominal::Given(1), 0..1, 0.01)?)?;
//! assert_eq!(estimator.step(&[0.2, 1.5], 0.01)?, [1.5]);
//! // A sample that is not finite is an error, and the estimator is as it was before.
//! assert!(estimator.step(&[f64::NAN, 1.5], 0.01).is_err());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Equations
//!
//! ```text
//! y_k = p_k + f r_k,   r_k = spread · network(z_k, Δt_k, h_{k−1}) + mean,   z = (x − mean)/spread
//! ```
//!
//! | symbol | meaning                                                                    | unit |
//! | ------ | -------------------------------------------------------------------------- | ---- |
//! | `x`    | channels: signals, or their rates of change                                | SI   |
//! | `p`    | nominal model, with its effects                                            | SI   |
//! | `r`    | residual that the network predicts                                         | SI   |
//! | `f`    | shrinkage factor from validation, 0 to 1                                   | 1    |
//! | `Δt`   | time since the previous sample                                             | s    |
//! | `h`    | state of the network, kept as [`StateRule`] says                           | –    |
//!
//! # Guarantees
//!
//! [`Estimator::new`] takes all memory. A step allocates nothing, starts no thread and reads no clock. An input or an answer that is
//! not finite is a [`StepError`], and leaves the estimator unchanged. The network computes in f32, as in training; everything else is
//! f64. [`Parts`] implement serde, for other formats than JSON.

mod alone;
mod average;
mod channel;
mod estimator;
mod interval;
mod labels;
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
pub use labels::{Label, Labels, ManifestUnit};
pub use nominal::Nominal;
pub use parts::{Parts, PartsError, Signals};
pub use range::ChannelRange;
pub use residual::StateRule;
pub use saved::SavedError;
pub use scaler::Scaler;

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
