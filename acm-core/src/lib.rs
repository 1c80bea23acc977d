//! Physics of a continuum arm: strain, shape, tip model and its calibration.
//!
//! | module | what |
//! | --- | --- |
//! | [`se3`] | rigid motions and their exponential |
//! | [`strain`], [`axis`], [`grid`], [`shape`] | strain along the arm → pose along the arm |
//! | [`actuation`], [`registration`], [`tip_model`] | actuators → strain → markers where they are measured |
//! | [`polynomial`] | comparator: a polynomial from actuators to outputs |
//! | [`least_squares`], [`levenberg_marquardt`] | fitting |
//! | [`arm`], [`nominal`], [`observations`], [`calibration`] | what is calibrated, on what, and the result |
//! | [`rig`], [`record`] | what was recorded, trial by trial, as an effect sees it |
//! | [`clock_corrected`] | a record whose actuators were stamped by a clock that is late |
//! | [`static_map`] | what a nominal model misses at rest |
//! | [`effects`], [`fields`] | physical effects that a nominal model may lack |
//! | [`response`], [`augmented`] | a nominal model with effects at their place |
//! | [`order_study`] | how many strain orders an arm needs |
//! | [`display`] | numbers and units for readers |
//!
//! f64 and SI throughout. Nothing here knows files, tables or networks.

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
pub use fitting::levenberg_marquardt::StopReason;
pub use fitting::observations::{CalibrationError, Observations};
pub use fitting::{calibration, least_squares, levenberg_marquardt, observations, order_study};
pub use kinematics::{axis, grid, se3, shape, strain};
pub use nominal::{NominalModel, NominalSpec};
pub use recorded::clock_correction::clock_corrected;
pub use recorded::{record, rig};
pub use tip_model::StrainModel;
