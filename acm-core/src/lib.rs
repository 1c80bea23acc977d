//! Physics of a continuum arm, and of any rig with actuators and measured outputs: nominal models, calibration, and effects
//! that a nominal model may lack.
//!
//! # Where to begin
//!
//! | task | begin with |
//! | --- | --- |
//! | calibrate an arm, or a polynomial, on recorded samples | [`Observations`], [`NominalSpec`], [`calibrate`] |
//! | predict with a calibrated model | [`NominalModel::predict`] |
//! | evaluate an arm with known parameters, with its Jacobians | [`ArmSpec`], [`StrainModel`] |
//! | compute the shape of a rod from its strain | [`shape::Shape`], [`se3`] |
//! | add a dead time, backlash, friction, … to a nominal model | [`effects::find`], [`augmented::AugmentedModel`] |
//! | step such a model sample by sample | [`augmented::OnlineModel`] |
//!
//! ```
//! use acm_core::{NominalSpec, Observations, calibrate};
//! use nalgebra::DMatrix;
//!
//! // 100 samples of two actuators [T×2] and one output [T×1].
//! let actuators = DMatrix::from_fn(100, 2, |t, a| (t as f64 * [0.13, 0.07][a]).sin());
//! let measured = DMatrix::from_fn(100, 1, |t, _| 0.3 + 0.5 * actuators[(t, 0)] * actuators[(t, 1)]);
//! let data = Observations { actuators, measured, at: vec![] };
//! let found = calibrate(&NominalSpec::Polynomial { degree: 2 }, &data)?;
//! assert!(found.rms_total < 1e-12);
//! # Ok::<(), acm_core::CalibrationError>(())
//! ```
//!
//! The README calibrates a continuum arm.
//!
//! # Modules
//!
//! | module | contents |
//! | --- | --- |
//! | [`se3`] | rigid motions and their exponential |
//! | [`strain`], [`axis`], [`grid`], [`shape`] | strain along the arm → pose along the arm |
//! | [`actuation`], [`registration`], [`tip_model`] | actuators → strain → marker positions in the measurement frame |
//! | [`polynomial`] | polynomial from actuators to outputs, the comparator |
//! | [`least_squares`], [`levenberg_marquardt`] | linear and nonlinear least squares |
//! | [`arm`], [`nominal`], [`observations`], [`calibration`] | model specification, data, calibration and its result |
//! | [`rig`], [`record`] | signals of a rig, and the columns of one trial, as effects read them |
//! | [`clock_corrected`] | a record whose actuator time stamps are shifted |
//! | [`static_map`] | static discrepancy of a nominal model as a function of the actuators |
//! | [`effects`], [`fields`] | library of physical effects |
//! | [`response`], [`augmented`] | nominal model with effects |
//! | [`order_study`], [`degree`] | strain orders that an arm needs, degree of a polynomial, chosen on data |
//! | [`display`] | numbers and units for readers |
//!
//! All quantities are f64 in SI units. The crate reads no files and holds no networks.

pub mod actuation;
pub mod arm;
pub mod augmented;
pub mod display;
pub mod effects;
pub mod fields;
mod fitting;
mod kinematics;
pub mod nominal;
pub mod polynomial;
mod recorded;
pub mod registration;
pub mod response;
pub mod static_map;
pub mod tip_model;

pub use arm::{ArmError, ArmSpec};
pub use fitting::calibration::{Calibration, CalibrationOptions, Parameter, Stage, calibrate, calibrate_with};
pub use fitting::completion::completed;
pub use fitting::levenberg_marquardt::StopReason;
pub use fitting::observations::{CalibrationError, Observations};
pub use fitting::{calibration, degree, least_squares, left_out, levenberg_marquardt, observations, order_study};
pub use kinematics::{axis, grid, se3, shape, strain};
pub use nominal::{NominalModel, NominalSpec};
pub use recorded::clock_correction::clock_corrected;
pub use recorded::inter_sample::{self, InterSample};
pub use recorded::starts::{resting, turning};
pub use recorded::{record, rig, slope};
pub use tip_model::StrainModel;

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
