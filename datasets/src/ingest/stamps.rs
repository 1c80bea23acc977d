//! Time stamps of one recording: they increase from row to row.
//!
//! | what | remedy |
//! | --- | --- |
//! | a whole number falls from the upper to the lower quarter of 2⁸, 2¹⁶ or 2³² | a counter starts again: unwrap it |
//! | a date without a zone falls by an hour, to a minute | the end of daylight saving time: write the zone |
//! | one stamp is beyond the two behind it, which continue the others | correct it, or delete the row |
//! | it falls otherwise | sort the file, or split the trial |
//! | it stays, with all values or without | delete one of the rows |

use std::mem::discriminant;
use std::path::Path;

use crate::error::{DataError, More};
use crate::ingest::recording::Ticks;

/// Ranges of counters.
pub(crate) const COUNTERS: [f64; 3] = [256.0, 65_536.0, 4_294_967_296.0];

/// A column of time stamps.
pub(crate) struct Stamps<'a> {
    pub path: &'a Path,
    pub column: &'a str,
    /// s; NaN where a stamp cannot be read.
    pub time: &'a [f64],
    /// Written form of the numbers, if they are numbers.
    pub raw: Option<&'a [f64]>,
    /// Dates and times of a type of their own.
    pub ticks: Option<&'a Ticks>,
    /// Row in the file, and index in `raw` and `ticks`, of a stamp.
    pub row: &'a dyn Fn(usize) -> usize,
    pub index: &'a dyn Fn(usize) -> usize,
    /// Whether two rows hold the same values.
    pub repeats: &'a dyn Fn(usize, usize) -> bool,
}

impl Stamps<'_> {
    /// The first violation of each kind, with the rows of the others.
    pub fn check(&self) -> Vec<DataError> {
        let mut found = Vec::<DataError>::new();
        let readable: Vec<usize> = (0..self.time.len()).filter(|i| self.time[*i].is_finite()).collect();
        for pair in readable.windows(2).filter(|pair| self.time[pair[1]] <= self.time[pair[0]]) {
            let problem = self.problem(pair[0], pair[1]);
            let alike = |other: &&mut DataError| discriminant(*other) == discriminant(&problem);
            match found.iter_mut().find(alike).and_then(DataError::more) {
                Some(more) => more.add((self.row)(pair[1])),
                None => found.push(problem),
            }
        }
        found
    }

    /// Whether it is a counter that starts again.
    pub fn starts_again(&self) -> bool {
        let starts =
            |i: usize| self.raw.and_then(|raw| rollover(raw[(self.index)(i - 1)], raw[(self.index)(i)])).is_some();
        (1..self.time.len()).any(starts)
    }

    fn problem(&self, first: usize, second: usize) -> DataError {
        let (before, after, row) = (self.time[first], self.time[second], (self.row)(second));
        let (path, column, more) = (self.path.to_path_buf(), self.column.to_string(), More::default());
        if after < before {
            let remedy = self.remedy(first, second);
            return DataError::TimeReversed { path, row, column, before, after, more, remedy };
        }
        match (self.repeats)(first, second) {
            true => DataError::DuplicateRow { path, row, column, first: (self.row)(first), at: after, more },
            false => DataError::TimeStill { path, row, column, at: after, more },
        }
    }

    /// Whether the stamp of `first` is wrong, after which time falls: two samples behind it continue those before it.
    fn is_alone(&self, first: usize, second: usize) -> bool {
        let before = self.time[..first].iter().rev().find(|time| time.is_finite());
        let next = self.time[second + 1..].iter().find(|time| time.is_finite());
        let continues = before.is_some_and(|before| *before < self.time[second]);
        continues && next.is_some_and(|next| (self.time[second]..self.time[first]).contains(next))
    }

    fn remedy(&self, first: usize, second: usize) -> String {
        let alone = self.is_alone(first, second).then(|| (self.row)(first));
        let (first, second) = ((self.index)(first), (self.index)(second));
        if let Some(range) = self.raw.and_then(|raw| rollover(raw[first], raw[second])) {
            let column = self.column;
            return format!(
                "the counter starts again at 0 after {} (2^{} - 1): unwrap it, write counters = {{ {column:?} = {range} }}",
                range - 1.0,
                range.log2()
            );
        }
        match (self.ticks.and_then(|ticks| ticks.set_back(first, second)), alone) {
            (Some(clock), _) => format!(
                "the clock was set back by one hour at {clock}, as at the end of daylight saving time: write times with \
                 their zone (+02:00, then +01:00), or in UTC"
            ),
            (None, Some(row)) => format!("correct the time of row {row}, which stands alone, or delete that row"),
            (None, None) => "sort the file or split the trial".into(),
        }
    }
}

/// Range of a counter that started again between two values.
fn rollover(before: f64, after: f64) -> Option<f64> {
    let whole = before.fract() == 0.0 && after.fract() == 0.0 && after >= 0.0;
    COUNTERS.into_iter().find(|range| whole && before < *range && before >= 0.75 * range && after < 0.25 * range)
}
