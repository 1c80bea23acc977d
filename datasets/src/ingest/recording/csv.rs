//! Text tables as laboratories write them.
//!
//! | in the file | recognised by | else |
//! | --- | --- | --- |
//! | gzip, UTF-16, byte-order mark | first bytes | UTF-8 |
//! | separator `,` `;` tab `\|` blanks | a first row `sep=;`, or the rows ([`layout`]) | refused: `separator = …` |
//! | lines before the header | the header is the first row with the wanted columns | the first row is the header |
//! | decimal comma | numbers such as `0,5` ([`decimal`]) | a point, or refused: `decimal = …` |
//! | row of units below the header | every cell is a unit or empty | none |
//! | missing values | `nan`, `#N/A`, `null`, `-`, … ([`missing`]) | |
//! | dates and times of day (ISO 8601) | first cell of the column of time ([`instant`]) | a number |
//!
//! Everything recognised is printed as a note. A row with fewer cells than the header, or with more that are not empty, is refused with its number.

pub(crate) mod decimal;
mod instant;
mod layout;
pub(crate) mod missing;
pub(crate) mod rows;
pub(crate) mod signs;
pub(crate) mod text;
mod units;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use self::decimal::Evidence;
use self::rows::{Rows, bare, width};
use super::cells::{Cells, Columns, Texts};
use super::{Wanted, header, visible};
use crate::error::{DataError, More, Problems};

/// A text table whose layout is known.
pub(crate) struct Csv {
    path: PathBuf,
    text: String,
    separator: char,
    /// Start of the header in the text, and its row.
    start: usize,
    header: usize,
    /// Names of the columns.
    pub names: Vec<String>,
    /// Units by column, if a row below the header says them.
    pub units: Option<BTreeMap<String, String>>,
    /// Recognised properties.
    pub notes: Vec<String>,
    decimal: Option<char>,
}

impl Csv {
    /// Recognises the layout of a table with these wanted columns.
    ///
    /// # Errors
    /// An empty file; text that cannot be decoded; several layouts that fit as well.
    pub fn new(path: &Path, bytes: Vec<u8>, wanted: &Wanted) -> Result<Self, DataError> {
        let mut notes = Vec::new();
        let text = text::decoded(path, bytes, &mut notes)?;
        if text.trim().is_empty() {
            return Err(DataError::EmptyFile { path: path.to_path_buf() });
        }
        let layout = layout::find(path, &text, wanted.separator, &wanted.columns())?;
        let start = memchr::memchr_iter(b'\n', text.as_bytes()).take(layout.before).last().map_or(0, |end| end + 1);
        let (names, units) = {
            let mut rows = Rows::new(path, &text[start..], layout.separator, layout.before + 1);
            rows.next()?;
            let names = layout::names(rows.record.iter());
            let has_next = rows.next().unwrap_or(false);
            let units = units::units(&names, &rows.record).filter(|_| has_next);
            (names, units)
        };
        notes.extend((layout.separator != ',').then(|| format!("cells are separated by {}", shown(layout.separator))));
        notes.extend((layout.before > 0).then(|| format!("the header is row {}", layout.before + 1)));
        notes.extend(units.is_some().then(|| "the row below the header has the units".to_string()));
        let (path, separator, header, decimal) =
            (path.to_path_buf(), layout.separator, layout.before + 1, wanted.decimal);
        Ok(Self { path, text, separator, start, header, names, units, notes, decimal })
    }

    /// Row of the first sample.
    pub fn first_row(&self) -> usize {
        self.header + 1 + usize::from(self.units.is_some())
    }

    /// The wanted columns. What is wrong with the header goes to `problems`, and the rest is read.
    ///
    /// # Errors
    /// Rows with too few or too many cells; no rows; a number or a time that can mean two things.
    pub fn read(&self, wanted: &Wanted, problems: &mut Vec<DataError>) -> Result<Columns, DataError> {
        let mut found = header::check(&self.path, &self.names, wanted);
        let present = header::present(&self.names, wanted);
        let texts = self.texts(&present, &mut found)?;
        let of_row =
            found.iter().any(|problem| matches!(problem, DataError::RaggedRow { .. } | DataError::NoRows { .. }));
        if present.is_empty() || of_row {
            Problems(std::mem::take(&mut found)).into_result()?;
        }
        problems.extend(found);
        self.interpreted(wanted, texts, problems)
    }

    /// The cells of some columns as they are written; rows of another length, or none, go to `problems`.
    fn texts(&self, columns: &[&str], problems: &mut Vec<DataError>) -> Result<Vec<(String, Texts)>, DataError> {
        let place = |name: &&str| self.names.iter().position(|column| column == name);
        let mut texts: Vec<(usize, Texts)> =
            columns.iter().filter_map(place).map(|at| (at, Texts::default())).collect();
        let mut rows = Rows::new(&self.path, &self.text[self.start..], self.separator, self.header);
        let mut ragged = Ragged { path: &self.path, names: &self.names, problems: Vec::new() };
        while rows.next()? {
            if rows.number < self.first_row() {
                continue;
            }
            let cells = &rows.record;
            texts.iter_mut().for_each(|(at, texts)| texts.push(bare(cells.get(*at).unwrap_or_default())));
            (rows.number - rows.blank..rows.number).for_each(|blank| ragged.check(blank, 0, 0));
            ragged.check(rows.number, cells.len(), width(cells));
        }
        problems.extend(ragged.problems.into_iter().map(|(_, problem)| problem));
        problems.extend((rows.number < self.first_row()).then(|| DataError::NoRows { path: self.path.clone() }));
        Ok(texts.into_iter().map(|(at, texts)| (self.names[at].clone(), texts)).collect())
    }

    /// Times become ticks; of the numbers it is decided how they are written.
    fn interpreted(
        &self,
        wanted: &Wanted,
        texts: Vec<(String, Texts)>,
        problems: &mut Vec<DataError>,
    ) -> Result<Columns, DataError> {
        let (mut cells, mut notes, mut evidence) = (BTreeMap::new(), Vec::new(), Evidence::default());
        let (rows, row) = (texts.first().map_or(0, |(_, texts)| texts.len()), |i: usize| self.first_row() + i);
        for (name, texts) in texts {
            let time = wanted.time.as_ref().filter(|time| time.column == name);
            let ticks = time.map_or(Ok(None), |_| instant::ticks((&self.path, &name), &texts, row, &mut notes))?;
            if let Some((kind, ticks)) = ticks {
                cells.insert(name, Cells::Ticks(kind, ticks));
                continue;
            }
            if time.is_some_and(|time| time.unit.is_none()) {
                problems.push(DataError::TimeWithoutUnit { path: self.path.clone(), column: name.clone() });
            }
            if wanted.numbers.contains_key(&name) {
                texts.iter().enumerate().for_each(|(i, cell)| evidence.see(row(i), &name, cell));
            }
            cells.insert(name, Cells::Text(texts));
        }
        let decimal = evidence.decide(&self.path, self.separator, self.decimal, &mut notes)?;
        Ok(Columns { rows, cells, decimal, notes })
    }
}

/// Rows with too few or too many cells, one problem for each number of cells.
struct Ragged<'a> {
    path: &'a Path,
    names: &'a [String],
    problems: Vec<(usize, DataError)>,
}

impl Ragged<'_> {
    /// Looks at a row of `found` cells, of which those behind the first `filled` are empty.
    fn check(&mut self, row: usize, found: usize, filled: usize) {
        let expected = self.names.len();
        if found == expected || (found > expected && filled <= expected) {
            return;
        }
        if let Some((_, first)) = self.problems.iter_mut().find(|(count, _)| *count == found) {
            return first.more().into_iter().for_each(|more| more.add(row));
        }
        let what = match self.names.get(found) {
            Some(first) => format!("none for column `{}`", visible(first)),
            None => format!("so cell {} has no column", expected + 1),
        };
        let (path, more) = (self.path.to_path_buf(), More::default());
        self.problems.push((found, DataError::RaggedRow { path, row, expected, found, what, more }));
    }
}

/// A separator by its name.
fn shown(separator: char) -> String {
    match separator {
        '\t' => "tabs".into(),
        rows::BLANKS => "blanks".into(),
        other => format!("{other:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names, first row and notes of a text.
    fn of(text: &str, wanted: &[&str]) -> (Vec<String>, usize, String) {
        let numbers = wanted.iter().map(|name| (name.to_string(), true)).collect();
        let wanted = Wanted { numbers, ..Wanted::default() };
        let csv = Csv::new(Path::new("a.csv"), text.into(), &wanted).expect("a layout");
        (csv.names.clone(), csv.first_row(), csv.notes.join("; "))
    }

    /// Oracle: by hand.
    #[test]
    fn the_layout_is_recognised_with_and_without_wanted_columns() {
        let names = ["t", "q", "y"].map(String::from).to_vec();
        for (text, first_row, note) in [
            ("t,q,y\n0,1,2\n", 2, ""),
            ("t;q;y\n0,5;1,5;2,5\n1,5;2,5;3,5\n", 2, "separated by ';'"),
            ("Recorder 2\nDate 2026-11-03\n\nt,q,y\n0,1,2\n1,2,3\n", 5, "header is row 4"),
            ("Operator,Ann\nRig,2\nt,q,y\n0,1,2\n1,2,3\n", 4, "header is row 3"),
            ("# t  q   y\n0  1   2\n1 2 3\n", 2, "blanks"),
            ("\"SEP=\t\"\nt\tq\ty\n[s]\t[rad]\t[mm]\n0\t1\t2\n", 4, "units"),
            ("t,q,y\n0,1,2,\n1,2,3,\n", 2, ""),
        ] {
            for wanted in [&["t", "q", "y"][..], &[]] {
                let found = of(text, wanted);
                assert_eq!((&found.0, found.1), (&names, first_row), "{text:?}");
                assert!(found.2.contains(note), "{text:?}: {}", found.2);
            }
        }
        assert_eq!(of("q \"\"1\"\",y\n1,2\n", &[]).0, ["q \"\"1\"\"", "y"]);
        assert_eq!(of("\"q \"\"1\"\"\",y\n1,2\n", &[]).0, ["q \"1\"", "y"]);
    }
}
