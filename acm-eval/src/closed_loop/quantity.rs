//! Numbers for people: as many digits as the interval justifies, in units that a reader has a feeling for.
//!
//! | SI                | shown                                                  |
//! | `m`, `m/…`        | `mm`, `mm/…` below 1                                   |
//! | `s`               | `ms` below 1                                           |
//! | `rad`, `rad/…`    | `rad`, `rad/…`, with `°`, `°/…` in brackets            |
//! | `m per kg`, …     | in the same way                                        |
//! | anything else     | as it is, with a power of ten where it is small or big |
//!
//! The last digit shown is the second digit of the interval's width.

use crate::tables::fixed;

/// A value and its bounds as words, each with the unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// `0.0524 rad (3.00°)`.
    pub value: String,
    /// `0.0511 to 0.0537 rad (2.93 to 3.08°)`.
    pub interval: String,
}

impl Quantity {
    /// `value` within `bounds`, all in the SI unit `unit`.
    pub fn of(value: f64, bounds: [f64; 2], unit: &str) -> Self {
        let si = Shown::of(value, bounds, unit);
        let Some(rest) = angle(unit) else { return Self { value: si.value(), interval: si.interval() } };
        let degrees = Shown::of(value.to_degrees(), bounds.map(f64::to_degrees), &format!("°{rest}"));
        let with = |a: String, b: String| if a == UNKNOWN { a } else { format!("{a} ({b})") };
        Self { value: with(si.value(), degrees.value()), interval: with(si.interval(), degrees.interval()) }
    }
}

/// What stands for a number that is none.
pub const UNKNOWN: &str = "–";

/// A value, its bounds, and how they are shown.
struct Shown {
    value: f64,
    bounds: [f64; 2],
    decimals: usize,
    unit: String,
}

impl Shown {
    fn of(value: f64, bounds: [f64; 2], unit: &str) -> Self {
        let magnitude = |factor: f64| {
            [value, bounds[0], bounds[1]]
                .iter()
                .filter(|v| v.is_finite())
                .fold(0.0_f64, |m, v| m.max((v * factor).abs()))
        };
        let (mut factor, mut unit) = familiar(unit, magnitude(1.0));
        let size = magnitude(factor);
        if size > 0.0 && !(1e-3..1e6).contains(&size) {
            let power = 3 * (size.log10() / 3.0).floor() as i32;
            factor *= 10f64.powi(-power);
            unit = format!("· 10{} {unit}", superscript(power)).trim_end().to_string();
        }
        let (value, bounds) = (value * factor, bounds.map(|bound| bound * factor));
        Self { value, bounds, decimals: decimals(value, bounds), unit }
    }

    fn value(&self) -> String {
        if self.value.is_finite() { self.with_unit(fixed(self.value, self.decimals)) } else { UNKNOWN.into() }
    }

    fn interval(&self) -> String {
        let [low, high] = self.bounds.map(|bound| match bound {
            b if b.is_finite() => fixed(b, self.decimals),
            b if b > 0.0 => "∞".into(),
            b if b < 0.0 => "−∞".into(),
            _ => UNKNOWN.into(),
        });
        if low == UNKNOWN && high == UNKNOWN { UNKNOWN.into() } else { self.with_unit(format!("{low} to {high}")) }
    }

    fn with_unit(&self, number: String) -> String {
        match self.unit.as_str() {
            "" => number,
            unit if unit.starts_with('°') => format!("{number}{unit}"),
            unit => format!("{number}\u{a0}{unit}"),
        }
    }
}

/// Decimals that show the second digit of the interval's width, or four digits of the value where there is no width.
pub fn decimals(value: f64, [low, high]: [f64; 2]) -> usize {
    let width = high - low;
    let (size, digits) = if width.is_finite() && width > 0.0 { (width, 2) } else { (value.abs(), 4) };
    let exponent = if size.is_finite() && size > 0.0 { size.log10().floor() as i32 } else { 0 };
    (digits - 1 - exponent).clamp(0, 6) as usize
}

/// Factor and name of the unit that a reader has a feeling for.
fn familiar(unit: &str, magnitude: f64) -> (f64, String) {
    let small = magnitude < 1.0;
    // A slope with a signal that has no unit.
    let unit = unit.strip_suffix(" per 1").unwrap_or(unit);
    let (of, rest) = unit.split_at(unit.find([' ', '/']).unwrap_or(unit.len()));
    match (of, rest) {
        ("m", _) if small => (1000.0, format!("mm{rest}")),
        ("s", rest) if small && !rest.starts_with('/') => (1000.0, format!("ms{rest}")),
        ("1", rest) if !rest.starts_with('/') => (1.0, rest.trim_start().to_string()),
        _ => (1.0, unit.to_string()),
    }
}

/// What follows `rad` in the unit of an angle, its rate, or its share of something.
fn angle(unit: &str) -> Option<&str> {
    unit.strip_prefix("rad").filter(|rest| !rest.starts_with(|c: char| c.is_alphanumeric()))
}

/// Factor and name for an axis: degrees and millimetres, whatever the size.
pub fn for_axis(unit: &str) -> (f64, String) {
    match (unit, angle(unit)) {
        (_, Some(rest)) => (1f64.to_degrees(), format!("°{rest}")),
        ("m", _) => (1000.0, "mm".into()),
        ("1", _) => (1.0, String::new()),
        (other, _) => (1.0, other.to_string()),
    }
}

fn superscript(power: i32) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => char::from_u32('⁰' as u32 + c.to_digit(10).unwrap_or(0)).unwrap_or('⁰'),
    };
    power.to_string().chars().map(digit).collect()
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

/// A number alone, with so many decimals.
pub fn plain(value: f64, decimals: usize) -> String {
    if value.is_finite() { fixed(value, decimals) } else { UNKNOWN.into() }
}

/// Decimals that show three digits of the smallest of the values, so that a column of them has one point.
pub fn common_decimals(values: impl IntoIterator<Item = f64>) -> usize {
    let sizes = values.into_iter().map(f64::abs).filter(|size| size.is_finite() && *size > 0.0);
    let smallest = sizes.fold(f64::INFINITY, f64::min);
    if smallest.is_finite() { (2 - smallest.log10().floor() as i32).clamp(0, 6) as usize } else { 2 }
}

/// A number alone, with so many significant digits.
pub fn significant(value: f64, digits: i32) -> String {
    if !value.is_finite() {
        return UNKNOWN.into();
    }
    let exponent = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    if !(-5..7).contains(&exponent) {
        let mantissa = fixed(value / 10f64.powi(exponent), (digits - 1).max(0) as usize);
        return format!("{mantissa} · 10{}", superscript(exponent));
    }
    fixed(value, (digits - 1 - exponent).clamp(0, 12) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(value: f64, bounds: [f64; 2], unit: &str) -> (String, String) {
        let quantity = Quantity::of(value, bounds, unit);
        (quantity.value.replace('\u{a0}', " "), quantity.interval.replace('\u{a0}', " "))
    }

    /// Oracle: written by hand.
    #[test]
    fn the_interval_decides_the_digits_and_the_size_decides_the_unit() {
        let pair = |value: &str, interval: &str| (value.to_string(), interval.to_string());
        assert_eq!(shown(0.05236, [0.0511, 0.0537], "rad"), {
            pair("0.0524 rad (3.00°)", "0.0511 to 0.0537 rad (2.93 to 3.08°)")
        });
        assert_eq!(shown(0.0123456, [0.0113, 0.0133], "m"), pair("12.3 mm", "11.3 to 13.3 mm"));
        assert_eq!(shown(0.2204, [0.2133, 0.2275], "s"), pair("220 ms", "213 to 228 ms"));
        assert_eq!(shown(3.456, [2.9, 4.1], "s"), pair("3.5 s", "2.9 to 4.1 s"));
        assert_eq!(shown(-0.004, [-0.005, -0.003], "m/N"), pair("−4.0 mm/N", "−5.0 to −3.0 mm/N"));
        assert_eq!(shown(3.21e-7, [3.11e-7, 3.31e-7], "1/Pa"), pair("321 · 10⁻⁹ 1/Pa", "311 to 331 · 10⁻⁹ 1/Pa"));
        assert_eq!(shown(0.02, [0.01, 0.03], "m per kg"), pair("20 mm per kg", "10 to 30 mm per kg"));
        assert_eq!(shown(0.02, [0.01, 0.03], "s per kg").0, "20 ms per kg");
        assert_eq!(shown(0.02, [0.01, 0.03], "m/s per 1").0, "20 mm/s");
        assert_eq!(shown(0.05, [0.04, 0.06], "rad per 1").0, "0.050 rad (2.9°)");
        assert_eq!(shown(0.5, [0.4, 0.6], "1 per kg").0, "0.50 per kg");
        assert_eq!(shown(0.05, [0.04, 0.06], "rad per kg").0, "0.050 rad per kg (2.9° per kg)");
        assert_eq!(shown(0.93, [0.91, 0.95], "1"), pair("0.930", "0.910 to 0.950"));
        assert_eq!(shown(4.0, [4.0, 4.0], "kg"), pair("4.000 kg", "4.000 to 4.000 kg"));
    }

    #[test]
    fn what_is_no_number_is_said_to_be_none() {
        assert_eq!(shown(f64::NAN, [f64::NAN; 2], "rad"), (UNKNOWN.into(), UNKNOWN.into()));
        assert_eq!(shown(2.0, [1.0, f64::INFINITY], "N").1, "1.000 to ∞ N");
        assert_eq!((percent(f64::NAN), plain(f64::NAN, 2)), (UNKNOWN.into(), UNKNOWN.into()));
        assert_eq!(
            [0.974, 0.0312, 0.9964, -0.4].map(percent),
            ["97\u{a0}%", "3.1\u{a0}%", "99.6\u{a0}%", "−40\u{a0}%"]
        );
        assert_eq!((significant(0.012345, 3), significant(1.5e-9, 2)), ("0.0123".into(), "1.5 · 10⁻⁹".into()));
    }

    #[test]
    fn a_unit_that_begins_like_an_angle_is_none() {
        assert_eq!(angle("rad/s"), Some("/s"));
        assert_eq!((angle("radish"), for_axis("m/s")), (None, (1.0, "m/s".into())));
    }
}
