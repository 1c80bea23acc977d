//! Units, and dimensions as exponents: whatever is added or compared must have the same.
//!
//! ```text
//! unit = factor { (* | /) factor },   factor = name [ ^ whole number ],   value in SI = value · scale
//! ```
//!
//! Angles are numbers, as in SI. Beside m, kg, s, A and K, a definition may leave the unit of a signal open: then the signal
//! is a dimension of its own, which no other can be added to.

use std::fmt;

/// Exponents of m, kg, s, A, K, and of the two signals whose unit may be open, in sixtieths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Dimension([i32; 7]);

/// Parts of an exponent of one, so that roots have exponents too.
const PARTS: i32 = 60;

/// Names of the base units.
const BASE: [&str; 5] = ["m", "kg", "s", "A", "K"];

/// A unit that is read.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// What it measures.
    pub dimension: Dimension,
    /// What one of it is in SI.
    pub scale: f64,
    /// Its SI factors with their powers, in the order of the text.
    pub factors: Vec<(String, i32)>,
}

/// Name, SI name, scale, exponents of m, kg, s, A, K.
type Known = (&'static str, &'static str, f64, [i32; 5]);

const ONE: [i32; 5] = [0; 5];
const FORCE: [i32; 5] = [1, 1, -2, 0, 0];
const PRESSURE: [i32; 5] = [-1, 1, -2, 0, 0];
const VOLTAGE: [i32; 5] = [2, 1, -3, -1, 0];
const POWER: [i32; 5] = [2, 1, -3, 0, 0];
const VOLUME: [i32; 5] = [3, 0, 0, 0, 0];
const PI: f64 = std::f64::consts::PI;

const KNOWN: &[Known] = &[
    ("1", "1", 1.0, ONE),
    ("%", "1", 0.01, ONE),
    ("rad", "rad", 1.0, ONE),
    ("mrad", "rad", 1e-3, ONE),
    ("deg", "rad", PI / 180.0, ONE),
    ("turn", "rad", 2.0 * PI, ONE),
    ("rpm", "rad/s", PI / 30.0, [0, 0, -1, 0, 0]),
    ("m", "m", 1.0, [1, 0, 0, 0, 0]),
    ("cm", "m", 1e-2, [1, 0, 0, 0, 0]),
    ("mm", "m", 1e-3, [1, 0, 0, 0, 0]),
    ("um", "m", 1e-6, [1, 0, 0, 0, 0]),
    ("km", "m", 1e3, [1, 0, 0, 0, 0]),
    ("L", "m^3", 1e-3, VOLUME),
    ("mL", "m^3", 1e-6, VOLUME),
    ("s", "s", 1.0, [0, 0, 1, 0, 0]),
    ("ms", "s", 1e-3, [0, 0, 1, 0, 0]),
    ("us", "s", 1e-6, [0, 0, 1, 0, 0]),
    ("min", "s", 60.0, [0, 0, 1, 0, 0]),
    ("h", "s", 3600.0, [0, 0, 1, 0, 0]),
    ("Hz", "1/s", 1.0, [0, 0, -1, 0, 0]),
    ("kg", "kg", 1.0, [0, 1, 0, 0, 0]),
    ("g", "kg", 1e-3, [0, 1, 0, 0, 0]),
    ("N", "N", 1.0, FORCE),
    ("mN", "N", 1e-3, FORCE),
    ("kN", "N", 1e3, FORCE),
    ("Pa", "Pa", 1.0, PRESSURE),
    ("hPa", "Pa", 1e2, PRESSURE),
    ("kPa", "Pa", 1e3, PRESSURE),
    ("MPa", "Pa", 1e6, PRESSURE),
    ("mbar", "Pa", 1e2, PRESSURE),
    ("bar", "Pa", 1e5, PRESSURE),
    ("J", "J", 1.0, [2, 1, -2, 0, 0]),
    ("W", "W", 1.0, POWER),
    ("V", "V", 1.0, VOLTAGE),
    ("mV", "V", 1e-3, VOLTAGE),
    ("A", "A", 1.0, [0, 0, 0, 1, 0]),
    ("mA", "A", 1e-3, [0, 0, 0, 1, 0]),
    ("ohm", "ohm", 1.0, [2, 1, -3, -2, 0]),
    ("T", "T", 1.0, [0, 1, -2, -1, 0]),
    ("K", "K", 1.0, [0, 0, 0, 0, 1]),
    ("°C", "K", 1.0, [0, 0, 0, 0, 1]),
];

impl Dimension {
    /// Of a number.
    pub const ONE: Self = Self([0; 7]);

    /// Of a length.
    pub const LENGTH: Self = Self([PARTS, 0, 0, 0, 0, 0, 0]);

    /// Of a time.
    pub const TIME: Self = Self([0, 0, PARTS, 0, 0, 0, 0]);

    /// The dimension that a column whose unit is open has by itself.
    pub const COLUMN: Self = Self([0, 0, 0, 0, 0, PARTS, 0]);

    /// The same for the signal that carries the effect.
    pub const CARRIER: Self = Self([0, 0, 0, 0, 0, 0, PARTS]);

    /// Of a product.
    pub fn times(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }

    /// Of a quotient.
    pub fn over(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] - other.0[k]))
    }

    /// Of a power; none where it has no exponents in sixtieths.
    pub fn power(self, exponent: f64) -> Option<Self> {
        let mut powers = self.0;
        for power in &mut powers {
            let exact = f64::from(*power) * exponent;
            if !(exact - exact.round()).abs().lt(&1e-9) || exact.abs() > 1e6 {
                return None;
            }
            *power = exact.round() as i32;
        }
        Some(Self(powers))
    }

    /// Powers of the column and of the carrier whose units are open.
    pub fn open(self) -> [f64; 2] {
        [5, 6].map(|k| f64::from(self.0[k]) / f64::from(PARTS))
    }
}

impl fmt::Display for Dimension {
    /// Such as `Pa`, `m/s^2`, or `a number`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::ONE {
            return write!(f, "a number");
        }
        let named = |known: &&Known| of_base(known.3) == *self && known.2 == 1.0 && known.3 != ONE;
        if let Some((_, name, ..)) = KNOWN.iter().find(named) {
            return write!(f, "{name}");
        }
        let names = BASE.into_iter().chain(["(unit of the column)", "(unit of the carrier)"]);
        let parts: Vec<(String, i32)> = names.map(String::from).zip(self.0).filter(|(_, power)| *power != 0).collect();
        let whole = parts.iter().all(|(_, power)| power % PARTS == 0);
        if whole {
            let factors: Vec<(String, i32)> = parts.into_iter().map(|(name, power)| (name, power / PARTS)).collect();
            return write!(f, "{}", written(&factors));
        }
        let power = |(name, power): &(String, i32)| format!("{name}^{:.3}", f64::from(*power) / f64::from(PARTS));
        write!(f, "{}", parts.iter().map(power).collect::<Vec<_>>().join("*"))
    }
}

fn of_base(exponents: [i32; 5]) -> Dimension {
    let mut all = [0; 7];
    all.iter_mut().zip(exponents).for_each(|(all, exponent)| *all = exponent * PARTS);
    Dimension(all)
}

/// Factors as a unit: `m/s^2`, `N*s/(m*kg)`.
pub fn written(factors: &[(String, i32)]) -> String {
    let power = |name: &str, power: i32| if power == 1 { name.to_string() } else { format!("{name}^{power}") };
    let side = |sign: i32| -> Vec<String> {
        factors.iter().filter(|(_, p)| p * sign > 0).map(|(name, p)| power(name, p * sign)).collect()
    };
    let (above, below) = (side(1), side(-1));
    let above = if above.is_empty() { "1".to_string() } else { above.join("*") };
    match &below[..] {
        [] => above,
        [one] => format!("{above}/{one}"),
        several => format!("{above}/({})", several.join("*")),
    }
}

/// Reads a unit; `open` are names that stand for the units of signals.
///
/// # Errors
/// What is no unit, in words.
pub fn parse(text: &str, open: &[(&str, Dimension)]) -> Result<Unit, String> {
    let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    let spread = text.replace('·', "*").replace('²', "^2").replace('³', "^3");
    let mut reader = Reader { text: &spread, at: 0, open, depth: 0 };
    let unit = reader.product()?;
    if reader.rest().is_empty() { Ok(unit) } else { Err(format!("`{text}` is no unit from `{}` on", reader.rest())) }
}

/// Every unit that is known.
pub fn known() -> String {
    KNOWN.iter().map(|known| known.0).collect::<Vec<_>>().join(" ")
}

impl Unit {
    /// A number.
    pub fn one() -> Self {
        Self { dimension: Dimension::ONE, scale: 1.0, factors: vec![] }
    }

    /// The unit to the power of `power`, times `self`.
    pub fn times(mut self, other: &Unit, power: i32) -> Self {
        let raised = other.dimension.power(f64::from(power)).unwrap_or_default();
        self.dimension = self.dimension.times(raised);
        self.scale *= other.scale.powi(power);
        for (name, own) in &other.factors {
            match self.factors.iter_mut().find(|(known, _)| known == name) {
                Some((_, sum)) => *sum += own * power,
                None => self.factors.push((name.clone(), own * power)),
            }
        }
        self.factors.retain(|(_, power)| *power != 0);
        self
    }

    /// As SI writes it, where open units are `named`.
    pub fn si(&self, named: &[(&str, &str)]) -> String {
        let mut unit = Unit::one();
        for (name, power) in &self.factors {
            let text = named.iter().find(|(open, _)| open == name).map_or(name.as_str(), |(_, text)| text);
            let alone = Unit { factors: vec![(text.to_string(), 1)], ..Unit::one() };
            unit = unit.times(&parse(text, &[]).unwrap_or(alone), *power);
        }
        written(&unit.factors)
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    open: &'a [(&'a str, Dimension)],
    depth: usize,
}

impl Reader<'_> {
    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn product(&mut self) -> Result<Unit, String> {
        let mut unit = self.factor(1, Unit::one())?;
        while let Some(sign) = self.rest().chars().next().filter(|c| matches!(c, '*' | '/')) {
            self.at += 1;
            unit = self.factor(if sign == '*' { 1 } else { -1 }, unit)?;
        }
        Ok(unit)
    }

    fn factor(&mut self, sign: i32, before: Unit) -> Result<Unit, String> {
        let unit = if self.rest().starts_with('(') { self.bracket()? } else { self.name()? };
        let power = if self.rest().starts_with('^') { self.power()? } else { 1 };
        Ok(before.times(&unit, sign * power))
    }

    fn power(&mut self) -> Result<i32, String> {
        self.at += 1;
        let length = self.rest().find(|c: char| !(c.is_ascii_digit() || c == '-')).unwrap_or(self.rest().len());
        let text = &self.rest()[..length];
        let power = text.parse::<i32>().ok().filter(|power| (-12..=12).contains(power));
        let power = power.ok_or_else(|| format!("`{text}` is no power of a unit: powers are whole, −12 to 12"))?;
        self.at += length;
        Ok(power)
    }

    fn bracket(&mut self) -> Result<Unit, String> {
        self.depth += 1;
        if self.depth > 8 {
            return Err(format!("`{}` has too many brackets", self.text));
        }
        self.at += 1;
        let unit = self.product()?;
        if !self.rest().starts_with(')') {
            return Err(format!("`{}` lacks a `)`", self.text));
        }
        (self.at, self.depth) = (self.at + 1, self.depth - 1);
        Ok(unit)
    }

    fn name(&mut self) -> Result<Unit, String> {
        let length = self.rest().find(['*', '/', '^', '(', ')']).unwrap_or(self.rest().len());
        let name = self.rest()[..length].to_string();
        self.at += length;
        if let Some((_, dimension)) = self.open.iter().find(|(open, _)| *open == name) {
            return Ok(Unit { dimension: *dimension, scale: 1.0, factors: vec![(name, 1)] });
        }
        let Some((_, si, scale, exponents)) = KNOWN.iter().find(|known| known.0 == name) else {
            return Err(if name.is_empty() {
                "a unit is missing".into()
            } else {
                format!("`{name}` is no known unit")
            });
        };
        let factors = match *si {
            "1" => vec![],
            "rad/s" => vec![("rad".to_string(), 1), ("s".to_string(), -1)],
            "1/s" => vec![("s".to_string(), -1)],
            "m^3" => vec![("m".to_string(), 3)],
            si => vec![(si.to_string(), 1)],
        };
        Ok(Unit { dimension: of_base(*exponents), scale: *scale, factors })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn units_are_their_exponents_and_scales() {
        for (text, si, scale, dimension) in [
            ("mm/deg", "m/rad", 1e-3 * 180.0 / PI, "m"),
            ("kPa*s", "Pa*s", 1e3, "kg/(m*s)"),
            ("N·s²/m", "N*s^2/m", 1.0, "kg"),
            ("1/min", "1/s", 1.0 / 60.0, "Hz"),
            ("kg/(m*s^2)", "kg/(m*s^2)", 1.0, "Pa"),
            ("%", "1", 0.01, "a number"),
            ("mL/s", "m^3/s", 1e-6, "m^3/s"),
            ("rpm", "rad/s", PI / 30.0, "Hz"),
        ] {
            let unit = parse(text, &[]).unwrap();
            let shown = unit.dimension.to_string().replace("1/s", "Hz");
            assert_eq!((unit.si(&[]).as_str(), shown.as_str()), (si, dimension), "{text}");
            assert!((unit.scale / scale - 1.0).abs() < 1e-15, "{text}");
        }
        for text in ["", "furlong", "m^", "m^0.5", "(m", "m)", "m//s", "degC", "m^99", "*", "((((((((((m))))))))))"] {
            assert!(parse(text, &[]).is_err(), "{text}");
        }
    }

    /// Oracle: by hand: the unit of a signal stands where it was left open.
    #[test]
    fn open_units_are_named_later() {
        let open = [("q", Dimension::COLUMN), ("carrier", Dimension::CARRIER)];
        let unit = parse("q*s/carrier", &open).unwrap();
        assert_eq!(unit.dimension.open(), [1.0, -1.0]);
        assert_eq!(unit.si(&[("q", "N"), ("carrier", "m/s")]), "N*s^2/m");
        assert_eq!(parse("q/carrier", &open).unwrap().si(&[("q", "rad"), ("carrier", "rad")]), "1");
        assert!(parse("y", &open).is_err());
    }

    /// Oracle: by hand: the root of an area is a length, and no root of it has exponents in sixtieths.
    #[test]
    fn powers_of_dimensions() {
        let area = parse("m^2", &[]).unwrap().dimension;
        assert_eq!(area.power(0.5), Some(Dimension::LENGTH));
        assert_eq!(Dimension::LENGTH.power(0.301), None);
        assert_eq!(Dimension::ONE.power(0.301), Some(Dimension::ONE));
    }
}
