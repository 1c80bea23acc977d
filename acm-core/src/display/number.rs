//! Numbers with a given number of significant digits, for print.

use super::{DIGITS, UNKNOWN};

/// A number with a true minus sign, and without a sign at zero.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| matches!(c, '0' | '.')) => digits.to_string(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

/// A number alone, with so many decimals.
pub fn plain(value: f64, decimals: usize) -> String {
    if value.is_finite() { fixed(value, decimals) } else { UNKNOWN.into() }
}

/// A number with `digits` significant digits: `0.0903`, `1.00`, `1234`, `1.23 · 10⁻⁷`.
///
/// Digits before the point are never rounded away, up to a million.
pub fn significant(value: f64, digits: i32) -> String {
    if !value.is_finite() {
        return UNKNOWN.into();
    }
    let power = power_of(value, digits);
    if (-4..6).contains(&power) {
        return fixed(value, decimals_of(value, digits));
    }
    let mantissa = fixed(value / 10f64.powi(power), (digits - 1).max(0) as usize);
    format!("{mantissa} · 10{}", superscript(power))
}

/// Decimals that show `digits` significant digits of `value`; none of a zero.
pub fn decimals_of(value: f64, digits: i32) -> usize {
    let none = value == 0.0 || !value.is_finite();
    if none { 0 } else { (digits - 1 - power_of(value, digits)).clamp(0, 300) as usize }
}

/// Power of ten of the first digit once the value is rounded: 0.9996 is 1.00 with three digits.
fn power_of(value: f64, digits: i32) -> i32 {
    let text = format!("{:.*e}", (digits - 1).max(0) as usize, value);
    text.split_once('e').and_then(|(_, power)| power.parse().ok()).unwrap_or(0)
}

/// `29.5 ± 1.9`: two significant digits of the spread, and the value to the same place; three digits where nothing spreads.
pub fn with_spread(value: f64, sd: Option<f64>) -> String {
    // Rounding leaves a spread of 1e-16 where every run says the same.
    let Some(sd) = sd.filter(|sd| *sd > 1e-9 * value.abs()) else { return significant(value, DIGITS) };
    let decimals = decimals_of(sd, 2);
    if decimals > 6 || power_of(value, DIGITS).max(power_of(sd, 2)) >= 6 {
        return format!("{} ± {}", significant(value, DIGITS), significant(sd, 2));
    }
    format!("{} ± {}", plain(value, decimals), plain(sd, decimals))
}

/// `text` of a difference, with a plus where it is above zero.
pub fn signed(value: f64, text: String) -> String {
    if value > 0.0 { format!("+{text}") } else { text }
}

/// A share as percent, with a decimal where it is close to none or all.
pub fn percent(share: f64) -> String {
    if !share.is_finite() {
        return UNKNOWN.into();
    }
    let value = 100.0 * share;
    let close = (0.05..9.95).contains(&value.abs()) || (99.0..99.95).contains(&value);
    format!("{}\u{a0}%", fixed(value, usize::from(close)))
}

pub(super) fn superscript(power: i32) -> String {
    let of = |digit: char| match digit {
        '-' => '⁻',
        digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize],
    };
    power.to_string().chars().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: written by hand.
    #[test]
    fn three_digits_whatever_the_size() {
        for (value, text) in [
            (0.000_216_4, "0.000216"),
            (-0.09031, "−0.0903"),
            (0.99961, "1.00"),
            (43.917, "43.9"),
            (1234.4, "1234"),
            (-1.234e-7, "−1.23 · 10⁻⁷"),
            (9.999e-5, "0.000100"),
            (3.0e12, "3.00 · 10¹²"),
            (0.0, "0"),
            (f64::NAN, UNKNOWN),
        ] {
            assert_eq!(significant(value, 3), text);
        }
    }

    /// Oracle: written by hand.
    #[test]
    fn the_spread_decides_the_digits() {
        assert_eq!(with_spread(29.5412, Some(1.8912)), "29.5 ± 1.9");
        assert_eq!(with_spread(-12.34567, Some(0.0123)), "−12.346 ± 0.012");
        assert_eq!(with_spread(0.000_216_4, Some(0.000_031_2)), "0.000216 ± 0.000031");
        assert_eq!(with_spread(3.2e-9, Some(1.1e-9)), "3.20 · 10⁻⁹ ± 1.1 · 10⁻⁹");
        assert_eq!(with_spread(28.46, Some(1e-15)), "28.5");
        assert_eq!(with_spread(28.46, None), "28.5");
    }

    #[test]
    fn zero_has_no_sign_and_shares_are_percent() {
        assert_eq!(fixed(-0.0001, 2), "0.00");
        assert_eq!(
            [0.974, 0.0312, 0.9964, -0.4].map(percent),
            ["97\u{a0}%", "3.1\u{a0}%", "99.6\u{a0}%", "−40\u{a0}%"]
        );
        assert_eq!((percent(f64::NAN), plain(f64::NAN, 2)), (UNKNOWN.into(), UNKNOWN.into()));
    }
}
