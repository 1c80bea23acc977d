//! Windows: runs of consecutive samples that end at a target. Views by index; nothing is copied.
//!
//! ```text
//! targets of a segment:  start + reach − 1 + j · stride,   j = 0, 1, …      j counts samples whose output was measured
//! a window's samples:    end − length + 1 ..= end
//! ```
//!
//! `reach` is the longest window among the models that are compared: each is scored at the same targets, also one
//! that looks back less far or not at all. A window never crosses a gap or a trial.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::preprocessing::series::Series;

/// How windows are laid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct WindowSpec {
    /// Samples of a window, at least 1.
    pub length: usize,
    /// Samples before and at the first target of a segment, at least `length`.
    pub reach: usize,
    /// Samples from target to target, at least 1; counted from the start of each segment.
    pub stride: usize,
}

/// One window: the series and its last sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Window {
    /// Index of the series.
    pub series: usize,
    /// Index of the last sample, which is the target.
    pub end: usize,
}

impl Window {
    /// The samples of a window of `length`.
    pub fn rows(&self, length: usize) -> Range<usize> {
        self.end + 1 - length..self.end + 1
    }
}

/// All windows, by series and time.
///
/// # Panics
/// If `length` or `stride` is 0 or `reach < length`: experiment files are validated before.
pub fn windows(series: &[Series], spec: &WindowSpec) -> Vec<Window> {
    series.iter().enumerate().flat_map(|(index, one)| windows_of(index, one, spec)).collect()
}

/// The windows of a series, whose index is `index`, by time.
///
/// # Panics
/// As [`windows`].
pub fn windows_of<'s>(index: usize, series: &'s Series, spec: &WindowSpec) -> impl Iterator<Item = Window> + use<'s> {
    let WindowSpec { length, reach, stride } = *spec;
    assert!(length >= 1 && stride >= 1 && reach >= length, "{spec:?}");
    let reached = move |segment: &Range<usize>| segment.start + reach - 1..segment.end;
    let targets = move |segment| reached(segment).filter(move |end| series.is_measured(*end)).step_by(stride);
    series.segments.iter().flat_map(targets).map(move |end| Window { series: index, end })
}
