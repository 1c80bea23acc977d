//! Clocks that jump: a wrong stamp, or a clock that was set while it was read.

use std::path::Path;

use super::series::Series;
use crate::error::{DataError, More};

/// Longest plausible pause of a recording: in s, and in usual steps.
const PAUSE: (f64, f64) = (3600.0, 1000.0);

/// A log may lose at most one sample in this many to outlying stamps.
const FEW: usize = 10;

/// Stamps that are far from the others.
#[derive(Debug, PartialEq)]
pub struct Jump {
    /// Their indices.
    outlying: Vec<usize>,
    /// The first of them, s.
    at: f64,
    /// First and last of the others, s.
    others: (f64, f64),
}

/// Longest plausible pause, s: a longer one means that the clock was set.
pub fn longest_pause(step: f64) -> f64 {
    PAUSE.0.max(PAUSE.1 * step)
}

/// Indices of the samples whose time increases: of a log, the most that there can be.
///
/// # Errors
/// The clock jumps; of a log, more than a few samples are affected.
pub fn in_order(time: &[f64], log: bool) -> Result<Vec<usize>, Jump> {
    let mut order = if log { longest_increasing(time) } else { (0..time.len()).collect() };
    let stamps: Vec<f64> = order.iter().map(|i| time[*i]).collect();
    if let Some((from, to)) = usual(&stamps) {
        let far = |i: &usize| !(from..=to).contains(&time[*i]);
        let outlying: Vec<usize> = order.iter().copied().filter(far).collect();
        if !log || outlying.len() * FEW > time.len() {
            return Err(Jump { at: time[outlying[0]], outlying, others: (from, to) });
        }
        order.retain(|i| !far(i));
    }
    order.dedup_by(|b, a| !(time[*b] > time[*a]));
    Ok(order)
}

/// First and last stamp of the most that no long pause separates; `None` if that is all of them.
fn usual(time: &[f64]) -> Option<(f64, f64)> {
    let longest = longest_pause(Series { time: time.to_vec(), values: Vec::new() }.step());
    let far = |a: f64, b: f64| !((b - a).abs() <= longest);
    if !time.windows(2).any(|pair| far(pair[0], pair[1])) {
        return None;
    }
    let mut sorted = time.to_vec();
    sorted.sort_by(f64::total_cmp);
    let groups = sorted.chunk_by(|a, b| !far(*a, *b));
    let most = groups.reduce(|a, b| if b.len() > a.len() { b } else { a })?;
    (most.len() < time.len()).then_some((most[0], most[most.len() - 1]))
}

/// Indices of a longest subsequence that increases (Schensted 1961).
fn longest_increasing(time: &[f64]) -> Vec<usize> {
    // last element of the best subsequence of each length, and what stands before each element
    let (mut ends, mut before) = (Vec::<usize>::new(), vec![usize::MAX; time.len()]);
    for i in (0..time.len()).filter(|i| time[*i].is_finite()) {
        let length = ends.partition_point(|end| time[*end] < time[i]);
        before[i] = length.checked_sub(1).map_or(usize::MAX, |k| ends[k]);
        match ends.get_mut(length) {
            Some(end) => *end = i,
            None => ends.push(i),
        }
    }
    let mut order: Vec<usize> =
        std::iter::successors(ends.last().copied(), |i| Some(before[*i]).filter(|i| *i != usize::MAX)).collect();
    order.reverse();
    order
}

impl Jump {
    /// The jump as an error of a source's file.
    pub fn of(self, path: &Path, source: &str, first_row: usize) -> DataError {
        let mut more = More::default();
        self.outlying[1..].iter().for_each(|i| more.add(first_row + i));
        let (row, (from, to)) = (first_row + self.outlying[0], self.others);
        DataError::SourceJump { path: path.to_path_buf(), of: source.to_string(), row, at: self.at, from, to, more }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn a_stamp_far_from_the_others_is_named() {
        let steady: Vec<f64> = (0..100).map(|k| f64::from(k) * 0.1).collect();
        let with = |rows: &[usize], stamp: f64| {
            let mut time = steady.clone();
            rows.iter().for_each(|row| time[*row] = stamp);
            time
        };
        let outlying = |time: &[f64]| in_order(time, false).map_err(|jump| jump.outlying);
        for (row, stamp) in [(0, -1e4), (40, 1.764e9), (99, 1e4), (1, -4000.0)] {
            assert_eq!(outlying(&with(&[row], stamp)), Err(vec![row]), "{row}");
        }
        let set: Vec<f64> = steady.iter().map(|t| if *t < 3.0 { *t } else { t + 1e5 }).collect();
        assert_eq!(outlying(&set).map_err(|rows| rows.len()), Err(30));
        assert_eq!(outlying(&with(&[40], 3000.0)).map(|order| order.len()), Ok(41), "too near: it is out of order");
        let slow: Vec<f64> = (0..9).map(|k| 4000.0 * f64::from(k)).collect();
        assert_eq!(outlying(&slow), Ok((0..9).collect()), "its usual step");
        assert_eq!(outlying(&[]), Ok(Vec::new()));
    }

    /// Oracle: by hand.
    #[test]
    fn a_log_loses_its_wrong_stamps_and_no_others() {
        let mut time: Vec<f64> = (0..100).map(|k| f64::from(k) * 0.1).collect();
        time[0] = 1e6;
        time[40] = 3000.0;
        time[41] = 1e9;
        time[60] = 2.0;
        time[61] = f64::NAN;
        let kept: Vec<usize> = (0..100).filter(|i| ![0, 40, 41, 60, 61].contains(i)).collect();
        assert_eq!(in_order(&time, true), Ok(kept));
        let set: Vec<f64> = (0..100).map(|k| if k < 50 { f64::from(k) } else { 1e6 + f64::from(k) }).collect();
        assert!(in_order(&set, true).is_err(), "half of it is elsewhere");
    }
}
