//! One cell of a table, and numbers as people read them.

use crate::spread::Spread;

/// One cell.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A count.
    Count(usize),
    /// A number, or mean ± sd over seeds or folds.
    Number(Spread),
    /// The best of its column.
    Best(Spread),
    /// Nothing to say.
    Empty,
}

/// How many digits a number is shown with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Digits {
    /// So many after the point, in every row.
    Fixed(usize),
    /// As many as the standard deviation justifies (its second digit), or four in all where there is none.
    Justified,
}

impl Cell {
    /// A cell for a spread that may be missing.
    pub fn of(spread: Option<Spread>) -> Self {
        spread.map_or(Self::Empty, Self::Number)
    }

    /// The mean, where there is one.
    pub fn mean(&self) -> Option<f64> {
        match self {
            Self::Number(spread) | Self::Best(spread) => Some(spread.mean),
            _ => None,
        }
    }

    /// As shown on the page and in the terminal.
    pub fn show(&self, digits: Digits) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Count(count) => grouped(*count),
            Self::Empty => "–".into(),
            Self::Number(spread) | Self::Best(spread) => show_spread(spread, digits),
        }
    }
}

fn show_spread(spread: &Spread, digits: Digits) -> String {
    let decimals = match digits {
        Digits::Fixed(decimals) => decimals,
        Digits::Justified => match spread.sd.filter(|sd| *sd > 0.0) {
            Some(sd) => decimals_for(sd, 2),
            None => decimals_for(spread.mean, 4),
        },
    };
    match spread.sd {
        None => fixed(spread.mean, decimals),
        Some(sd) => format!("{} ± {}", fixed(spread.mean, decimals), fixed(sd, decimals)),
    }
}

/// Decimals that show `digits` significant digits of `value`.
fn decimals_for(value: f64, digits: i32) -> usize {
    let exponent = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    (digits - 1 - exponent as i32).clamp(0, 12) as usize
}

/// A number with a true minus sign, and without a sign at zero.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| matches!(c, '0' | '.')) => digits.to_string(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

/// A count with thin spaces between groups of three digits, from 10 000.
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

    fn number(mean: f64, sd: Option<f64>) -> Cell {
        Cell::Number(Spread { mean, sd })
    }

    #[test]
    fn numbers_are_written_for_people() {
        assert_eq!(number(-1.236, Some(0.004)).show(Digits::Fixed(2)), "−1.24 ± 0.00");
        assert_eq!(number(-12.34567, Some(0.0123)).show(Digits::Justified), "−12.346 ± 0.012");
        assert_eq!(number(0.00123456, None).show(Digits::Justified), "0.001235");
        assert_eq!(number(0.0, Some(0.0)).show(Digits::Justified), "0.000 ± 0.000");
        assert_eq!(fixed(-0.0001, 2), "0.00");
        assert_eq!(grouped(9_999), "9999");
        assert_eq!(grouped(1_234_567), "1\u{202f}234\u{202f}567");
    }
}
