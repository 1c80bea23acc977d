//! The regression problem: trials with the samples that are compared, and units of their inputs.

use acm_core::augmented::AugmentedModel;
use acm_core::polynomial::Polynomial;
use acm_core::response::Response;
use acm_core::rig::Rig;
use nalgebra::DMatrix;

use super::blocks::Blocks;
use super::columns::Columns;
use super::design::inputs;
use super::state::{Part, State};
use crate::series::Series;

/// A prediction that is given.
///
/// Effects on the inputs move it through a polynomial g that stands for it: s(q̃) ≈ g(q̃) + (s(q) − g(q)).
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
    pub series: &'a [Series],
    /// Weight of each output.
    pub weight: &'a [f64],
    /// A prediction that is given.
    pub base: Option<Base<'a>>,
    /// Displacement per unit of each load at the samples of each trial; empty without a strain model.
    pub fields: Vec<Vec<f64>>,
    /// What the base is beyond the polynomial that stands for it, s − g, at the samples of each trial, sample by sample.
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
    pub fn new(rig: &'a Rig, series: &'a [Series], weight: &'a [f64], base: Option<Base<'a>>) -> Self {
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
            series,
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

    /// Returns the problem about the inputs that the effects of a state leave: there loads bend the arm, and there the polynomial that stands
    /// for the strain model is made exact. None without a strain model, or where no effect acts on the inputs.
    pub fn about(&self, state: &State) -> Option<Self> {
        let Base { stands_for, strain: Some(strain) } = self.base? else { return None };
        let acts = state.clock != 0.0 || state.effects.iter().any(|placed| placed.part() == Part::Input);
        acts.then(|| {
            let (mut fields, mut offset) = (vec![], vec![]);
            for (s, series) in self.series.iter().enumerate() {
                let q = inputs(self, state, s);
                let at_rows = DMatrix::from_fn(series.samples(), q.len(), |k, a| q[a][series.rows[k]]);
                let (given, standing) = (strain.outputs_at(&q, &series.rows), stands_for.predict(&at_rows).transpose());
                offset.push(given.iter().zip(standing.iter()).map(|(s, g)| s - g).collect());
                fields.push(strain.fields_at(&q, &series.rows));
            }
            let targets = targets(self.series, &self.kept, &offset, self.weight);
            Self { fields, offset, targets, columns: Columns::default(), ..self.clone() }
        })
    }

    /// Returns what a model leaves of trial `s` at the samples that count, weighted, kept × M.
    pub fn residual_of(&self, model: &AugmentedModel, s: usize) -> DMatrix<f64> {
        let (series, kept) = (&self.series[s], &self.kept[s]);
        let predicted = model.predict(&series.record, series.predicted.as_ref());
        DMatrix::from_fn(kept.len(), self.outputs(), |k, o| {
            let measured = series.measured[kept[k] * self.outputs() + o];
            self.weight[o] * (measured - predicted[(series.rows[kept[k]], o)])
        })
    }

    /// Returns the number of outputs M.
    pub fn outputs(&self) -> usize {
        self.weight.len()
    }

    /// Returns the number of rows N.
    pub fn rows(&self) -> usize {
        self.kept.iter().map(Vec::len).sum()
    }

    /// Returns whether any of the trials only calibrates.
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
fn targets(series: &[Series], kept: &[Vec<usize>], offset: &[Vec<f64>], weight: &[f64]) -> Vec<DMatrix<f64>> {
    let width = weight.len();
    let of = |((series, kept), offset): ((&Series, &Vec<usize>), &Vec<f64>)| {
        let beyond = |k: usize, o: usize| series.measured[k * width + o] - offset[k * width + o];
        DMatrix::from_fn(kept.len(), width, |k, o| weight[o] * beyond(kept[k], o))
    };
    series.iter().zip(kept).zip(offset).map(of).collect()
}

#[cfg(test)]
mod tests {
    use acm_core::arm::ArmSpec;
    use acm_core::effects::Carrier;
    use acm_core::nominal::NominalModel;
    use acm_core::record::Record;
    use acm_core::strain::StrainBasis;
    use acm_core::tip_model::StrainModel;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;

    /// Oracle: with a gain of 1.2 the arm is where its strain model has it at 1.2 q, whatever straight line stands for the model.
    #[test]
    fn the_base_is_exact_at_the_inputs_of_a_state() {
        let rig = bench::rig(&["q"], &[], &["x", "y", "z"]);
        let spec = ArmSpec { degree: 1, strain: StrainBasis::Legendre { order: 0 }, ..ArmSpec::default() };
        let model = StrainModel::new(&spec, 1, &[1.0]).unwrap();
        let bent: Vec<f64> =
            model.parameters().iter().enumerate().map(|(j, value)| value + 0.3 + 0.1 * j as f64).collect();
        let strain = Response::new(NominalModel::Strain(model.with_parameters(&bent)), None, None);
        let q: Vec<f64> = bench::time().iter().map(|t| (1.3 * t).cos()).collect();
        let at = |factor: f64, q: &[f64]| {
            let rows: Vec<usize> = (0..q.len()).collect();
            strain.outputs_at(&[q.iter().map(|q| factor * q).collect()], &rows)
        };
        let y = at(1.2, &q);
        let angle = DMatrix::from_column_slice(q.len(), 1, &q);
        let line = Polynomial::fit(&angle, &DMatrix::from_row_slice(q.len(), 3, &at(1.0, &q)), 1).polynomial;
        let mut series = [bench::series(Record::new(bench::time(), vec![q.clone()], vec![], vec![]), y.clone())];
        let beyond = |factor: f64| -> Vec<f64> {
            let straight = line.predict(&(factor * &angle)).transpose();
            at(factor, &q).iter().zip(straight.iter()).map(|(s, g)| s - g).collect()
        };
        series[0].offset = beyond(1.0);
        let problem = Problem::new(&rig, &series, &[1.0; 3], Some(Base { stands_for: &line, strain: Some(&strain) }));
        let gain = bench::placed("static_gain", Carrier::Rig, &rig, &[0.2]);
        let theta = gain.theta.iter().enumerate().map(|(j, _)| if j == 0 { 0.2 } else { 0.0 }).collect();
        let state = State::bare(Form::GIVEN).with(crate::fit::state::Placed { theta, ..gain });
        let about = problem.about(&state).unwrap();
        let largest = |offset: &[f64]| {
            offset.iter().zip(beyond(1.2)).map(|(found, truth)| (found - truth).abs()).fold(0.0, f64::max)
        };
        assert!(largest(&problem.offset[0]) > 1e-3);
        assert!(largest(&about.offset[0]) < 1e-12);
        assert!(problem.about(&State::bare(Form::GIVEN)).is_none());
    }
}
