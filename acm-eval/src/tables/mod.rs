//! Tables of a section: one file each, listed in [`ALL`], shown on the page, in the terminal and as CSV.

mod calibration;
mod cell;
mod csv;
mod data;
mod errors;
mod explained;
mod folds;
mod latex;
mod runs;
mod stages;
mod trials;

use std::ops::Range;

use crate::section::Section;

pub use cell::{Cell, Digits, fixed, grouped};

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

/// One row.
#[derive(Debug, Clone, Default)]
pub struct Row {
    /// One per column.
    pub cells: Vec<Cell>,
    /// First row of a group, set off by a line.
    pub opens: bool,
    /// Not an estimator but a bound, set in italics and never the best.
    pub bound: bool,
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

impl Table {
    /// Marks the smallest (or largest) mean of `column` among the estimators of `rows`, where there are two or more.
    pub fn mark_best(&mut self, column: usize, largest: bool, rows: Range<usize>) {
        let sign = if largest { -1.0 } else { 1.0 };
        let estimators = rows.filter(|&row| !self.rows[row].bound);
        let mut means: Vec<(f64, usize)> =
            estimators.filter_map(|row| Some((sign * self.rows[row].cells[column].mean()?, row))).collect();
        means.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let [(_, best), _, ..] = means[..]
            && let Cell::Number(spread) = self.rows[best].cells[column]
        {
            self.rows[best].cells[column] = Cell::Best(spread);
        }
    }
}

impl Table {
    /// Where the first column says the same in every row, it is said once, in the note.
    pub fn say_once(mut self) -> Self {
        let first = self.rows.first().map(|row| row.cells[0].clone());
        if let Some(Cell::Text(words)) = &first
            && self.rows.iter().all(|row| Some(&row.cells[0]) == first.as_ref())
        {
            self.note = format!("{} {}: {words}.", self.note, self.columns.remove(0).title);
            self.rows.iter_mut().for_each(|row| drop(row.cells.remove(0)));
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spread::Spread;

    #[test]
    fn what_every_row_says_is_said_once() {
        let row = |words: &str| Row { cells: vec![Cell::Text(words.into()), Cell::Count(1)], ..Row::default() };
        let columns = vec![Column::text("On"), Column::number("n", "", 0)];
        let table = |rows| {
            let columns = columns.clone();
            Table { name: "t", title: String::new(), note: "A.".into(), columns, rows, folded: false }
        };
        let once = table(vec![row("trial 1"), row("trial 1")]).say_once();
        assert_eq!((once.note.as_str(), once.columns.len(), once.rows[1].cells.len()), ("A. On: trial 1.", 1, 1));
        let each = table(vec![row("trial 1"), row("trial 2")]).say_once();
        assert_eq!((each.note.as_str(), each.columns.len(), each.rows[1].cells.len()), ("A.", 2, 2));
    }

    #[test]
    fn the_smallest_of_the_named_rows_is_best_and_a_lone_row_is_not() {
        let row = |x| {
            let number = Cell::Number(Spread { mean: x, sd: None });
            Row { cells: vec![Cell::Empty, number, Cell::Empty], ..Row::default() }
        };
        let rows = [1.0, 3.0, 2.0].map(row).to_vec();
        let mut marked =
            Table { name: "t", title: String::new(), note: String::new(), columns: vec![], rows, folded: false };
        marked.mark_best(1, false, 1..3);
        let best: Vec<bool> = marked.rows.iter().map(|row| matches!(row.cells[1], Cell::Best(_))).collect();
        assert_eq!(best, [false, false, true]);
        marked.mark_best(1, true, 0..1);
        assert!(!matches!(marked.rows[0].cells[1], Cell::Best(_)));
    }
}
