//! Units for readers: one factor and one symbol for values that are shown together.
//!
//! | SI unit                                              | shown, by the size of the largest value              |
//! | ---------------------------------------------------- | ---------------------------------------------------- |
//! | `m`                                                  | mm from 0.01 mm to 10 m; beyond with another prefix  |
//! | `rad`                                                | ° from half a degree; mrad, µrad, nrad below         |
//! | `s` `N` `N*m` `Pa` `V` `A` `Hz` `K` `m/s` `rad/s` `m/s^2` | with the prefix that leaves 0.1 to 1000 before it |
//! | `1` and compound units                               | with a power of ten below 0.001 and from a million   |

use super::number::{significant, superscript};

/// How values of one SI unit are shown: multiply by `factor`, then write `symbol`.
#[derive(Debug, Clone, PartialEq)]
pub struct Display {
    /// The unit of the values themselves.
    pub si: String,
    /// Shown value per SI value.
    pub factor: f64,
    /// Unit symbol for readers; empty for a plain number.
    pub symbol: String,
}

/// Units that take a prefix.
const PREFIXED: [&str; 13] = ["m", "rad", "s", "N", "N*m", "Pa", "V", "A", "Hz", "K", "m/s", "rad/s", "m/s^2"];

/// Powers of ten and their prefixes.
const PREFIXES: [(i32, &str); 7] = [(-9, "n"), (-6, "µ"), (-3, "m"), (0, ""), (3, "k"), (6, "M"), (9, "G")];

impl Display {
    /// For values in the SI unit `si` of which the largest is about `size`.
    pub fn of(si: &str, size: f64) -> Self {
        let size = size.abs();
        if !size.is_finite() || size == 0.0 {
            return Self::fixed(si);
        }
        match si {
            "m" if (1e-5..10.0).contains(&size) => Self::fixed(si),
            "rad" if size >= 0.5_f64.to_radians() => {
                Self { si: si.into(), factor: 1f64.to_degrees(), symbol: "°".into() }
            }
            _ if PREFIXED.contains(&si) => Self::prefixed(si, size),
            _ => Self::with_power(si, size),
        }
    }

    /// Millimetres for lengths; any other SI unit as it is. Independent of the values, for programs that read them.
    pub fn fixed(si: &str) -> Self {
        match si {
            "m" => Self { si: si.into(), factor: 1e3, symbol: "mm".into() },
            other => Self { si: si.into(), factor: 1.0, symbol: readable(other) },
        }
    }

    fn prefixed(si: &str, size: f64) -> Self {
        let power = if (0.1..1.0).contains(&size) { 0 } else { thousands(size) };
        let known = PREFIXES.iter().find(|(known, _)| *known == power);
        let Some((power, prefix)) = known else { return Self::with_power(si, size) };
        Self { si: si.into(), factor: scale(*power), symbol: format!("{prefix}{}", readable(si)) }
    }

    /// As it is, with a power of ten where it is small or large.
    pub(super) fn with_power(si: &str, size: f64) -> Self {
        if size == 0.0 || (1e-3..1e6).contains(&size) {
            return Self { si: si.into(), factor: 1.0, symbol: readable(si) };
        }
        let power = thousands(size);
        let symbol = format!("10{} {}", superscript(power), readable(si)).trim_end().to_string();
        Self { si: si.into(), factor: scale(power), symbol }
    }

    /// For an axis: degrees and millimetres, whatever the size.
    pub fn for_axis(si: &str) -> Self {
        match of_angle(si) {
            Some(rest) => Self { si: si.into(), factor: 1f64.to_degrees(), symbol: format!("°{rest}") },
            None => Self::fixed(si),
        }
    }

    /// An SI value with three significant digits and the symbol.
    pub fn show(&self, value: f64) -> String {
        self.with_symbol(&significant(value * self.factor, super::DIGITS))
    }

    /// `title [mm]`, for an axis or the head of a column; the title alone of a plain number.
    pub fn label(&self, title: &str) -> String {
        labelled(title, &self.symbol)
    }

    /// A number and this symbol, with a no-break space between; `3.0°` without.
    pub fn with_symbol(&self, number: &str) -> String {
        with_symbol(number, &self.symbol)
    }
}

/// `title [mm]`; the title alone without a symbol.
pub fn labelled(title: &str, symbol: &str) -> String {
    if symbol.is_empty() { title.into() } else { format!("{title} [{symbol}]") }
}

/// A number and the symbol of its unit: `12.3 mm`, `3.0°`, `321 · 10⁻⁹ per Pa`.
pub fn with_symbol(number: &str, symbol: &str) -> String {
    match symbol {
        "" => number.into(),
        symbol if symbol.starts_with('°') => format!("{number}{symbol}"),
        symbol if symbol.starts_with("10") => format!("{number}\u{a0}· {symbol}"),
        symbol => format!("{number}\u{a0}{symbol}"),
    }
}

/// One SI value in the unit that suits it, with three significant digits: `3.12 mm`.
pub fn shown(value: f64, si: &str) -> String {
    Display::of(si, value).show(value)
}

/// The multiple of three at or below the power of ten of `size`.
fn thousands(size: f64) -> i32 {
    3 * (size.log10() / 3.0 + 1e-12).floor() as i32
}

/// `10^−power`, exact where that is a whole number.
fn scale(power: i32) -> f64 {
    if power <= 0 { 10f64.powi(-power) } else { 1.0 / 10f64.powi(power) }
}

/// A unit as print shows it: `N·m` for `N*m`, `m/s²` for `m/s^2`, `per m/s` for `1/(m/s)`; nothing for `1`.
pub fn readable(si: &str) -> String {
    // A slope with a signal that has no unit.
    let si = si.strip_suffix(" per 1").unwrap_or(si);
    let inverse =
        si.strip_prefix("1/").map(|of| of.strip_prefix('(').and_then(|of| of.strip_suffix(')')).unwrap_or(of));
    let text = match (si, inverse) {
        ("1", _) => String::new(),
        (_, Some(of)) => format!("per {of}"),
        _ => si.strip_prefix("1 per").map_or(si.into(), |of| format!("per{of}")),
    };
    text.replace('*', "·").replace("^2", "²").replace("^3", "³")
}

/// Rest of the unit behind `rad` for an angle, its rate, or a share; none of `rad/(rad/s)`, where radians cancel.
pub(super) fn of_angle(unit: &str) -> Option<&str> {
    unit.strip_prefix("rad").filter(|rest| !rest.starts_with(|c: char| c.is_alphanumeric()) && !rest.contains("rad"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: written by hand.
    #[test]
    fn the_largest_value_chooses_the_prefix() {
        for (si, size, factor, symbol) in [
            ("m", 0.0439, 1e3, "mm"),
            ("m", 3e-7, 1e9, "nm"),
            ("m", 4e-6, 1e6, "µm"),
            ("m", 25.0, 1.0, "m"),
            ("m", 0.0, 1e3, "mm"),
            ("rad", 0.02, 180.0 / std::f64::consts::PI, "°"),
            ("rad", 0.0004, 1e6, "µrad"),
            ("rad", 0.002, 1e3, "mrad"),
            ("N*m", 0.0021, 1e3, "mN·m"),
            ("N*m", 0.21, 1.0, "N·m"),
            ("N", 1760.0, 1e-3, "kN"),
            ("Pa", 250_000.0, 1e-3, "kPa"),
            ("m/s^2", 9.81, 1.0, "m/s²"),
            ("1", 0.0603, 1.0, ""),
            ("1", 2e-5, 1e6, "10⁻⁶"),
            ("N*m/rad", 3e-5, 1e6, "10⁻⁶ N·m/rad"),
        ] {
            let shown = Display::of(si, size);
            assert!((shown.factor / factor - 1.0).abs() < 1e-12 && shown.symbol == symbol, "{si} {size}: {shown:?}");
        }
        assert_eq!(Display::of("rad", f64::NAN), Display::fixed("rad"));
    }

    #[test]
    fn a_value_carries_its_symbol() {
        assert_eq!(Display::of("N*m", 0.0021).show(0.00213), "2.13\u{a0}mN·m");
        assert_eq!(Display::for_axis("rad/s").symbol, "°/s");
        assert_eq!(Display::for_axis("radish").factor, 1.0);
    }

    #[test]
    fn units_are_written_for_readers() {
        let units = ["1", "N*m", "m/s^2", "1/(m/s)", "1/Pa", "1 per N*m", "m per kg", "m/s per 1", "rad/(m/s)"];
        let shown = ["", "N·m", "m/s²", "per m/s", "per Pa", "per N·m", "m per kg", "m/s", "rad/(m/s)"];
        assert_eq!(units.map(readable), shown);
        assert_eq!(Display::of("1", 2e-5).with_symbol("21"), "21\u{a0}· 10⁻⁶");
        assert_eq!(Display::of("rad", 1.0).with_symbol("57.3"), "57.3°");
    }

    #[test]
    fn a_unit_that_begins_like_an_angle_is_none() {
        assert_eq!((of_angle("rad/s"), of_angle("radish"), of_angle("rad/(rad/s)")), (Some("/s"), None, None));
    }
}
