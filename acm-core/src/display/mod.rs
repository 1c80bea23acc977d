//! Numbers and units for readers: significant digits, one SI prefix for values that are shown together.
//!
//! Inside the program every quantity is f64 in SI units. Tables, sentences and figures show it through this module.

mod number;
mod quantity;
mod unit;

pub use number::{decimals_of, fixed, percent, plain, signed, significant, with_spread};
pub use quantity::{Quantity, decimals};
pub use unit::{Display, labelled, readable, shown, with_symbol};

/// Placeholder for a value that is not a number.
pub const UNKNOWN: &str = "–";

/// Significant digits of a number without a known spread.
pub const DIGITS: i32 = 3;
