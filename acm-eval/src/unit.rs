//! Units and names of reported quantities.

pub use acm_core::display::Display;
pub use acm_train::run::evaluation::summary::total_name;

/// Returns the subject of the estimates in words: a tip where the outputs are positions.
pub fn subject(unit: &str) -> &'static str {
    if unit == "m" { "tip" } else { "outputs" }
}
