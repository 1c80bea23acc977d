//! Rows of numbers below a header: wanted cells become columns, others are skipped.
//!
//! An empty cell is NaN. Of the cells of a column that are not numbers the first is reported, with the rows of the others. A
//! last row that is cut off is left out and reported; any other row with too few cells is refused.

use std::collections::BTreeMap;

use super::lines::Lines;
use super::{Column, Keep, check_size};
use crate::error::{DataError, More, Problems, shown};

/// Two leading cells (frame, and time or sub-frame) and the columns after them.
pub(super) struct Rows {
    /// First cell of each row: the frame.
    pub frames: Vec<f64>,
    /// Second cell of each row: time or sub-frame; NaN where it is empty.
    pub seconds: Vec<f64>,
    pub columns: Vec<Column>,
    /// Row of the first sample.
    pub first_row: usize,
    /// Rows that were left out, a sentence each.
    pub lost: Vec<String>,
}

/// Where the columns of a table stand.
pub(super) struct Layout {
    pub separator: u8,
    /// Cells before the columns: frame, second cell, and what is passed over.
    pub lead: usize,
    pub columns: Vec<Column>,
    /// Stop at an empty line; else it is passed over.
    pub until_blank: bool,
}

/// Which cell of a row is which column.
struct Plan {
    /// Index of the column, by cell; none is passed over.
    kept: Vec<Option<usize>>,
    cells: usize,
}

/// Reads the rows that follow.
pub(super) fn read(lines: &mut Lines, layout: Layout, keep: Keep) -> Result<Rows, DataError> {
    let Layout { separator, lead, columns, until_blank } = layout;
    let kept = columns.iter().enumerate().map(|(i, column)| keep.keeps(&column.name).then_some(i)).collect();
    let plan = Plan { kept, cells: lead + columns.len() };
    let (path, mut broken) = (lines.path.clone(), None::<(usize, usize)>);
    let mut rows = Rows { frames: vec![], seconds: vec![], columns, first_row: lines.row + 1, lost: vec![] };
    let mut problems = BTreeMap::<usize, DataError>::new();
    let width = 2 + plan.kept.iter().flatten().count();
    loop {
        let row = lines.row + 1;
        let Some(line) = lines.next()? else { break };
        if line.iter().all(|byte| *byte == separator || byte.is_ascii_whitespace()) {
            if until_blank && !rows.frames.is_empty() {
                break;
            }
            continue;
        }
        if let Some((row, found)) = broken {
            let what = format!(
                "none for column `{}`",
                rows.columns.get(found.saturating_sub(lead)).map_or("Frame", |c| &c.name)
            );
            let (expected, more) = (plan.cells, More::default());
            return Err(DataError::RaggedRow { path, row, expected, found, what, more });
        }
        if rows.frames.is_empty() {
            rows.first_row = row;
        }
        let found = one(line, separator, lead, row, &plan, &mut rows, &mut problems, &path);
        if found < plan.cells {
            broken = Some((row, found));
            take_back(&mut rows, &plan);
        }
        check_size(&path, rows.frames.len() * width)?;
    }
    if let Some((row, found)) = broken {
        rows.lost.push(format!("row {row} is cut off after {found} of {} cells and left out", plan.cells));
        problems.retain(|_, problem| !matches!(problem, DataError::NotANumber { row: at, .. } if *at == row));
    }
    Problems(problems.into_values().collect()).into_result()?;
    Ok(rows)
}

/// Removes what a row that is cut off has left.
fn take_back(rows: &mut Rows, plan: &Plan) {
    rows.frames.pop();
    rows.seconds.pop();
    let samples = rows.frames.len();
    plan.kept.iter().flatten().for_each(|i| rows.columns[*i].values.truncate(samples));
}

/// Takes one row apart; how many cells it has.
#[allow(clippy::too_many_arguments)]
fn one(
    line: &[u8],
    separator: u8,
    lead: usize,
    row: usize,
    plan: &Plan,
    rows: &mut Rows,
    problems: &mut BTreeMap<usize, DataError>,
    path: &std::path::Path,
) -> usize {
    let (mut start, mut found) = (0, 0);
    let mut refuse = |cell: &[u8], index: usize, column: &str| {
        let value = shown(&String::from_utf8_lossy(cell));
        let (path, column, what, remedy) = (path.to_path_buf(), column.to_string(), "", "correct the cell or empty it");
        if let Some(more) = problems.get_mut(&index).and_then(DataError::more) {
            more.add(row);
        } else {
            let more = More::default();
            problems.insert(index, DataError::NotANumber { path, row, column, value, what, remedy, more });
        }
        f64::NAN
    };
    let (mut frame, mut second) = (f64::NAN, f64::NAN);
    while start <= line.len() {
        let end = memchr::memchr(separator, &line[start..]).map_or(line.len(), |length| start + length);
        let cell = &line[start..end];
        match found {
            0 => frame = number(cell).unwrap_or_else(|| refuse(cell, 0, "Frame")),
            1 => second = number(cell).unwrap_or_else(|| refuse(cell, 1, "Time")),
            _ if found < lead => {}
            _ => {
                if let Some(i) = plan.kept.get(found - lead).copied().flatten() {
                    let value = number(cell).unwrap_or_else(|| refuse(cell, found, &rows.columns[i].name));
                    rows.columns[i].values.push(value);
                }
            }
        }
        found += 1;
        start = end + 1;
        if found == plan.cells {
            break;
        }
    }
    rows.frames.push(frame);
    rows.seconds.push(second);
    found
}

/// The number in a cell, NaN in an empty one; none where it is no finite number below 1e30.
fn number(cell: &[u8]) -> Option<f64> {
    let cell = cell.trim_ascii();
    if cell.is_empty() {
        return Some(f64::NAN);
    }
    fast_float2::parse::<f64, _>(cell).ok().filter(|value| value.abs() <= 1e30)
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
    fn an_empty_cell_is_no_number_and_no_problem() {
        assert_eq!(number(b" -1.5e-3 "), Some(-1.5e-3));
        assert!(number(b"").is_some_and(f64::is_nan));
        assert_eq!((number(b"1,5"), number(b"nan"), number(b"inf"), number(b"1e31")), (None, None, None, None));
    }
}
