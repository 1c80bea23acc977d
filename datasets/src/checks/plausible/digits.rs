//! Values as warnings show them.

/// Four digits behind the point, or as many as are needed to tell it from zero.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-3..1e9).contains(&size) { format!("{value:.4}") } else { format!("{value:.3e}") }
}
