//! Colours: one meaning, one colour, in every figure.

use crate::figures::canvas::palette;

/// The nominal model.
pub const NOMINAL: &str = palette::VERMILLION;
/// The nominal model, in the background.
pub const NOMINAL_PALE: &str = "#f2c6a5";
/// The best baseline.
pub const BEFORE: &str = palette::ORANGE;
/// Colour of the model with the effect.
pub const AFTER: &str = palette::BLUE;
/// Colour of the model with the effect, in the background.
pub const AFTER_PALE: &str = "#a9cce3";
/// Colour of the measurement.
pub const MEASURED: &str = "#a8a8a8";
/// Colour of noise.
pub const NOISE: &str = palette::GREY;
/// Colour of the range of noise.
pub const NOISE_PALE: &str = "#e6e6e6";
/// A share of a whole: the more of it, the less of the paper shines through.
pub const CELL: &str = "#00548a";
