//! Cells of the wanted columns of a file, before conversion to numbers.

use std::collections::BTreeMap;

use super::csv::decimal::Decimal;
use super::ticks::TickType;

/// The cells of a column; `None` is an empty one.
pub(crate) enum Cells {
    /// As they are written, in CSV and in columns of text.
    Text(Texts),
    /// Floats, and integers that they hold.
    Numbers(Vec<Option<f64>>),
    /// Integers of 64 bits, which may be names of trials too.
    Whole(Vec<Option<i128>>),
    /// Time of a type of its own.
    Ticks(TickType, Vec<Option<i64>>),
}

/// Cells of text in one buffer; an empty cell is an empty text.
#[derive(Default)]
pub(crate) struct Texts {
    buffer: String,
    /// End of each cell in the buffer.
    ends: Vec<usize>,
}

/// Columns of a text table.
pub(crate) struct Columns {
    pub rows: usize,
    pub cells: BTreeMap<String, Cells>,
    /// How its numbers are written.
    pub decimal: Decimal,
    /// Recognised properties.
    pub notes: Vec<String>,
}

impl Texts {
    pub fn push(&mut self, cell: &str) {
        self.buffer.push_str(cell);
        self.ends.push(self.buffer.len());
    }

    pub fn len(&self) -> usize {
        self.ends.len()
    }

    pub fn iter(&self) -> impl Iterator<Item = &str> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, end)| &self.buffer[start..*end])
    }
}

impl Cells {
    pub fn len(&self) -> usize {
        match self {
            Self::Text(cells) => cells.len(),
            Self::Numbers(cells) => cells.len(),
            Self::Whole(cells) => cells.len(),
            Self::Ticks(_, cells) => cells.len(),
        }
    }

    /// These cells and those of the next group of rows; of one type, since a column has one.
    pub fn extend(&mut self, next: Cells) {
        match (self, next) {
            (Self::Text(cells), Self::Text(more)) => more.iter().for_each(|cell| cells.push(cell)),
            (Self::Numbers(cells), Self::Numbers(more)) => cells.extend(more),
            (Self::Whole(cells), Self::Whole(more)) => cells.extend(more),
            (Self::Ticks(_, cells), Self::Ticks(_, more)) => cells.extend(more),
            _ => {}
        }
    }
}
