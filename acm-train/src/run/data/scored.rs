//! A part of a split as a run uses it, with the windows that it is learned from or scored on: all its trials at once
//! where they are in memory, one after the other where they stay on the disk.

use std::borrow::Cow;

use acm_datasets::{DataError, Series, Window, windows_of};
use nalgebra::DMatrix;

use super::examples;
use super::prepare::Part;
use crate::learn::{Examples, Scalers};
use crate::run::evaluation::score::{ResidualSums, TrialPrediction};
use crate::run::record::CalibrationPair;
use crate::run::setting::Setting;

/// A part of a split.
pub struct Scored<'a> {
    setting: &'a Setting<'a>,
    pair: &'a CalibrationPair,
    names: &'a [String],
    /// Trials of the part, where they are in memory.
    held: Option<Part>,
    windows: Vec<Window>,
    /// Number of windows of each trial.
    counts: Vec<usize>,
    residuals: ResidualSums,
    /// First target of each output, as long as all are equal to it.
    constant: Vec<Option<f64>>,
}

impl<'a> Scored<'a> {
    /// Returns the trials called `names`, with the nominal model of `pair` and a window at every `stride`-th sample.
    ///
    /// Baselines look back into whole series, and inputs are shuffled over all trials of a part: such parts are held.
    ///
    /// # Errors
    /// A trial that cannot be read.
    pub fn new(
        setting: &'a Setting<'a>,
        pair: &'a CalibrationPair,
        names: &'a [String],
        stride: usize,
    ) -> Result<Self, DataError> {
        let experiment = setting.experiment;
        let residuals = ResidualSums::new(setting.data.manifest.tip_columns().len());
        let (windows, counts, constant) = (vec![], vec![], vec![]);
        let mut scored = Self { setting, pair, names, held: None, windows, counts, residuals, constant };
        if setting.data.is_held() || experiment.baseline.is_some() || !experiment.inputs.shuffled.is_empty() {
            let mut part = Part::default();
            for trial in setting.data.trials(names) {
                scored.add(&mut part, &*trial?);
            }
            part.shuffle(setting.channels, experiment);
            scored.held = Some(part);
        }
        scored.lay(stride)?;
        Ok(scored)
    }

    fn add(&self, part: &mut Part, trial: &acm_datasets::Trial) {
        let Setting { experiment, data, channels, .. } = self.setting;
        part.push(trial, data.manifest.tip_columns(), self.pair, channels, experiment);
    }

    /// Finds the windows, and sums the residual at their ends.
    fn lay(&mut self, stride: usize) -> Result<(), DataError> {
        let spec = self.setting.experiment.targets(stride);
        let (mut windows, mut counts, mut residuals) = (vec![], vec![], self.residuals.clone());
        let mut constant: Option<Vec<Option<f64>>> = None;
        self.each(&mut |series| {
            let first = windows.len();
            windows.extend(windows_of(counts.len(), series, &spec));
            residuals.add(&series.target.select_rows(windows[first..].iter().map(|window| &window.end)));
            counts.push(windows.len() - first);
            let targets = series.targets();
            if let Some(samples) = (targets.nrows() > 0).then_some(&*targets) {
                let seen = constant.get_or_insert_with(|| samples.row(0).iter().map(|first| Some(*first)).collect());
                for (seen, column) in seen.iter_mut().zip(samples.column_iter()) {
                    *seen = seen.filter(|first| column.iter().all(|value| value == first));
                }
            }
        })?;
        self.constant = constant.unwrap_or_default();
        (self.windows, self.counts, self.residuals) = (windows, counts, residuals);
        Ok(())
    }

    /// Returns the windows by trial and time.
    pub fn windows(&self) -> &[Window] {
        &self.windows
    }

    /// Returns the residual at the windows' ends.
    pub fn residuals(&self) -> &ResidualSums {
        &self.residuals
    }

    /// Returns the targets, where no output ever changes.
    pub fn constant_target(&self) -> Option<Vec<f64>> {
        self.constant.iter().copied().collect::<Option<Vec<f64>>>().filter(|values| !values.is_empty())
    }

    /// Returns the rows of `of` [T×O] at the targets of each series, in the order of series and time.
    ///
    /// # Errors
    /// A trial that cannot be read.
    pub fn at_targets(&self, of: impl Fn(&Series) -> DMatrix<f64>) -> Result<DMatrix<f64>, DataError> {
        let (mut rows, mut windows, mut counts) = (vec![], self.windows.iter(), self.counts.iter());
        self.each(&mut |series| {
            let (values, count) = (of(series), counts.next().copied().unwrap_or(0));
            rows.extend(windows.by_ref().take(count).map(|window| values.row(window.end).into_owned()));
        })?;
        Ok(DMatrix::from_rows(&rows))
    }

    /// Returns all series, where they are in memory.
    pub fn held(&self) -> &[Series] {
        self.held.as_ref().map_or(&[], |part| &part.series)
    }

    /// Calls `see` with every series, in natural order of their names.
    ///
    /// # Errors
    /// A trial that cannot be read.
    pub fn each(&self, see: &mut dyn FnMut(&Series)) -> Result<(), DataError> {
        self.pieces().try_for_each(|piece| {
            piece?.series.iter().for_each(&mut *see);
            Ok(())
        })
    }

    /// Returns the examples that a network learns from.
    ///
    /// # Errors
    /// A trial that cannot be read.
    pub fn training_examples(&self, scalers: &Scalers) -> Result<Box<dyn Examples>, DataError> {
        examples::training(self.setting.experiment, scalers, |see| self.each(see))
    }

    /// Returns the examples that a network predicts.
    ///
    /// # Errors
    /// A trial that cannot be read.
    pub fn scored_examples(&self, scalers: &Scalers) -> Result<Box<dyn Examples>, DataError> {
        examples::scored(self.setting.experiment, scalers, |see| self.each(see))
    }

    /// Returns all estimates at the windows' ends, trial by trial, where the model adds `residual` [N×O]; trials
    /// without windows have none.
    pub fn predictions(&self, residual: DMatrix<f64>) -> impl Iterator<Item = Result<TrialPrediction, DataError>> {
        let (mut row, mut counts) = (0, self.counts.iter());
        let all = self.pieces().flat_map(move |piece| match piece {
            Ok(piece) => {
                let of_trial = |(index, &count): (usize, &usize)| {
                    let ends: Vec<usize> = self.windows[row..row + count].iter().map(|window| window.end).collect();
                    let added = residual.rows(row, count).into_owned();
                    row += count;
                    Ok(at(&piece, index, &ends, added))
                };
                (0..piece.series.len()).zip(&mut counts).map(of_trial).collect()
            }
            Err(error) => vec![Err(error)],
        });
        all.filter(|trial| trial.as_ref().map_or(true, |trial| !trial.time.is_empty()))
    }

    /// Returns the part in pieces.
    fn pieces(&self) -> impl Iterator<Item = Result<Cow<'_, Part>, DataError>> {
        let streamed = if self.held.is_some() { &[][..] } else { self.names };
        let one = |trial: Cow<acm_datasets::Trial>| {
            let mut part = Part::default();
            self.add(&mut part, &trial);
            Cow::Owned(part)
        };
        let streamed = self.setting.data.trials(streamed).map(move |trial| trial.map(one));
        self.held.iter().map(|part| Ok(Cow::Borrowed(part))).chain(streamed)
    }
}

/// Returns the estimates of one trial at the samples `ends`.
fn at(part: &Part, index: usize, ends: &[usize], residual: DMatrix<f64>) -> TrialPrediction {
    let series = &part.series[index];
    let nominal = series.nominal.select_rows(ends);
    TrialPrediction {
        trial: series.trial.clone(),
        time: ends.iter().map(|&end| series.time[end]).collect(),
        measured: series.measured.select_rows(ends),
        polynomial: part.polynomial[index].select_rows(ends),
        predicted: &nominal + residual,
        nominal,
    }
}
