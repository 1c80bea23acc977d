//! Rows of numbers below a header: the wanted cells become columns, the others are skipped.
//!
//! Separators, decimal commas and spellings of missing values are those of any text table ([`crate::ingest::recording::csv`]). A last
//! row that is cut off is left out and reported; any other row with too few cells is refused, and so is one with more than the
//! header that are not empty.

use std::path::Path;

use super::{Column, Keep, check_size};
use crate::error::{DataError, More, Problems};
use crate::ingest::recording::csv::decimal::Evidence;
use crate::ingest::recording::csv::rows::{BLANKS, Rows, bare, width};
use crate::ingest::recording::{Missing, Texts, numbers_of, spelled};

/// Two leading cells (frame, and time or sub-frame) and the columns after them.
pub(super) struct Table {
    /// First cell of each row: the frame.
    pub frames: Vec<f64>,
    /// Second cell of each row: time or sub-frame; NaN where it is empty.
    pub seconds: Vec<f64>,
    pub columns: Vec<Column>,
    /// Row of the first sample.
    pub first_row: usize,
    /// Rows that were left out, a sentence each.
    pub lost: Vec<String>,
    /// Recognised properties.
    pub notes: Vec<String>,
}

/// Where the columns of a table stand.
pub(super) struct Layout {
    pub separator: char,
    /// Cells before the columns: frame, second cell, and what is skipped.
    pub lead: usize,
    pub columns: Vec<Column>,
    /// Stop at an empty line; else it is skipped.
    pub until_blank: bool,
}

/// A column that is kept: index of its cell, its name, and its cells.
struct Kept {
    cell: usize,
    name: String,
    texts: Texts,
}

/// The separator behind the first cell of the row of labels, which begins with `Frame`.
pub(super) fn separator(text: &str) -> char {
    let label = |line: &&str| line.starts_with("Frame");
    let line = text.lines().take(80).map(|line| line.trim_start_matches(['"', '\u{feff}'])).find(label);
    let behind = line.and_then(|line| line["Frame".len()..].trim_start_matches(['#', '"']).chars().next());
    behind.filter(|sign| [',', ';', '\t', '|', BLANKS].contains(sign)).unwrap_or(',')
}

/// The cells of the current row as names: without control characters.
pub(super) fn names(rows: &Rows) -> Vec<String> {
    let name = |cell: &str| bare(cell).chars().filter(|c| !c.is_control()).collect();
    rows.record.iter().map(name).collect()
}

/// The next row as names; `None` after the last.
pub(super) fn next_names(rows: &mut Rows) -> Result<Option<Vec<String>>, DataError> {
    Ok(rows.next()?.then(|| names(rows)))
}

/// The last cell that is not empty, and those before it.
pub(super) fn without_empty_end(mut cells: Vec<String>) -> Vec<String> {
    while cells.last().is_some_and(String::is_empty) {
        cells.pop();
    }
    cells
}

/// Reads the rows that follow.
pub(super) fn read(path: &Path, rows: &mut Rows, layout: Layout, keep: Keep) -> Result<Table, DataError> {
    let Layout { separator, lead, mut columns, until_blank } = layout;
    let expected = lead + columns.len();
    let asked = columns.iter().enumerate().filter(|(_, column)| keep.keeps(&column.name));
    let asked = asked.map(|(i, column)| (lead + i, column.name.clone()));
    let all = [(0, "Frame".to_string()), (1, "Time".to_string())].into_iter().chain(asked);
    let mut kept: Vec<Kept> = all.map(|(cell, name)| Kept { cell, name, texts: Texts::default() }).collect();
    let (mut numbers, mut lost, mut broken) = (Vec::new(), Vec::new(), None::<(usize, usize)>);
    while rows.next()? {
        let filled = width(&rows.record);
        if until_blank && !numbers.is_empty() && (rows.blank > 0 || filled == 0) {
            rows.held = filled > 0;
            break;
        }
        if filled == 0 {
            continue;
        }
        if let Some((row, found)) = broken {
            return Err(ragged(path, row, found, lead, &columns));
        }
        let found = rows.record.len();
        match found < expected {
            true => broken = Some((rows.number, found)),
            false if filled > expected => return Err(ragged(path, rows.number, found, lead, &columns)),
            false => {
                kept.iter_mut().for_each(|column| column.texts.push(bare(rows.record.get(column.cell).unwrap_or(""))));
                numbers.push(rows.number);
                check_size(path, numbers.len() * kept.len())?;
            }
        }
    }
    lost.extend(
        broken.map(|(row, found)| format!("row {row} is cut off after {found} of {expected} cells and left out")),
    );
    let (mut values, notes) = parsed(path, separator, &numbers, kept)?;
    let (first_row, rest) = (numbers.first().copied().unwrap_or(rows.number), values.split_off(2));
    for (cell, values) in rest {
        columns[cell - lead].values = values;
    }
    let [(_, frames), (_, seconds)] = <[_; 2]>::try_from(values).unwrap_or_default();
    Ok(Table { frames, seconds, columns, first_row, lost, notes })
}

/// A column by its cell, and its numbers.
type Values = (usize, Vec<f64>);

/// The numbers of each column, and what was recognised of how they are written.
fn parsed(
    path: &Path,
    separator: char,
    rows: &[usize],
    kept: Vec<Kept>,
) -> Result<(Vec<Values>, Vec<String>), DataError> {
    let (mut notes, mut evidence, mut missing, mut problems) =
        (Vec::new(), Evidence::default(), Missing::new(), Vec::new());
    for column in &kept {
        column.texts.iter().zip(rows).for_each(|(cell, row)| evidence.see(*row, &column.name, cell));
    }
    let decimal = evidence.decide(path, separator, None, &mut notes)?;
    let mut read = |Kept { cell, name, texts }: Kept| {
        (cell, numbers_of(path, &name, &|i| rows[i], texts, decimal, &mut missing, &mut problems))
    };
    let values = kept.into_iter().map(&mut read).collect();
    notes.extend(spelled(&missing));
    Problems(problems).into_result().map(|()| (values, notes))
}

fn ragged(path: &Path, row: usize, found: usize, lead: usize, columns: &[Column]) -> DataError {
    let (expected, more) = (lead + columns.len(), More::default());
    let what = match found < expected {
        true => format!("none for column `{}`", columns.get(found.saturating_sub(lead)).map_or("Frame", |c| &c.name)),
        false => format!("so cell {} has no column", expected + 1),
    };
    DataError::RaggedRow { path: path.to_path_buf(), row, expected, found, what, more }
}

/// Times of frames, s: those of frame ÷ rate where they agree with the column of times within its rounding.
///
/// ```text
/// t_k = (frame_k − frame_0)/rate + t_0,   |t_k − stamp_k| ≤ half a frame
/// ```
///
/// t_0 is frame_0 ÷ rate where that is the first stamp to the millisecond, and the first stamp elsewhere.
pub(super) fn from_frames(frames: &[f64], stamps: &[f64], rates: &[f64]) -> Option<(Vec<f64>, f64)> {
    let (first, start) = (*frames.first()?, *stamps.first()?);
    rates.iter().find_map(|rate| {
        let counted = (first / rate - start).abs() <= 1e-3;
        let at = |frame: &f64| if counted { frame / rate } else { (frame - first) / rate + start };
        let time: Vec<f64> = frames.iter().map(at).collect();
        let agree = time.iter().zip(stamps).all(|(time, stamp)| !((time - stamp).abs() > 0.5 / rate));
        (agree && *rate > 0.0).then_some((time, *rate))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand, at 120 Hz with times rounded to milliseconds.
    #[test]
    fn frames_give_the_times_that_a_rounded_column_has_lost() {
        let stamps = [0.008, 0.017, 0.025, 0.033];
        let (time, rate) = from_frames(&[1.0, 2.0, 3.0, 4.0], &stamps, &[60.0, 120.0]).unwrap_or_default();
        assert_eq!(rate, 120.0);
        assert!((time[3] - 4.0 / 120.0).abs() < 1e-15, "{time:?}");
        let (later, _) = from_frames(&[1.0, 2.0], &[7.5, 7.508], &[120.0]).unwrap_or_default();
        assert!((later[1] - (7.5 + 1.0 / 120.0)).abs() < 1e-15, "{later:?}");
        assert_eq!(from_frames(&[1.0, 2.0, 3.0, 4.0], &stamps, &[60.0]), None);
    }

    /// Oracle: by hand.
    #[test]
    fn the_row_of_labels_shows_the_separator() {
        for (text, sign) in
            [("a;b\nFrame;Time", ';'), ("\"Frame\",\"Time\"", ','), ("x\nFrame#  Time", ' '), ("Frame#\tTime", '\t')]
        {
            assert_eq!(separator(text), sign, "{text:?}");
        }
    }
}
