//! Units of measure, converted to SI on reading.
//!
//! `value in SI = value · numerator / denominator`: 105 mm becomes 105/1000 m, correctly rounded, and a value that is in
//! SI already keeps its bits. Degrees are `π/180`; per cent and counts have dimension one.

use std::f64::consts::PI;

/// Physical dimension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// A number: `1`, `%`.
    One,
    /// Plane angle, rad.
    Angle,
    /// Length, m.
    Length,
    /// Time, s.
    Time,
    /// Count of samples; it needs `rate_hz` to become a time.
    Sample,
    /// Frequency, Hz.
    Frequency,
    /// Mass, kg.
    Mass,
    /// Force, N.
    Force,
    /// Torque, N·m.
    Torque,
    /// Pressure, Pa.
    Pressure,
    /// Voltage, V.
    Voltage,
    /// Current, A.
    Current,
    /// Velocity, m/s.
    Velocity,
    /// Angular velocity, rad/s.
    AngularVelocity,
    /// Acceleration, m/s².
    Acceleration,
    /// Temperature, K.
    Temperature,
    /// Temperature in degrees Celsius, which stays in them: a model that needs kelvins adds 273.15 itself.
    Celsius,
    /// Power, W.
    Power,
    /// Volume flow, m³/s.
    Flow,
    /// Magnetic flux density, T.
    FluxDensity,
}

/// A unit that the program knows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Name in a manifest.
    pub name: &'static str,
    /// Physical dimension.
    pub dimension: Dimension,
    numerator: f64,
    denominator: f64,
}

/// The unit is not in the list.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown unit {name:?}{}; write \"1\" for a number in another unit; known units: {}", self.suggestion(), known())]
pub struct UnknownUnit {
    /// As written.
    pub name: String,
}

const fn unit(name: &'static str, dimension: Dimension, numerator: f64, denominator: f64) -> Unit {
    Unit { name, dimension, numerator, denominator }
}

/// Every known unit.
pub const ALL: &[Unit] = &[
    unit("1", Dimension::One, 1.0, 1.0),
    unit("%", Dimension::One, 1.0, 100.0),
    unit("rad", Dimension::Angle, 1.0, 1.0),
    unit("mrad", Dimension::Angle, 1.0, 1000.0),
    unit("deg", Dimension::Angle, PI, 180.0),
    unit("turn", Dimension::Angle, 2.0 * PI, 1.0),
    unit("m", Dimension::Length, 1.0, 1.0),
    unit("cm", Dimension::Length, 1.0, 100.0),
    unit("mm", Dimension::Length, 1.0, 1000.0),
    unit("um", Dimension::Length, 1.0, 1e6),
    unit("km", Dimension::Length, 1000.0, 1.0),
    unit("s", Dimension::Time, 1.0, 1.0),
    unit("ms", Dimension::Time, 1.0, 1000.0),
    unit("us", Dimension::Time, 1.0, 1e6),
    unit("ns", Dimension::Time, 1.0, 1e9),
    unit("min", Dimension::Time, 60.0, 1.0),
    unit("h", Dimension::Time, 3600.0, 1.0),
    unit("sample", Dimension::Sample, 1.0, 1.0),
    unit("Hz", Dimension::Frequency, 1.0, 1.0),
    unit("kg", Dimension::Mass, 1.0, 1.0),
    unit("g", Dimension::Mass, 1.0, 1000.0),
    unit("N", Dimension::Force, 1.0, 1.0),
    unit("mN", Dimension::Force, 1.0, 1000.0),
    unit("kN", Dimension::Force, 1000.0, 1.0),
    unit("N*m", Dimension::Torque, 1.0, 1.0),
    unit("N*mm", Dimension::Torque, 1.0, 1000.0),
    unit("mN*m", Dimension::Torque, 1.0, 1000.0),
    unit("kN*m", Dimension::Torque, 1000.0, 1.0),
    unit("Pa", Dimension::Pressure, 1.0, 1.0),
    unit("hPa", Dimension::Pressure, 100.0, 1.0),
    unit("kPa", Dimension::Pressure, 1000.0, 1.0),
    unit("MPa", Dimension::Pressure, 1e6, 1.0),
    unit("mbar", Dimension::Pressure, 100.0, 1.0),
    unit("bar", Dimension::Pressure, 1e5, 1.0),
    unit("psi", Dimension::Pressure, 6894.757293168361, 1.0),
    unit("V", Dimension::Voltage, 1.0, 1.0),
    unit("mV", Dimension::Voltage, 1.0, 1000.0),
    unit("A", Dimension::Current, 1.0, 1.0),
    unit("mA", Dimension::Current, 1.0, 1000.0),
    unit("m/s", Dimension::Velocity, 1.0, 1.0),
    unit("mm/s", Dimension::Velocity, 1.0, 1000.0),
    unit("rad/s", Dimension::AngularVelocity, 1.0, 1.0),
    unit("deg/s", Dimension::AngularVelocity, PI, 180.0),
    unit("rpm", Dimension::AngularVelocity, PI, 30.0),
    unit("m/s^2", Dimension::Acceleration, 1.0, 1.0),
    unit("K", Dimension::Temperature, 1.0, 1.0),
    unit("°C", Dimension::Celsius, 1.0, 1.0),
    unit("W", Dimension::Power, 1.0, 1.0),
    unit("kW", Dimension::Power, 1000.0, 1.0),
    unit("m^3/s", Dimension::Flow, 1.0, 1.0),
    unit("l/min", Dimension::Flow, 1.0, 60_000.0),
    unit("T", Dimension::FluxDensity, 1.0, 1.0),
];

impl Unit {
    /// Looks a unit up by its name, which is case-sensitive (mN is not MN). The usual ways to write it are one: `N m`, `N·m` and `Nm` for
    /// `N*m`, `m/s²` and `m/s2` for `m/s^2`, `µm` for `um`, `°` for `deg`.
    ///
    /// # Errors
    /// No unit has that name.
    pub fn parse(name: &str) -> Result<Unit, UnknownUnit> {
        let written = written(name);
        ALL.iter()
            .find(|u| u.name == name.trim() || u.name == written)
            .copied()
            .ok_or_else(|| UnknownUnit { name: name.chars().take(40).collect() })
    }

    /// `value · numerator / denominator`.
    pub fn to_si(&self, value: f64) -> f64 {
        value * self.numerator / self.denominator
    }

    /// How many SI units one of this unit is.
    pub fn factor(&self) -> f64 {
        self.numerator / self.denominator
    }

    /// A full turn in this unit; none if it is not a unit of angles.
    pub fn full_turn(&self) -> Option<f64> {
        (self.dimension == Dimension::Angle).then(|| std::f64::consts::TAU / self.factor())
    }

    /// The other units of the same dimension.
    pub fn siblings(&self) -> impl Iterator<Item = &'static Unit> + use<> {
        let unit = *self;
        ALL.iter().filter(move |u| u.dimension == unit.dimension && u.name != unit.name)
    }

    /// The name of the SI unit of this dimension, for reports.
    pub fn si_name(&self) -> &'static str {
        ALL.iter().find(|u| u.dimension == self.dimension && u.factor() == 1.0).map_or("1", |u| u.name)
    }
}

/// Returns a unit as this list writes it.
fn written(name: &str) -> String {
    let plain = name.trim().replace(['·', ' ', '⋅'], "*").replace('²', "^2").replace('³', "^3");
    let plain = plain.replace(['µ', 'μ'], "u").replace('°', "deg");
    match plain.as_str() {
        "Nm" => "N*m".into(),
        "Nmm" => "N*mm".into(),
        "m/s2" => "m/s^2".into(),
        "m3/s" => "m^3/s".into(),
        "L/min" => "l/min".into(),
        "degC" | "deg_C" | "ºC" | "℃" => "°C".into(),
        _ => plain,
    }
}

impl UnknownUnit {
    /// The unit that a long name or a name in another case means.
    pub(crate) fn meant(&self) -> Option<&'static str> {
        match self.name.to_lowercase().as_str() {
            "degree" | "degrees" => Some("deg"),
            "radian" | "radians" => Some("rad"),
            "metre" | "metres" | "meter" | "meters" => Some("m"),
            "millimetre" | "millimetres" | "millimeter" | "millimeters" => Some("mm"),
            "second" | "seconds" | "sec" => Some("s"),
            "newton" | "newtons" => Some("N"),
            "pascal" | "pascals" => Some("Pa"),
            "volt" | "volts" => Some("V"),
            "percent" => Some("%"),
            "degc" | "°c" | "c" | "celsius" => Some("°C"),
            "" | "-" | "none" => Some("1"),
            "samples" | "index" => Some("sample"),
            other => ALL.iter().find(|u| u.name.to_lowercase() == other).map(|u| u.name),
        }
    }

    fn suggestion(&self) -> String {
        self.meant().map_or(String::new(), |name| format!(" (did you mean {name:?}?)"))
    }
}

fn known() -> String {
    ALL.iter().map(|u| u.name).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn si(value: f64, name: &str) -> f64 {
        Unit::parse(name).map(|u| u.to_si(value)).unwrap_or(f64::NAN)
    }

    /// Oracle: the definitions of the units, as decimal literals.
    #[test]
    fn units_are_converted_to_the_nearest_float() {
        assert_eq!(si(105.0, "mm"), 0.105);
        for k in 0..20_000 {
            let metres: f64 = format!("{k}e-3").parse().unwrap_or(f64::NAN);
            assert_eq!(si(f64::from(k), "mm"), metres);
        }
        assert_eq!(si(2.5, "bar"), 250_000.0);
        assert_eq!(si(30.0, "l/min"), 0.0005);
        assert!((si(1.0, "psi") - 4.4482216152605 / 0.0254f64.powi(2)).abs() < 1e-9, "a pound-force on a square inch");
        assert_eq!(si(45.0, "g"), 0.045);
        assert_eq!(si(1.5, "min"), 90.0);
        assert_eq!(si(37.0, "%"), 0.37);
        assert_eq!(si(180.0, "deg"), PI);
        assert!((si(60.0, "rpm") - 2.0 * PI).abs() < 1e-15);
        assert_eq!(si(0.1 + 0.2, "m").to_bits(), (0.1f64 + 0.2).to_bits());
    }

    /// Oracle: SI Brochure, 9th ed., § 5.4.
    #[test]
    fn a_unit_may_be_written_in_the_usual_ways() {
        for (one, other) in [
            ("N m", "N*m"),
            ("N·m", "N*m"),
            ("Nm", "N*m"),
            ("kN·m", "kN*m"),
            ("m/s²", "m/s^2"),
            ("m/s2", "m/s^2"),
            ("m³/s", "m^3/s"),
            ("µm", "um"),
            ("°", "deg"),
            ("°/s", "deg/s"),
            ("degC", "°C"),
            ("L/min", "l/min"),
        ] {
            assert_eq!(Unit::parse(one), Unit::parse(other), "{one}");
            assert!(Unit::parse(one).is_ok(), "{one}");
        }
    }

    #[test]
    fn an_unknown_unit_lists_the_known_ones_and_guesses() {
        let message = Unit::parse("degrees").map(|_| String::new()).unwrap_or_else(|e| e.to_string());
        assert!(message.contains("\"degrees\" (did you mean \"deg\"?)"), "{message}");
        assert_eq!(Unit::parse("°C").map(|unit| (unit.si_name(), unit.to_si(21.5))), Ok(("°C", 21.5)));
        let celsius = Unit::parse("celsius").map(|_| String::new()).unwrap_or_else(|e| e.to_string());
        assert!(celsius.contains("did you mean \"°C\"?"), "{celsius}");
        assert!(message.contains("rad") && message.contains("kPa") && message.contains("sample"), "{message}");
        let message = Unit::parse("furlong").map(|_| String::new()).unwrap_or_else(|e| e.to_string());
        assert!(
            message.starts_with("unknown unit \"furlong\"; write \"1\" for a number in another unit; known units: 1 %"),
            "{message}"
        );
    }

    #[test]
    fn names_are_unique_and_every_dimension_has_its_si_unit() {
        for (i, unit) in ALL.iter().enumerate() {
            assert!(ALL[..i].iter().all(|other| other.name != unit.name), "{} twice", unit.name);
            assert_eq!(Unit::parse(unit.si_name()).map(|u| u.factor()), Ok(1.0), "{}", unit.name);
        }
    }
}
