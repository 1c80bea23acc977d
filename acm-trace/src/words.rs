//! Numbers as a sentence shows them.

/// With `digits` significant digits, and the minus sign of print; powers of ten where many zeros would stand.
pub(crate) fn number(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".into() } else { format!("{value}") };
    }
    let digits = digits.max(1) as i32;
    // By way of the rounded value, so that 0.9996 becomes 1.00 and not 1.000.
    let rounded: f64 = format!("{:.*e}", (digits - 1) as usize, value.abs()).parse().unwrap_or(value.abs());
    let power = rounded.log10().floor() as i32;
    let sign = if value < 0.0 { "−" } else { "" };
    if (-4..=5).contains(&power) {
        format!("{sign}{rounded:.*}", (digits - 1 - power).max(0) as usize)
    } else {
        format!("{sign}{:.*}·10{}", (digits - 1) as usize, rounded / 10f64.powi(power), superscript(power))
    }
}

fn superscript(power: i32) -> String {
    let of = |digit: char| match digit {
        '-' => '⁻',
        digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize],
    };
    power.to_string().chars().map(of).collect()
}

/// A number with its unit; metres become millimetres, as in every report.
pub(crate) fn quantity(value: f64, unit: &str) -> String {
    match unit {
        "m" => format!("{} mm", number(1e3 * value, 2)),
        "" | "1" => number(value, 2),
        unit => format!("{} {unit}", number(value, 2)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn numbers_read_well() {
        assert_eq!(number(-0.09031, 3), "−0.0903");
        assert_eq!(number(0.99961, 3), "1.00");
        assert_eq!(number(1234.0, 3), "1230");
        assert_eq!(number(-1.234e-7, 3), "−1.23·10⁻⁷");
        assert_eq!(number(3.0e12, 2), "3.0·10¹²");
        assert_eq!(number(0.0, 3), "0");
        assert_eq!(quantity(0.00312, "m"), "3.1 mm");
        assert_eq!(quantity(0.12, "rad"), "0.12 rad");
    }
}
