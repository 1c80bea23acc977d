//! Tables of a section: one file each, listed in [`ALL`], shown on the page, in the terminal and as CSV.

mod calibration;
mod data;
pub mod errors;
mod explained;
mod folds;
mod runs;
mod stages;
mod trials;

use std::ops::Range;

use crate::{section::Section, spread::Spread};

/// How to make a table; `None` where the records do not carry what it shows.
pub type Maker = fn(&Section) -> Option<Table>;

/// Every table, in the order of the page.
pub const ALL: &[Maker] = &[
    errors::table,
    explained::table,
    trials::table,
    folds::table,
    stages::table,
    calibration::table,
    runs::table,
    data::table,
];

/// Rows under named columns.
#[derive(Debug, Clone)]
pub struct Table {
    /// Name of the CSV file, and of the anchor on the page.
    pub name: &'static str,
    /// Heading on the page.
    pub title: String,
    /// What the numbers are and how to read them.
    pub note: String,
    /// Columns, the first of which names the row.
    pub columns: Vec<Column>,
    /// Rows, each with as many cells as there are columns.
    pub rows: Vec<Row>,
    /// Long tables are folded away on the page.
    pub folded: bool,
}

/// One column.
#[derive(Debug, Clone)]
pub struct Column {
    /// Heading.
    pub title: String,
    /// Unit symbol, empty for none.
    pub unit: String,
    /// Digits on the page; CSV has all digits.
    pub digits: Digits,
    /// Text columns are flush left.
    pub text: bool,
}

/// How many digits a number is shown with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Digits {
    /// So many after the point, in every row.
    Fixed(usize),
    /// As many as the standard deviation justifies (its second digit), or four in all where there is none.
    Justified,
}

/// One row.
#[derive(Debug, Clone, Default)]
pub struct Row {
    /// One per column.
    pub cells: Vec<Cell>,
    /// First row of a group, set off by a line.
    pub opens: bool,
    /// A network: the best of these is marked.
    pub network: bool,
    /// Not an estimator but a bound, set in italics.
    pub bound: bool,
}

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

impl Column {
    /// A column of words.
    pub fn text(title: impl Into<String>) -> Self {
        Self { title: title.into(), unit: String::new(), digits: Digits::Fixed(0), text: true }
    }

    /// A column of numbers with so many digits after the point.
    pub fn number(title: impl Into<String>, unit: impl Into<String>, decimals: usize) -> Self {
        Self { title: title.into(), unit: unit.into(), digits: Digits::Fixed(decimals), text: false }
    }

    /// Title with the unit in brackets.
    pub fn heading(&self) -> String {
        if self.unit.is_empty() { self.title.clone() } else { format!("{} [{}]", self.title, self.unit) }
    }
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

impl Table {
    /// Marks the smallest (or largest) mean of `column` among the networks of `rows`, where there are two or more.
    pub fn mark_best(&mut self, column: usize, largest: bool, rows: Range<usize>) {
        let sign = if largest { -1.0 } else { 1.0 };
        let networks = rows.filter(|&row| self.rows[row].network);
        let mut means: Vec<(f64, usize)> =
            networks.filter_map(|row| Some((sign * self.rows[row].cells[column].mean()?, row))).collect();
        means.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let [(_, best), _, ..] = means[..]
            && let Cell::Number(spread) = self.rows[best].cells[column]
        {
            self.rows[best].cells[column] = Cell::Best(spread);
        }
    }

    /// Comma-separated values with every digit; `mean ± sd` becomes two columns.
    pub fn csv(&self) -> String {
        let spread: Vec<bool> =
            (0..self.columns.len()).map(|c| self.rows.iter().any(|row| has_sd(&row.cells[c]))).collect();
        let mut lines = vec![self.csv_heading(&spread)];
        lines.extend(self.rows.iter().map(|row| csv_row(row, &spread)));
        lines.join("\n") + "\n"
    }

    fn csv_heading(&self, spread: &[bool]) -> String {
        let heading = |(column, &spread): (&Column, &bool)| match spread {
            true => vec![column.heading(), format!("sd of {}", column.heading())],
            false => vec![column.heading()],
        };
        let fields: Vec<String> = self.columns.iter().zip(spread).flat_map(heading).map(|name| quoted(&name)).collect();
        fields.join(",")
    }
}

fn csv_row(row: &Row, spread: &[bool]) -> String {
    let mut fields = Vec::new();
    for (cell, &spread) in row.cells.iter().zip(spread) {
        let (value, sd) = match cell {
            Cell::Text(text) => (quoted(text), None),
            Cell::Count(count) => (count.to_string(), None),
            Cell::Number(s) | Cell::Best(s) => (s.mean.to_string(), s.sd),
            Cell::Empty => (String::new(), None),
        };
        fields.push(value);
        if spread {
            fields.push(sd.map_or(String::new(), |sd| sd.to_string()));
        }
    }
    fields.join(",")
}

fn has_sd(cell: &Cell) -> bool {
    matches!(cell, Cell::Number(Spread { sd: Some(_), .. }) | Cell::Best(Spread { sd: Some(_), .. }))
}

fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_string(),
    }
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

    fn table(rows: Vec<Vec<Cell>>) -> Table {
        let columns = vec![Column::text("model"), Column::number("x", "mm", 2), Column::number("n", "", 0)];
        let rows = rows.into_iter().map(|cells| Row { cells, network: true, ..Row::default() }).collect();
        Table { name: "t", title: String::new(), note: String::new(), columns, rows, folded: false }
    }

    #[test]
    fn csv_has_all_digits_two_columns_for_a_spread_and_quotes_where_needed() {
        let rows = vec![
            vec![Cell::Text("a, \"b\"".into()), number(1.0 / 3.0, Some(0.5)), Cell::Count(12_345)],
            vec![Cell::Text("c".into()), number(2.0, None), Cell::Empty],
        ];
        let expected = "model,x [mm],sd of x [mm],n\n\"a, \"\"b\"\"\",0.3333333333333333,0.5,12345\nc,2,,\n";
        assert_eq!(table(rows).csv(), expected);
    }

    #[test]
    fn the_smallest_of_the_named_rows_is_best_and_a_lone_row_is_not() {
        let rows = vec![1.0, 3.0, 2.0].into_iter().map(|x| vec![Cell::Empty, number(x, None), Cell::Empty]).collect();
        let mut marked = table(rows);
        marked.mark_best(1, false, 1..3);
        let best: Vec<bool> = marked.rows.iter().map(|row| matches!(row.cells[1], Cell::Best(_))).collect();
        assert_eq!(best, [false, false, true]);
        marked.mark_best(1, true, 0..1);
        assert!(!matches!(marked.rows[0].cells[1], Cell::Best(_)));
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
