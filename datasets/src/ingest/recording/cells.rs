//! Cells of the wanted columns of a file, before conversion to numbers.

use std::collections::BTreeMap;

use polars_core::prelude::Series;

use super::ticks::TickType;

/// The cells of a column; `None` is an empty one.
pub(super) enum Cells {
    /// As they are written, in CSV and in columns of text.
    Text(Series),
    /// Floats, and integers that they hold.
    Numbers(Vec<Option<f64>>),
    /// Integers of 64 bits, which may be names of trials too.
    Whole(Vec<Option<i128>>),
    /// Time of a type of its own.
    Ticks(TickType, Vec<Option<i64>>),
}

/// Columns of a file of text.
pub(super) struct Columns {
    pub rows: usize,
    pub cells: BTreeMap<String, Cells>,
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
            (Self::Text(cells), Self::Text(more)) => {
                let _ = cells.append(&more); // both are text
            }
            (Self::Numbers(cells), Self::Numbers(more)) => cells.extend(more),
            (Self::Whole(cells), Self::Whole(more)) => cells.extend(more),
            (Self::Ticks(_, cells), Self::Ticks(_, more)) => cells.extend(more),
            _ => {}
        }
    }
}
