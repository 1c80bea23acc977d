//! Tables of a section: one file each, listed in [`ALL`], shown on the page, in the terminal and as CSV.

mod calibration;
mod cell;
mod csv;
mod data;
mod errors;
mod explained;
mod folds;
mod intervals;
mod latex;
mod repeated;
mod runs;
mod stages;
mod trials;

use std::ops::Range;

use acm_core::display::Display;

use crate::section::Section;

pub use acm_core::display::fixed;
pub use cell::{Cell, Digits, grouped};
pub(crate) use csv::quoted;
pub use repeated::Repeated;

/// Function that makes a table; `None` where the records do not have its data.
pub type Maker = fn(&Section) -> Option<Table>;

/// Every table, in the order of the page.
pub const ALL: &[Maker] = &[
    errors::table,
    explained::table,
    intervals::table,
    trials::table,
    folds::table,
    stages::table,
    calibration::table,
    runs::table,
    data::table,
];

/// Explanation of bold, for the notes below tables.
pub const BOLD: &str = "Bold: better than every other row, where the 95 % interval of the differences in pairs of runs \
                        excludes zero.";

/// Rows under named columns.
#[derive(Debug, Clone)]
pub struct Table {
    /// Name of the CSV file, and of the anchor on the page.
    pub name: &'static str,
    /// Heading on the page.
    pub title: String,
    /// Explanation of the numbers.
    pub note: String,
    /// Columns, the first of which names the row.
    pub columns: Vec<Column>,
    /// Rows, each with as many cells as there are columns.
    pub rows: Vec<Row>,
    /// Whether the table is collapsed on the page, as long tables are.
    pub folded: bool,
}

/// One column.
#[derive(Debug, Clone)]
pub struct Column {
    /// Heading.
    pub title: String,
    /// Unit of the cells, and how they are shown.
    pub display: Display,
    /// Digits on the page; CSV has all digits.
    pub digits: Digits,
    /// Text columns are flush left.
    pub text: bool,
}

/// One row.
#[derive(Debug, Clone, Default)]
pub struct Row {
    /// Cells, one per column.
    pub cells: Vec<Cell>,
    /// Whether it is the first row of a group, set off by a line.
    pub opens: bool,
    /// Whether it is not an estimator but a bound, set in italics and never the best.
    pub bound: bool,
}

impl Column {
    /// Returns a column of words.
    pub fn text(title: impl Into<String>) -> Self {
        Self { text: true, ..Self::number(title, "", 0) }
    }

    /// Returns a column of numbers that are shown as they are, with so many digits after the point.
    pub fn number(title: impl Into<String>, unit: &str, decimals: usize) -> Self {
        let display = Display { si: unit.into(), factor: 1.0, symbol: unit.into() };
        Self { title: title.into(), display, digits: Digits::Fixed(decimals), text: false }
    }

    /// Returns a column of measures: cells in SI units, shown as `display` says, with significant digits.
    pub fn measure(title: impl Into<String>, display: &Display) -> Self {
        Self { title: title.into(), display: display.clone(), digits: Digits::Significant, text: false }
    }

    /// Returns a column of plain numbers of any size, with significant digits.
    pub fn significant(title: impl Into<String>) -> Self {
        Self { digits: Digits::Significant, ..Self::number(title, "", 0) }
    }

    /// Returns the title with the unit in brackets.
    pub fn heading(&self) -> String {
        self.display.label(&self.title)
    }

    /// Returns a cell as shown.
    pub fn show(&self, cell: &Cell) -> String {
        cell.show(self.display.factor, self.digits)
    }
}

impl Table {
    /// Marks the smallest (or largest) mean of `column` among the estimators of `rows`, where the 95 % intervals of its
    /// differences to all others, in pairs of runs, exclude zero. One run each marks nothing.
    pub fn mark_best(&mut self, column: usize, largest: bool, rows: Range<usize>) {
        let sign = if largest { -1.0 } else { 1.0 };
        let repeated = |row: usize| match &self.rows[row].cells[column] {
            Cell::Repeated(repeated) if !self.rows[row].bound => Some((row, repeated)),
            _ => None,
        };
        let runs: Vec<(usize, &Repeated)> = rows.filter_map(repeated).collect();
        let mean = |of: &Repeated| sign * of.spread().mean;
        let best = runs.iter().min_by(|a, b| mean(a.1).total_cmp(&mean(b.1)));
        let Some(&(best, own)) = best.filter(|_| runs.len() > 1) else { return };
        if runs.iter().all(|(row, other)| *row == best || own.is_clear_of(other)) {
            self.rows[best].cells[column] = Cell::Best(own.spread());
        }
    }
}

impl Table {
    /// Moves a first column that is the same in every row to the note.
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
    fn the_smallest_is_best_where_every_pair_of_seeds_says_so() {
        let row = |values: &[f64]| {
            let runs = values.iter().enumerate().map(|(seed, value)| (seed.to_string(), *value)).collect();
            let cell = Repeated::of(runs).map_or(Cell::Empty, Cell::Repeated);
            Row { cells: vec![Cell::Empty, cell, Cell::Empty], ..Row::default() }
        };
        let best = |rows: &[&[f64]], within: Range<usize>, largest| {
            let rows = rows.iter().map(|values| row(values)).collect();
            let mut marked =
                Table { name: "t", title: String::new(), note: String::new(), columns: vec![], rows, folded: false };
            marked.mark_best(1, largest, within);
            marked.rows.iter().map(|row| matches!(row.cells[1], Cell::Best(_))).collect::<Vec<bool>>()
        };
        let (a, b, c): (&[f64], &[f64], &[f64]) = (&[1.0, 1.1, 0.9], &[3.0, 3.2, 2.9], &[2.0, 2.1, 1.9]);
        assert_eq!(best(&[a, b, c], 1..3, false), [false, false, true]);
        assert_eq!(best(&[a, b, c], 0..3, true), [false, true, false]);
        assert_eq!(best(&[a, b], 0..1, false), [false, false], "a lone row is not the best");
        assert_eq!(best(&[&[1.0], &[2.0]], 0..2, false), [false, false], "one seed decides nothing");
        assert_eq!(best(&[&[1.0, 2.0, 3.0], &[3.0, 2.0, 1.1]], 0..2, false), [false, false], "seeds disagree");
    }
}
