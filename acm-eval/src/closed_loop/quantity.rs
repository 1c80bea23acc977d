//! Numbers of a finding, as its page and summary show them.

use acm_core::display::decimals_of;
pub use acm_core::display::{Quantity, UNKNOWN, decimals, percent, plain, significant};
use acm_trace::finding::FoundParameter;

/// Returns a parameter's value and interval in words; that it is open where the data do not determine it.
pub fn of_parameter(parameter: &FoundParameter) -> Quantity {
    if parameter.undetermined {
        return Quantity { value: "not determined by these data".into(), interval: UNKNOWN.into() };
    }
    Quantity::of(parameter.value, parameter.interval, &parameter.unit)
}

/// Returns the number of decimals that show three digits of the smallest of the values, for all values of a column.
pub fn common_decimals(values: impl IntoIterator<Item = f64>) -> usize {
    let sizes = values.into_iter().map(f64::abs).filter(|size| size.is_finite() && *size > 0.0);
    let smallest = sizes.fold(f64::INFINITY, f64::min);
    if smallest.is_finite() { decimals_of(smallest, 3).min(6) } else { 2 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: written by hand.
    #[test]
    fn a_column_has_one_point_and_an_interval_decides_the_digits() {
        assert_eq!(common_decimals([120.0, 0.0, 3.4]), 2);
        assert_eq!((decimals(8.77, [7.7, 9.9]), decimals(8.77, [8.77, 8.77])), (1, 2));
    }

    #[test]
    fn an_open_value_is_said_to_be_open() {
        let mut parameter = FoundParameter {
            name: "gain".into(),
            value: 0.0,
            unit: "1 per N*m".into(),
            interval: [-6.3e157, 6.3e157],
            depends_on: None,
            at_bound: false,
            undetermined: true,
        };
        assert_eq!(of_parameter(&parameter).value, "not determined by these data");
        (parameter.undetermined, parameter.interval) = (false, [-0.1, 0.1]);
        assert_eq!(of_parameter(&parameter).interval, "−0.10 to 0.10\u{a0}per N·m");
    }
}
