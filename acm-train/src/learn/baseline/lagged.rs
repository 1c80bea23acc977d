//! Windows as input of a baseline: standardised, in double precision, indexed and not copied. Before the first sample of a
//! segment the channels are as at that sample.
//!
//! | symbol | meaning                                | shape | unit |
//! | ------ | -------------------------------------- | ----- | ---- |
//! | x_k    | channels at sample k, standardised     | [C]   | –    |
//! | y_k    | residual at sample k, standardised     | [O]   | –    |
//! | Δt_k   | elapsed time since the previous sample   |       | s    |

use std::ops::Range;

use acm_datasets::{Series, Window};
use nalgebra::DMatrix;

use crate::learn::examples::windows::Scalers;

/// The windows of a part.
#[derive(Debug)]
pub struct Lagged<'a> {
    parts: Vec<Columns<'a>>,
    windows: &'a [Window],
    length: usize,
    channels: usize,
    outputs: usize,
}

/// One series: a sample is a column of `inputs`, so that consecutive samples are one slice.
#[derive(Debug)]
struct Columns<'a> {
    inputs: DMatrix<f64>,
    targets: DMatrix<f64>,
    elapsed: &'a [f64],
    segments: &'a [Range<usize>],
}

impl<'a> Lagged<'a> {
    /// Returns the windows of `length` samples that `windows` point to in `series`.
    pub fn new(series: &'a [Series], windows: &'a [Window], length: usize, scalers: &Scalers) -> Self {
        let columns = |one: &'a Series| Columns {
            inputs: scalers.inputs.standardize(&one.inputs).transpose(),
            targets: scalers.targets.standardize(&one.target),
            elapsed: &one.elapsed,
            segments: &one.segments,
        };
        let (channels, outputs) = (scalers.inputs.mean.len(), scalers.targets.mean.len());
        Self { parts: series.iter().map(columns).collect(), windows, length, channels, outputs }
    }

    /// Returns the number of windows N.
    pub fn len(&self) -> usize {
        self.windows.len()
    }

    /// Returns whether there is no window.
    pub fn is_empty(&self) -> bool {
        self.windows.is_empty()
    }

    /// Returns the number of samples of a window.
    pub fn length(&self) -> usize {
        self.length
    }

    /// Returns the number of channels C.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Returns the number of outputs O.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Writes the last `lags` samples of a window, oldest first, channel by channel: [lags·C].
    pub fn past(&self, window: usize, lags: usize, out: &mut [f64]) {
        let (part, end) = self.at(window);
        for (lag, sample) in (0..lags).rev().zip(out.chunks_exact_mut(self.channels)) {
            sample.copy_from_slice(part.inputs.column(part.sample(end, lag)).as_slice());
        }
    }

    /// Returns a channel `lag` samples before the last one.
    pub fn input(&self, window: usize, lag: usize, channel: usize) -> f64 {
        let (part, end) = self.at(window);
        part.inputs[(channel, part.sample(end, lag))]
    }

    /// Returns the elapsed time from the sample `lag` samples back to the last one, s.
    pub fn age(&self, window: usize, lag: usize) -> f64 {
        let (part, end) = self.at(window);
        part.elapsed[part.sample(end, lag) + 1..=end].iter().sum()
    }

    fn at(&self, window: usize) -> (&Columns<'a>, usize) {
        let Window { series, end } = self.windows[window];
        (&self.parts[series], end)
    }

    /// Returns the targets of all windows: [N×O].
    pub fn targets(&self) -> DMatrix<f64> {
        let target = |row: usize, output: usize| {
            let Window { series, end } = self.windows[row];
            self.parts[series].targets[(end, output)]
        };
        DMatrix::from_fn(self.len(), self.outputs, target)
    }
}

impl Columns<'_> {
    /// Returns the sample `lag` samples before `end`, or the first of its segment.
    fn sample(&self, end: usize, lag: usize) -> usize {
        let segment = self.segments.partition_point(|segment| segment.end <= end);
        end.saturating_sub(lag).max(self.segments[segment].start)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use acm_datasets::{Standardizer, WindowSpec};

    /// Returns a trial at 10 Hz without gaps whose residual is `targets`.
    pub fn one_series(inputs: DMatrix<f64>, targets: DMatrix<f64>) -> Series {
        let time: Vec<f64> = (0..inputs.nrows()).map(|k| k as f64 / 10.0).collect();
        let zero = DMatrix::zeros(targets.nrows(), targets.ncols());
        let (elapsed, segments) = (vec![0.1; time.len()], vec![0..time.len()]);
        let (nominal, measured) = (zero, targets.clone());
        Series {
            trial: "a".into(),
            time,
            elapsed,
            inputs,
            target: targets,
            nominal,
            measured,
            segments,
            slopes: DMatrix::zeros(0, 0),
        }
    }

    /// Returns every window of `length`.
    pub fn windows(series: &[Series], length: usize) -> Vec<Window> {
        acm_datasets::windows(series, &WindowSpec { length, reach: length, stride: 1 })
    }

    /// Returns the scalers that change nothing.
    pub fn identity(channels: usize, outputs: usize) -> Scalers {
        let plain = |n: usize| Standardizer { mean: vec![0.0; n], spread: vec![1.0; n] };
        Scalers { inputs: plain(channels), targets: plain(outputs), actuators: vec![], straight: None }
    }

    /// Oracle: by hand. Sample k holds (10 k, 10 k + 1), standardised by mean 10 and spread 2.
    #[test]
    fn a_window_is_looked_up_backwards() {
        let inputs = DMatrix::from_fn(4, 2, |k, c| 10.0 * k as f64 + c as f64);
        let series = [one_series(inputs, DMatrix::from_fn(4, 1, |k, _| k as f64))];
        let scalers = Scalers { inputs: Standardizer { mean: vec![10.0; 2], spread: vec![2.0; 2] }, ..identity(2, 1) };
        let windows = windows(&series, 3);
        let lagged = Lagged::new(&series, &windows, 3, &scalers);
        assert_eq!((lagged.len(), lagged.channels(), lagged.outputs()), (2, 2, 1));
        let mut past = [0.0; 4];
        lagged.past(1, 2, &mut past);
        assert_eq!(past, [5.0, 5.5, 10.0, 10.5]);
        assert_eq!(lagged.input(1, 2, 1), 0.5);
        assert_eq!((lagged.age(1, 2), lagged.age(1, 0)), (0.2, 0.0));
        assert_eq!(lagged.targets().as_slice(), [2.0, 3.0]);
        let early = [Window { series: 0, end: 1 }];
        let lagged = Lagged::new(&series, &early, 3, &scalers);
        assert_eq!((lagged.input(0, 2, 0), lagged.age(0, 2)), (-5.0, 0.1));
    }
}
