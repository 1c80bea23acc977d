//! One cell of a table, and the digits that it is shown with.

use acm_core::display::{fixed, with_spread};

use super::repeated::Repeated;
use crate::spread::Spread;

/// One cell.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A count.
    Count(usize),
    /// A number, or mean ± sd.
    Number(Spread),
    /// Mean ± sd over seeds or folds, and each of them.
    Repeated(Repeated),
    /// The best of its column, by more than what seeds or folds do.
    Best(Spread),
    /// Empty cell.
    Empty,
}

/// Number of digits that a number is shown with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Digits {
    /// Fixed number of decimals, in every row.
    Fixed(usize),
    /// Three significant digits, or as many as the standard deviation supports.
    Significant,
}

impl Cell {
    /// Returns a number without a spread.
    pub fn number(value: f64) -> Self {
        Self::Number(Spread { mean: value, sd: None })
    }

    /// Returns a cell for a spread that may be missing.
    pub fn of(spread: Option<Spread>) -> Self {
        spread.map_or(Self::Empty, Self::Number)
    }

    /// Returns the mean and spread, where there are any.
    pub fn spread(&self) -> Option<Spread> {
        match self {
            Self::Number(spread) | Self::Best(spread) => Some(*spread),
            Self::Repeated(repeated) => Some(repeated.spread()),
            _ => None,
        }
    }

    /// Returns the text on the page and in the terminal: a number times `factor`.
    pub fn show(&self, factor: f64, digits: Digits) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Count(count) => grouped(*count),
            _ => self
                .spread()
                .map_or("–".into(), |spread| show_spread(factor * spread.mean, spread.sd, factor, digits)),
        }
    }
}

fn show_spread(mean: f64, sd: Option<f64>, factor: f64, digits: Digits) -> String {
    let sd = sd.map(|sd| factor * sd);
    match (digits, sd) {
        (Digits::Significant, sd) => with_spread(mean, sd),
        (Digits::Fixed(decimals), None) => fixed(mean, decimals),
        (Digits::Fixed(decimals), Some(sd)) => format!("{} ± {}", fixed(mean, decimals), fixed(sd, decimals)),
    }
}

/// Returns a count with thin spaces between groups of three digits, from 10 000.
pub fn grouped(count: usize) -> String {
    let digits = count.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let first = digits.len() % 3;
    let mut groups: Vec<&str> = if first > 0 { vec![&digits[..first]] } else { vec![] };
    groups.extend((first..digits.len()).step_by(3).map(|start| &digits[start..start + 3]));
    groups.join("\u{202f}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_for_people() {
        let number = |mean: f64, sd| Cell::Number(Spread { mean, sd });
        assert_eq!(number(-1.236, Some(0.004)).show(1.0, Digits::Fixed(2)), "−1.24 ± 0.00");
        assert_eq!(number(-12.34567, Some(0.0123)).show(1.0, Digits::Significant), "−12.346 ± 0.012");
        assert_eq!(number(0.00123456, None).show(1e3, Digits::Significant), "1.23");
        assert_eq!(number(2.16e-4, Some(3.1e-5)).show(1e6, Digits::Significant), "216 ± 31");
        assert_eq!(Cell::Empty.show(1.0, Digits::Significant), "–");
        assert_eq!(grouped(9_999), "9999");
        assert_eq!(grouped(1_234_567), "1\u{202f}234\u{202f}567");
    }
}
