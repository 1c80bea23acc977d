//! Samples of a trial: every signal of every source at the time stamps of the reference.

use std::collections::BTreeMap;

use super::plan::Plan;
use super::resample::{Onto, resample, slerp};
use super::series::Series;
use super::signals::Signals;
use crate::error::DataError;
use crate::ingest::layout::JOINED_TIME;
use crate::ingest::periodic::align_signs;
use crate::ingest::recording::Recording;
use crate::manifest::Source;
use crate::preprocessing::segments::GAP_STEPS;

impl Plan {
    /// The samples of a trial; none where its clocks could not be brought together.
    pub fn read(&self, trial: usize) -> Result<Option<Recording>, DataError> {
        let Some(alignments) = self.aligned.get(trial).and_then(Option::as_ref) else { return Ok(None) };
        let signals = self.read_signals(trial)?;
        let reference = &signals[self.reference];
        let Some((axis, _)) = reference.columns.get(&self.axis) else { return Ok(None) };
        let (time, first_row) = (reference.axes[*axis].time.clone(), reference.axes[*axis].first_row);
        let mut numbers = BTreeMap::new();
        for (i, source) in self.sources.iter().enumerate() {
            let times: Vec<f64> = time.iter().map(|t| alignments[i].source_time(*t)).collect();
            for four in &source.quaternions {
                numbers.extend(quaternion(source, &signals[i], four, &onto(source, &time, &times)));
            }
            for full in &self.signals[i] {
                let column = source.column(full).unwrap_or_default();
                let Some((own, values)) = signals[i].columns.get(column) else { continue };
                if i == self.reference && own == axis {
                    numbers.insert(full.clone(), values.clone());
                } else if !numbers.contains_key(full) {
                    let series = signals[i].series(column).unwrap_or_default();
                    numbers.insert(
                        full.clone(),
                        resample(&series, &with_gap(source, &series, onto(source, &time, &times))),
                    );
                }
            }
        }
        let (path, rows) = (self.folder.join(self.trial(trial).1), time.len());
        numbers.insert(JOINED_TIME.to_string(), time);
        Ok(Some(Recording { path, rows, first_row, numbers, ..Recording::default() }))
    }
}

/// The reference's samples, at these times of a source.
fn onto<'a>(source: &Source, reference: &[f64], times: &'a [f64]) -> Onto<'a> {
    let step = Series { time: reference.to_vec(), values: Vec::new() }.step();
    Onto { times, step, gap: 0.0, rule: source.resample }
}

/// The gap that the manifest declares, or [`GAP_STEPS`] of the series' steps.
fn with_gap<'a>(source: &Source, series: &Series, onto: Onto<'a>) -> Onto<'a> {
    let gap = source.gap.as_ref().map_or(GAP_STEPS * series.step(), crate::manifest::Quantity::si);
    Onto { gap, ..onto }
}

/// The four columns of a quaternion at the trial's samples, by their full names.
fn quaternion(source: &Source, signals: &Signals, four: &[String; 4], onto: &Onto) -> Vec<(String, Vec<f64>)> {
    let columns: Vec<&(usize, Vec<f64>)> = four.iter().filter_map(|column| signals.columns.get(column)).collect();
    let &[a, b, c, d] = columns.as_slice() else { return Vec::new() };
    let time = &signals.axes[a.0].time;
    let whole = |k: &usize| [a, b, c, d].iter().all(|column| column.1.get(*k).is_some_and(|value| value.is_finite()));
    let kept: Vec<usize> = (0..time.len()).filter(whole).collect();
    let series = [a, b, c, d].map(|column| Series {
        time: kept.iter().map(|k| time[*k]).collect(),
        values: kept.iter().map(|k| column.1[*k]).collect(),
    });
    let onto = with_gap(source, &series[0], Onto { ..*onto });
    let names = four.iter().map(|column| format!("{}.{column}", source.name));
    let mut turned = slerp(&series, &onto);
    align_signs(&mut turned);
    names.zip(turned).collect()
}
