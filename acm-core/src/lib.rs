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
pub mod axis;
pub mod calibration;
mod clock_correction;
mod coefficients;
pub mod display;
pub mod effects;
pub mod fields;
mod fold;
pub mod grid;
mod lanes;
pub mod least_squares;
pub mod levenberg_marquardt;
mod linear;
mod magnus;
pub mod nominal;
pub mod observations;
pub mod order_study;
pub mod polynomial;
mod real;
pub mod record;
pub mod registration;
pub mod response;
pub mod rig;
pub mod se3;
pub mod shape;
pub mod static_map;
pub mod strain;
mod strain_fit;
mod strain_start;
pub mod tip_model;
mod triangle;
mod triple;
mod trust_region;

pub use arm::{ArmError, ArmSpec};
pub use calibration::{Calibration, CalibrationOptions, Parameter, Stage, calibrate, calibrate_with};
pub use clock_correction::clock_corrected;
pub use levenberg_marquardt::StopReason;
pub use nominal::{NominalModel, NominalSpec};
pub use observations::{CalibrationError, Observations};
pub use tip_model::StrainModel;
