//! Numbers with as many decimals as a table has.

/// Returns a number rounded to some decimals.
pub fn round_to(value: f64, decimals: i32) -> f64 {
    let scale = 10f64.powi(decimals);
    (value * scale).round() / scale
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_by_hand() {
        assert_eq!(round_to(0.123_456_78, 4), 0.1235);
        assert_eq!(round_to(-2.5e-7, 6), -0.0);
        assert_eq!(round_to(0.86, 5), 0.86);
    }
}
