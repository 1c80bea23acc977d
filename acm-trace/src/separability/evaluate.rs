//! Residuals of one trial under a set of effects: `r = W (measured − y)`; their slopes are in `slopes`, and what is not known
//! at the start of a trial in `states`.

mod slopes;
mod states;

use acm_core::augmented;
use acm_core::effects::instance::Instance;
use nalgebra::{DMatrixView, DVector, Dyn, Matrix, RawStorageMut, U1};
pub use slopes::sloped;
pub use states::StateFrom;

use crate::separability::setup::{Reference, Setup};
use crate::series::Series;

/// How the model follows actuators that effects have moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tip {
    /// By its slopes at the reference: fast, for ranking.
    Linear,
    /// As it is.
    Exact,
}

/// Effects with their values, and the change of the calibration.
#[derive(Debug, Clone, Copy)]
pub struct Point<'p> {
    /// In the order of action.
    pub instances: &'p [Instance],
    /// θ of each.
    pub theta: &'p [Vec<f64>],
    /// δ.
    pub delta: &'p DVector<f64>,
}

/// Free parameters of a set of effects: index of the effect, index of the parameter.
pub fn free(instances: &[Instance]) -> Vec<(usize, usize)> {
    let of = |(i, instance): (usize, &Instance)| {
        let specs = instance.parameters().to_vec();
        (0..specs.len()).filter(move |&j| specs[j].is_free()).map(move |j| (i, j))
    };
    instances.iter().enumerate().flat_map(of).collect()
}

/// Outputs of one trial [N×M], SI.
pub fn outputs(setup: &Setup, s: usize, point: Point, tip: Tip) -> Vec<f64> {
    let trial = Trial { setup, series: &setup.series[s], reference: &setup.references[s] };
    let theta = refs(point.theta);
    let q = augmented::actuation(point.instances, &theta, &trial.series.record);
    let y = trial.upstream(point, &theta, &q, tip);
    trial.downstream(point, &theta, y)
}

/// r of one trial.
pub fn residual(setup: &Setup, s: usize, point: Point, tip: Tip, state: StateFrom) -> DVector<f64> {
    let trial = Trial { setup, series: &setup.series[s], reference: &setup.references[s] };
    let mut residual = all_residuals(&trial, point, tip, state);
    trial.mask(&mut residual);
    residual
}

fn all_residuals(trial: &Trial, point: Point, tip: Tip, state: StateFrom) -> DVector<f64> {
    let theta = refs(point.theta);
    let q = augmented::actuation(point.instances, &theta, &trial.series.record);
    let y = trial.upstream(point, &theta, &q, tip);
    let residual = trial.weighted(&trial.downstream(point, &theta, y));
    match trial.states(point, &theta, None, state) {
        None => residual,
        Some(states) => states.without(&residual),
    }
}

fn refs(theta: &[Vec<f64>]) -> Vec<&[f64]> {
    theta.iter().map(Vec::as_slice).collect()
}

struct Trial<'t> {
    setup: &'t Setup<'t>,
    series: &'t Series,
    reference: &'t Reference,
}

impl Trial<'_> {
    fn width(&self) -> usize {
        self.setup.outputs()
    }

    /// Everything before frame and output.
    fn upstream(&self, point: Point, theta: &[&[f64]], q: &[Vec<f64>], tip: Tip) -> Vec<f64> {
        let linear = &self.reference.linear;
        let mut y = if q == self.reference.q.as_slice() {
            linear.outputs.clone()
        } else if tip == Tip::Exact {
            self.setup.response.outputs_at(q, &self.series.rows)
        } else {
            let mut y = linear.outputs.clone();
            self.add_moved(&linear.by_actuator, &self.reference.q, q, &mut y);
            y
        };
        if point.delta.iter().any(|delta| *delta != 0.0) {
            // Row after row in memory is column after column of the transpose.
            let slopes = DMatrixView::from_slice(&linear.by_parameter, point.delta.len(), y.len());
            let moved = slopes.tr_mul(point.delta);
            y.iter_mut().zip(moved.iter()).for_each(|(y, moved)| *y += moved);
        }
        y.iter_mut().zip(&self.series.offset).for_each(|(y, offset)| *y += offset);
        if let Some(columns) = self.loads(point.instances, theta) {
            augmented::displace(&columns, &self.reference.fields, &mut y);
        }
        y
    }

    /// Loads at the N samples.
    fn loads(&self, instances: &[Instance], theta: &[&[f64]]) -> Option<Vec<Vec<f64>>> {
        let columns = augmented::loads(instances, theta, &self.series.record)?;
        let pick = |column: Vec<f64>| self.series.rows.iter().map(|&t| column[t]).collect();
        Some(columns.into_iter().map(pick).collect())
    }

    fn downstream(&self, point: Point, theta: &[&[f64]], y: Vec<f64>) -> Vec<f64> {
        if !point.instances.iter().any(augmented::acts_downstream) {
            return y;
        }
        let width = self.width();
        let mut columns: Vec<Vec<f64>> =
            (0..width).map(|o| y.iter().skip(o).step_by(width).copied().collect()).collect();
        augmented::downstream(point.instances, theta, &self.series.thin, &mut columns);
        let mut y = y;
        for (o, column) in columns.iter().enumerate() {
            y.iter_mut().skip(o).step_by(width).zip(column).for_each(|(y, value)| *y = *value);
        }
        y
    }

    /// Adds ∂y/∂q (q' − q).
    fn add_moved(&self, by_actuator: &[f64], q: &[Vec<f64>], there: &[Vec<f64>], y: &mut [f64]) {
        let (width, actuators) = (self.width(), q.len());
        let moving: Vec<usize> = (0..actuators).filter(|&a| q[a] != there[a]).collect();
        if moving.is_empty() {
            return;
        }
        let mut steps = vec![0.0; moving.len()];
        let samples = y.chunks_exact_mut(width).zip(by_actuator.chunks_exact(width * actuators));
        for ((y, slopes), &t) in samples.zip(&self.series.rows) {
            steps.iter_mut().zip(&moving).for_each(|(step, &a)| *step = there[a][t] - q[a][t]);
            for (y, slopes) in y.iter_mut().zip(slopes.chunks_exact(actuators)) {
                steps.iter().zip(&moving).for_each(|(step, &a)| *y += slopes[a] * step);
            }
        }
    }

    /// weight × (measured − y).
    fn weighted(&self, y: &[f64]) -> DVector<f64> {
        let mut residual = DVector::from_column_slice(&self.series.measured);
        let samples = residual.as_mut_slice().chunks_exact_mut(self.width()).zip(y.chunks_exact(self.width()));
        for (residual, y) in samples {
            residual.iter_mut().zip(y).zip(&self.setup.weight).for_each(|((r, y), weight)| *r = weight * (*r - y));
        }
        residual
    }

    /// Zero where a sample does not count.
    fn mask<S: RawStorageMut<f64, Dyn, U1>>(&self, column: &mut Matrix<f64, Dyn, U1, S>) {
        let width = self.width();
        for k in (0..self.series.samples()).filter(|&k| !self.series.counts[k]) {
            column.rows_mut(k * width, width).fill(0.0);
        }
    }
}
