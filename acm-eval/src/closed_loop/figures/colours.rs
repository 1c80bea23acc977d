//! The same meaning, the same colour, in every figure; from Okabe & Ito (2008), as everywhere in this program.

/// The nominal model.
pub const NOMINAL: &str = "#d55e00";
/// The nominal model, in the background.
pub const NOMINAL_PALE: &str = "#f2c6a5";
/// The best of the befores.
pub const BEFORE: &str = "#e69f00";
/// With the effect.
pub const AFTER: &str = "#0072b2";
/// With the effect, in the background.
pub const AFTER_PALE: &str = "#a9cce3";
/// What was measured.
pub const MEASURED: &str = "#a8a8a8";
/// Noise.
pub const NOISE: &str = "#6e6e6e";
/// Where noise stays.
pub const NOISE_PALE: &str = "#e6e6e6";
