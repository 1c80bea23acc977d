//! Parameters of a network: their first values, and all of them as one row of numbers.

pub mod first_values;
pub mod flat;
