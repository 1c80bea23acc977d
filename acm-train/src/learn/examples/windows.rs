//! Windows of standardised series, converted from f64 to f32, batch by batch.
//!
//! | symbol    | meaning                                  | shape            | unit         |
//! | --------- | ---------------------------------------- | ---------------- | ------------ |
//! | `inputs`  | channels, standardised                   | `[B,W,C]`          | –            |
//! | `elapsed` | time since the previous sample             | `[B,W]`            | s            |
//! | `targets` | residual at the supervised steps,        | `[B,O]` last step, | –            |
//! |           | standardised                             | `[B,W,O]` every    |              |
//!
//! The scalers are applied once, to whole columns; a batch is then a copy of rows that lie side by side into buffers
//! that are used again. Nothing
//! outside this file holds single precision and knows where it came from.

use std::convert::Infallible;

use acm_datasets::{Means, Series, Standardizer, Window};
use acm_models::Keep;
use nalgebra::DMatrix;
use sha2::{Digest, Sha256};

use super::Examples;
use super::batch::Batch;
use super::single::by_rows;
use crate::learn::correction::{self, SlopeSums, Widths};
use crate::learn::straight::Straight;

/// Mean and spread of inputs and targets, from the training part.
#[derive(Debug, Clone, PartialEq)]
pub struct Scalers {
    /// Scaler of the channels.
    pub inputs: Standardizer,
    /// Scaler of the residual.
    pub targets: Standardizer,
    /// Scale `d` of each actuator that is corrected ([`correction`]); none where the tip alone is.
    pub actuators: Vec<f64>,
    /// Straight path beside the network, where there is one; the network then learns what it leaves.
    pub straight: Option<Straight>,
}

impl Scalers {
    /// Computes the scalers from the series of the training part alone.
    pub fn of(training: &[Series]) -> Self {
        let each = |see: &mut dyn FnMut(&Series)| {
            training.iter().for_each(see);
            Ok::<(), Infallible>(())
        };
        match Self::of_each(each) {
            Ok(scalers) => scalers,
            Err(never) => match never {},
        }
    }

    /// Computes the scalers as [`Scalers::of`] does, for series that `training` shows one after the other, each time it
    /// is called.
    ///
    /// # Errors
    /// What `training` says.
    pub fn of_each<E>(training: impl Fn(&mut dyn FnMut(&Series)) -> Result<(), E>) -> Result<Self, E> {
        let (mut inputs, mut targets) = (Means::default(), Means::default());
        training(&mut |series| {
            inputs.add(&series.inputs);
            targets.add(&series.targets());
        })?;
        let (mut inputs, mut targets, mut sloped) = (inputs.spreads(), targets.spreads(), false);
        training(&mut |series| {
            inputs.add(&series.inputs);
            targets.add(&series.targets());
            sloped |= series.slopes.ncols() > 0;
        })?;
        let (inputs, targets, mut slopes) = (inputs.standardizer(), targets.standardizer(), SlopeSums::default());
        if sloped {
            training(&mut |series| slopes.add(series, &targets))?;
        }
        Ok(Self { inputs, targets, actuators: slopes.scales(), straight: None })
    }

    /// Adds a straight path, where one predicts better than a constant ([`Straight::chosen`]).
    ///
    /// # Errors
    /// What `training` says.
    pub fn with_straight<E>(
        mut self,
        levels: &[bool],
        training: impl Fn(&mut dyn FnMut(&Series)) -> Result<(), E>,
    ) -> Result<Self, E> {
        self.straight = Straight::chosen(&self.inputs, levels, &training)?;
        let mut targets = Means::default();
        training(&mut |series| targets.add(&self.measured_target(series)))?;
        let mut targets = targets.spreads();
        training(&mut |series| targets.add(&self.measured_target(series)))?;
        self.targets = targets.standardizer();
        Ok(self)
    }

    /// Returns what the network learns of a series [T×O]: the residual, less the straight path.
    fn target(&self, series: &Series) -> DMatrix<f64> {
        match &self.straight {
            None => series.target.clone(),
            Some(straight) => &series.target - straight.along(&self.inputs, series),
        }
    }

    fn measured_target(&self, series: &Series) -> DMatrix<f64> {
        let rows: Vec<usize> = (0..series.time.len()).filter(|sample| series.is_measured(*sample)).collect();
        self.target(series).select_rows(&rows)
    }
}

/// The windows of a part, ready to be cut into batches.
#[derive(Debug, Clone)]
pub struct WindowSet {
    length: usize,
    scalers: Scalers,
    columns: Vec<Columns>,
    windows: Vec<Window>,
}

/// One series in single precision, row after row.
#[derive(Debug, Clone)]
pub(super) struct Columns {
    pub trial: String,
    pub inputs: Vec<f32>,
    pub elapsed: Vec<f32>,
    pub targets: Vec<f32>,
    /// Slopes [T×O×A]; empty where the tip alone is corrected.
    pub slopes: Vec<f32>,
    /// Samples without an output.
    unmeasured: Vec<usize>,
}

impl WindowSet {
    /// Returns the windows of `length` samples that `windows` point to in `series`.
    pub fn new(series: &[Series], windows: Vec<Window>, length: usize, scalers: &Scalers) -> Self {
        let mut set = Self::empty(length, scalers);
        series.iter().for_each(|one| set.push(one));
        set.lay(windows);
        set
    }

    /// Returns a set without series.
    pub fn empty(length: usize, scalers: &Scalers) -> Self {
        Self { length, scalers: scalers.clone(), columns: vec![], windows: vec![] }
    }

    /// Adds a series, whose samples become f32.
    pub fn push(&mut self, series: &Series) {
        self.columns.push(Columns::new(series, &self.scalers));
    }

    /// Sets the windows, which point to the series in the order in which they were added.
    pub fn lay(&mut self, windows: Vec<Window>) {
        self.windows = windows;
    }

    /// Returns the number of windows.
    pub fn len(&self) -> usize {
        self.windows.len()
    }

    /// Returns whether there is none.
    pub fn is_empty(&self) -> bool {
        self.windows.is_empty()
    }

    /// Returns the number of channels C.
    pub fn channels(&self) -> usize {
        self.scalers.inputs.mean.len()
    }

    /// Returns the number of outputs O.
    pub fn outputs(&self) -> usize {
        self.scalers.targets.mean.len()
    }

    /// Returns the numbers of outputs, and of actuators that are corrected.
    pub fn widths(&self) -> Widths {
        Widths { outputs: self.outputs(), actuators: self.scalers.actuators.len() }
    }

    /// Replaces the contents of `batch` by the windows `chosen`.
    pub fn gather(&self, chosen: &[usize], supervise: Keep, batch: &mut Batch) {
        let (channels, outputs) = (self.channels(), self.outputs());
        let supervised = if supervise == Keep::Every { self.length } else { 1 };
        let widths = self.widths();
        let sloped = outputs * widths.actuators;
        let Batch { inputs, elapsed, targets, slopes, .. } = batch;
        [&mut *inputs, &mut *elapsed, &mut *targets, &mut *slopes].into_iter().for_each(Vec::clear);
        for &index in chosen {
            let window = self.windows[index];
            let columns = &self.columns[window.series];
            let (rows, end) = (window.rows(self.length), window.end + 1);
            inputs.extend_from_slice(&columns.inputs[rows.start * channels..rows.end * channels]);
            elapsed.extend_from_slice(&columns.elapsed[rows]);
            targets.extend_from_slice(&columns.targets[(end - supervised) * outputs..end * outputs]);
            slopes.extend_from_slice(&columns.slopes[(end - supervised) * sloped..end * sloped]);
        }
        self.count(chosen, supervised, &mut batch.counted);
        (batch.steps, batch.supervise, batch.widths) = (self.length, supervise, widths);
    }

    /// Marks the targets that count: a window may hold samples without an output, but for its last.
    fn count(&self, chosen: &[usize], supervised: usize, counted: &mut Vec<bool>) {
        counted.clear();
        if self.columns.iter().all(|columns| columns.unmeasured.is_empty()) {
            return;
        }
        for window in chosen.iter().map(|&index| self.windows[index]) {
            let lost = &self.columns[window.series].unmeasured;
            for row in window.end + 1 - supervised..=window.end {
                counted.extend(std::iter::repeat_n(lost.binary_search(&row).is_err(), self.outputs()));
            }
        }
    }

    /// Returns the SHA-256 over all that a fit sees of these windows, in hexadecimal.
    pub fn fingerprint(&self) -> String {
        let mut hash = Sha256::new();
        hash.update((self.length as u64).to_le_bytes());
        self.columns.iter().for_each(|columns| columns.hash(&mut hash));
        for window in &self.windows {
            hash.update((window.series as u64).to_le_bytes());
            hash.update((window.end as u64).to_le_bytes());
        }
        acm_hashed::hexadecimal(&hash.finalize())
    }
}

impl Examples for WindowSet {
    fn len(&self) -> usize {
        self.len()
    }

    fn channels(&self) -> usize {
        self.channels()
    }

    fn outputs(&self) -> usize {
        self.outputs()
    }

    fn said(&self) -> usize {
        self.widths().said()
    }

    fn gather(&self, chosen: &[usize], supervise: Keep, batch: &mut Batch) {
        self.gather(chosen, supervise, batch);
    }

    fn residual(&self) -> Option<&Standardizer> {
        Some(&self.scalers.targets)
    }

    fn whose(&self, index: usize) -> String {
        format!("trial {}", self.columns[self.windows[index].series].trial)
    }

    fn fingerprint(&self) -> String {
        self.fingerprint()
    }
}

impl Columns {
    pub fn new(series: &Series, scalers: &Scalers) -> Self {
        Self {
            trial: series.trial.clone(),
            inputs: by_rows(&scalers.inputs.standardize(&series.inputs)),
            elapsed: series.elapsed.iter().map(|&seconds| seconds as f32).collect(),
            targets: by_rows(&scalers.targets.standardize(&scalers.target(series))),
            slopes: correction::standardised(series, &scalers.targets, &scalers.actuators),
            unmeasured: (0..series.time.len()).filter(|sample| !series.is_measured(*sample)).collect(),
        }
    }

    /// Adds all numbers to a hash.
    pub fn hash(&self, hash: &mut Sha256) {
        let hashed = [&self.inputs, &self.elapsed, &self.targets, &self.slopes];
        // Without slopes the hash is that of files from before there were any.
        for values in hashed.into_iter().take(if self.slopes.is_empty() { 3 } else { 4 }) {
            hash.update((values.len() as u64).to_le_bytes());
            values.iter().for_each(|value| hash.update(value.to_le_bytes()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. Sample 2 of 4 lacks its output, so that of a window over all the other three count; a window over whole samples
    /// has no mask.
    #[test]
    fn samples_without_an_output_do_not_count() {
        let numbers = |values: [f64; 4]| DMatrix::from_column_slice(4, 1, &values);
        let lost = numbers([0.0, 1.0, f64::NAN, 3.0]);
        let series = Series {
            trial: "a".into(),
            time: vec![0.0, 0.1, 0.2, 0.3],
            elapsed: vec![0.1; 4],
            inputs: numbers([1.0, 2.0, 3.0, 4.0]),
            target: lost.clone(),
            nominal: numbers([0.0; 4]),
            measured: lost,
            segments: vec![0..4],
            slopes: DMatrix::zeros(4, 0),
        };
        let scalers = Scalers::of(std::slice::from_ref(&series));
        assert!((scalers.targets.mean[0] - 4.0 / 3.0).abs() < 1e-15 && scalers.inputs.mean == [2.5]);
        let (whole, mut batch) = (Window { series: 0, end: 3 }, Batch::default());
        let set = WindowSet::new(std::slice::from_ref(&series), vec![whole], 4, &scalers);
        set.gather(&[0], Keep::Every, &mut batch);
        assert_eq!((batch.counted.as_slice(), batch.inputs.len()), ([true, true, false, true].as_slice(), 4));
        assert!(batch.error(&[0.0; 4]).0.is_finite());
        set.gather(&[0], Keep::Last, &mut batch);
        assert_eq!(batch.counted, [true]);
    }
}
