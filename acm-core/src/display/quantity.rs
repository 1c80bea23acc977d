//! A value with its 95 % interval, with the digits that the interval justifies, in a common unit.
//!
//! | SI unit           | shown                                                |
//! | ----------------- | ---------------------------------------------------- |
//! | `m`, `m/…`        | `mm`, `mm/…` below 1                                 |
//! | `s`               | `ms` below 1                                         |
//! | `rad`, `rad/…`    | `rad`, `rad/…`, with `°`, `°/…` in brackets          |
//! | `m per kg`, …     | in the same way                                      |
//! | anything else     | with a power of ten where it is small or large       |
//!
//! The last digit shown is the second digit of the interval's width; of a value without a width, the third.

use super::{
    DIGITS, UNKNOWN,
    number::{decimals_of, fixed},
    unit::{Display, of_angle},
};

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
        let Some(rest) = of_angle(unit) else { return Self { value: si.value(), interval: si.interval() } };
        let degrees = Shown::of(value.to_degrees(), bounds.map(f64::to_degrees), &format!("°{rest}"));
        let with = |a: String, b: String| if a == UNKNOWN { a } else { format!("{a} ({b})") };
        Self { value: with(si.value(), degrees.value()), interval: with(si.interval(), degrees.interval()) }
    }
}

/// A value, its bounds, and how they are shown.
struct Shown {
    value: f64,
    bounds: [f64; 2],
    decimals: usize,
    display: Display,
}

impl Shown {
    fn of(value: f64, bounds: [f64; 2], unit: &str) -> Self {
        let finite = [value, bounds[0], bounds[1]].into_iter().filter(|v| v.is_finite());
        let display = familiar(unit, finite.fold(0.0, |largest, v| largest.max(v.abs())));
        let (value, bounds) = (value * display.factor, bounds.map(|bound| bound * display.factor));
        Self { value, bounds, decimals: decimals(value, bounds), display }
    }

    fn value(&self) -> String {
        if self.value.is_finite() {
            self.display.with_symbol(&fixed(self.value, self.decimals))
        } else {
            UNKNOWN.into()
        }
    }

    fn interval(&self) -> String {
        let [low, high] = self.bounds.map(|bound| match bound {
            b if b.is_finite() => fixed(b, self.decimals),
            b if b > 0.0 => "∞".into(),
            b if b < 0.0 => "−∞".into(),
            _ => UNKNOWN.into(),
        });
        if low == UNKNOWN && high == UNKNOWN {
            UNKNOWN.into()
        } else {
            self.display.with_symbol(&format!("{low} to {high}"))
        }
    }
}

/// Decimals that show the second digit of the interval's width, or three digits of the value where there is no width.
pub fn decimals(value: f64, [low, high]: [f64; 2]) -> usize {
    let width = high - low;
    let shown = if width.is_finite() && width > 0.0 { decimals_of(width, 2) } else { decimals_of(value, DIGITS) };
    shown.min(9)
}

/// The unit that readers know.
fn familiar(unit: &str, largest: f64) -> Display {
    let small = largest < 1.0;
    let (of, rest) = unit.split_at(unit.find([' ', '/']).unwrap_or(unit.len()));
    let (factor, name) = match of {
        "m" if small => (1000.0, format!("mm{rest}")),
        "s" if small && !rest.starts_with('/') => (1000.0, format!("ms{rest}")),
        _ => (1.0, unit.to_string()),
    };
    let display = Display::with_power(&name, factor * largest);
    Display { si: unit.into(), factor: factor * display.factor, ..display }
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
        assert_eq!(shown(3.21e-7, [3.11e-7, 3.31e-7], "1/Pa"), pair("321 · 10⁻⁹ per Pa", "311 to 331 · 10⁻⁹ per Pa"));
        assert_eq!(shown(0.02, [0.01, 0.03], "m per kg"), pair("20 mm per kg", "10 to 30 mm per kg"));
        assert_eq!(shown(0.02, [0.01, 0.03], "s per kg").0, "20 ms per kg");
        assert_eq!(shown(0.02, [0.01, 0.03], "m/s per 1").0, "20 mm/s");
        assert_eq!(shown(0.05, [0.04, 0.06], "rad per 1").0, "0.050 rad (2.9°)");
        assert_eq!(shown(2.93, [2.9, 2.96], "1 per N*m").0, "2.930 per N·m");
        assert_eq!(shown(10.6, [6.8, 14.5], "1/(m/s)").0, "10.6 per m/s");
        assert_eq!(shown(0.05, [0.04, 0.06], "rad per kg").0, "0.050 rad per kg (2.9° per kg)");
        assert_eq!(shown(0.93, [0.91, 0.95], "1"), pair("0.930", "0.910 to 0.950"));
        assert_eq!(shown(4.0, [4.0, 4.0], "kg"), pair("4.00 kg", "4.00 to 4.00 kg"));
    }

    #[test]
    fn what_is_no_number_is_said_to_be_none() {
        assert_eq!(shown(f64::NAN, [f64::NAN; 2], "rad"), (UNKNOWN.into(), UNKNOWN.into()));
        assert_eq!(shown(2.0, [1.0, f64::INFINITY], "N").1, "1.00 to ∞ N");
    }
}
