//! Fitting: least squares, and the calibration of nominal models.

pub mod calibration;
pub mod completion;
pub mod degree;
pub mod least_squares;
pub mod left_out;
pub mod levenberg_marquardt;
pub mod linear;
pub mod multi_start;
pub mod observations;
pub mod order_study;
pub mod strain_fit;
pub mod strain_start;
pub mod triangle;
pub mod trust_region;
