//! The regression problem: trials with the samples that are compared, and units of their inputs.

use acm_core::InterSample;
use acm_core::augmented::AugmentedModel;
use acm_core::polynomial::Polynomial;
use acm_core::response::Response;
use acm_core::rig::Rig;
use nalgebra::DMatrix;
use std::sync::Arc;

use super::blocks::Blocks;
use super::columns::Columns;
use crate::series::Series;

/// A prediction that is given.
///
/// Effects on the inputs change it through a polynomial g that approximates it: s(q̃) ≈ g(q̃) + (s(q) − g(q)).
#[derive(Debug, Clone, Copy)]
pub struct Base<'a> {
    /// Polynomial g.
    pub stands_for: &'a Polynomial,
    /// Strain model that g approximates; none where the prediction comes with the data.
    pub strain: Option<&'a Response>,
}

/// Trials, targets and caches that candidates are fitted to; see the head of this file.
#[derive(Debug, Clone)]
pub struct Problem<'a> {
    /// Signals of the rig.
    pub rig: &'a Rig,
    /// Trials; `offset` of each is s − g.
    pub series: Arc<[Series]>,
    /// Weight of each output.
    pub weight: &'a [f64],
    /// A prediction that is given.
    pub base: Option<Base<'a>>,
    /// Displacement per unit of each load at the samples of each trial; empty without a strain model.
    pub fields: Vec<Vec<f64>>,
    /// Difference s − g between the base and its polynomial at the samples of each trial, sample by sample.
    pub offset: Vec<Vec<f64>>,
    /// Samples of each trial that count, among those that are looked at.
    pub kept: Vec<Vec<usize>>,
    /// Targets: measured minus the fixed part of every prediction, weighted, kept × M.
    pub targets: Vec<DMatrix<f64>>,
    /// Rows are these samples, trial by trial.
    pub blocks: Blocks,
    /// Middle and half range of each actuator.
    pub range: Vec<(f64, f64)>,
    /// Share of each trial's mean that is taken out of columns and targets: [`super::offsets`].
    pub offset_share: f64,
    /// Columns that were computed before.
    pub columns: Columns,
}

impl<'a> Problem<'a> {
    /// Prepares the fit on the given trials.
    pub fn new(rig: &'a Rig, series: &[Series], weight: &'a [f64], base: Option<Base<'a>>) -> Self {
        let kept: Vec<Vec<usize>> =
            series.iter().map(|series| (0..series.samples()).filter(|&k| series.counts[k]).collect()).collect();
        let rows: Vec<usize> = kept.iter().map(Vec::len).collect();
        let range = rig.actuators.iter().map(|q| {
            let half = if q.varies() { 0.5 * q.span() } else { q.magnitude().max(1.0) };
            (0.5 * (q.low + q.high), half)
        });
        let offset: Vec<Vec<f64>> = series.iter().map(|series| series.offset.clone()).collect();
        let targets = targets(series, &kept, &offset, weight);
        let strain = base.and_then(|base| base.strain);
        let of = |series: &Series| strain.map_or(vec![], |f| f.fields_at(&series.record.actuators, &series.rows));
        let fields = series.iter().map(of).collect();
        Self {
            rig,
            series: series.into(),
            weight,
            base,
            fields,
            offset,
            blocks: Blocks::new(&rows),
            range: range.collect(),
            kept,
            targets,
            offset_share: 0.0,
            columns: Columns::default(),
        }
    }

    /// Returns the problem with random offsets of the trials.
    #[must_use]
    pub fn with_offsets(&self, share: f64) -> Self {
        Self { offset_share: share, ..self.clone() }
    }

    /// Returns the residual of a model in trial `s` at the samples that count, weighted, kept × M.
    pub fn residual_of(&self, model: &AugmentedModel, s: usize) -> DMatrix<f64> {
        let (series, kept) = (&self.series[s], &self.kept[s]);
        let predicted = model.predict_between(&series.record, series.predicted.as_ref());
        DMatrix::from_fn(kept.len(), self.outputs(), |k, o| {
            let measured = series.measured[kept[k] * self.outputs() + o];
            self.weight[o] * (measured - predicted[(series.rows[kept[k]], o)])
        })
    }

    /// Returns the inter-sample behaviour of actuators.
    pub fn inter_sample(&self) -> InterSample {
        self.series.first().map_or_else(InterSample::default, |series| series.inter_sample.clone())
    }

    /// Returns the number of outputs M.
    pub fn outputs(&self) -> usize {
        self.weight.len()
    }

    /// Returns the number of rows N.
    pub fn rows(&self) -> usize {
        self.kept.iter().map(Vec::len).sum()
    }

    /// Returns whether there are calibration trials.
    pub fn has_calibration(&self) -> bool {
        self.series.iter().any(|series| series.calibrates)
    }

    /// Returns the first row of each trial, and the end of the last.
    pub fn edges(&self) -> Vec<usize> {
        let mut edges = vec![0];
        self.kept.iter().for_each(|kept| edges.push(edges[edges.len() - 1] + kept.len()));
        edges
    }
}

/// Returns the weighted targets of each trial, kept × M.
pub(super) fn targets(
    series: &[Series],
    kept: &[Vec<usize>],
    offset: &[Vec<f64>],
    weight: &[f64],
) -> Vec<DMatrix<f64>> {
    let width = weight.len();
    let of = |((series, kept), offset): ((&Series, &Vec<usize>), &Vec<f64>)| {
        let beyond = |k: usize, o: usize| series.measured[k * width + o] - offset[k * width + o];
        DMatrix::from_fn(kept.len(), width, |k, o| weight[o] * beyond(kept[k], o))
    };
    series.iter().zip(kept).zip(offset).map(of).collect()
}
