//! Residuals of one trial under a set of effects, and their slopes.
//!
//! ```text
//! r = W (measured − y),   ∂r/∂θ by differences through the effects, times ∂y/∂q of the model
//! ```
//!
//! Only the effects are differentiated by differences; the model's own slopes are exact. A trial whose effects forget slowly has
//! an unknown state at its start: e^{−t/τ} of an offset of each actuator, with a prior of a tenth of its range.

use acm_core::augmented;
use acm_core::effects::Site;
use acm_core::effects::instance::Instance;
use nalgebra::{DMatrix, DMatrixView, DVector, Dyn, Matrix, RawStorageMut, U1};

use crate::series::{Series, warm_up};
use crate::setup::{Reference, Setup};

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

/// Residual and slopes of one trial; NM rows.
#[derive(Debug, Clone)]
pub struct Sloped {
    /// r.
    pub residual: DVector<f64>,
    /// ∂r/∂θ of the free parameters.
    pub by_theta: DMatrix<f64>,
    /// ∂r/∂δ where it is not the reference's own.
    pub by_delta: Option<DMatrix<f64>>,
}

/// Share of a parameter's scale that differences step by.
const STEP: f64 = 1e-3;

/// Prior of the unknown state at the start of a trial, as a share of each actuator's range.
const STATE: f64 = 0.1;

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

/// Which samples tell the unknown state at the start of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StateFrom {
    /// All: for fits.
    Trial,
    /// The warm-up, which does not count: for scores, so that a trial is predicted from nothing that is scored.
    WarmUp,
}

/// r of one trial.
pub fn residual(setup: &Setup, s: usize, point: Point, tip: Tip, state: StateFrom) -> DVector<f64> {
    let trial = Trial { setup, series: &setup.series[s], reference: &setup.references[s] };
    let mut residual = all_residuals(&trial, point, tip, state);
    trial.mask(&mut residual);
    residual
}

/// r of one trial at every sample, whether it counts or not.
pub fn residual_everywhere(setup: &Setup, s: usize, point: Point, tip: Tip) -> DVector<f64> {
    let trial = Trial { setup, series: &setup.series[s], reference: &setup.references[s] };
    all_residuals(&trial, point, tip, StateFrom::WarmUp)
}

fn all_residuals(trial: &Trial, point: Point, tip: Tip, state: StateFrom) -> DVector<f64> {
    let theta = refs(point.theta);
    let q = augmented::actuation(point.instances, &theta, &trial.series.record);
    let y = trial.upstream(point, &theta, &q, tip);
    let residual = trial.weighted(&trial.downstream(point, &theta, y));
    match trial.states(point, &theta, None, state) {
        None => residual,
        Some(states) => &residual - states.share(&residual),
    }
}

/// r of one trial and its slopes.
pub fn sloped(setup: &Setup, s: usize, point: Point, tip: Tip) -> Sloped {
    let trial = Trial { setup, series: &setup.series[s], reference: &setup.references[s] };
    let theta = refs(point.theta);
    let q = augmented::actuation(point.instances, &theta, &trial.series.record);
    let upstream = trial.upstream(point, &theta, &q, tip);
    let y = trial.downstream(point, &theta, upstream.clone());
    let moved = tip == Tip::Exact && q != trial.reference.q;
    let fresh = moved.then(|| setup.response.linearised_at(&q, &trial.series.rows).by_actuator);
    let by_actuator = fresh.as_deref().unwrap_or(&trial.reference.linear.by_actuator);
    let free = free(point.instances);
    let mut by_theta = DMatrix::zeros(y.len(), free.len());
    for (column, &(i, j)) in free.iter().enumerate() {
        let spec = &point.instances[i].parameters()[j];
        let (value, step) = (point.theta[i][j], STEP * spec.scale);
        let step = if value + step > spec.upper { -step } else { step };
        let mut changed = point.theta.to_vec();
        changed[i][j] = value + step;
        let slope = trial.slope(point, &changed, i, &q, by_actuator, &upstream, &y, step);
        by_theta.column_mut(column).copy_from(&trial.sloped_residual(&slope));
    }
    let mut residual = trial.weighted(&y);
    let mut by_delta = None;
    if let Some(states) = trial.states(point, &theta, Some(by_actuator), StateFrom::Trial) {
        by_theta = states.remove(by_theta);
        by_delta = Some(states.remove(trial.reference.by_parameter.clone()));
        residual = &residual - states.share(&residual);
    }
    trial.mask(&mut residual);
    by_theta.column_iter_mut().for_each(|mut column| trial.mask(&mut column));
    if let Some(by_delta) = &mut by_delta {
        by_delta.column_iter_mut().for_each(|mut column| trial.mask(&mut column));
    }
    Sloped { residual, by_theta, by_delta }
}

fn refs(theta: &[Vec<f64>]) -> Vec<&[f64]> {
    theta.iter().map(Vec::as_slice).collect()
}

struct Trial<'t> {
    setup: &'t Setup<'t>,
    series: &'t Series,
    reference: &'t Reference,
}

/// Columns Z of unknown states at the start, with (ZᵀZ + R)⁻¹Zᵀ.
struct States {
    columns: DMatrix<f64>,
    solver: DMatrix<f64>,
}

impl States {
    /// What states explain of a column.
    fn share(&self, column: &DVector<f64>) -> DVector<f64> {
        &self.columns * (&self.solver * column)
    }

    fn remove(&self, matrix: DMatrix<f64>) -> DMatrix<f64> {
        let explained = &self.columns * (&self.solver * &matrix);
        matrix - explained
    }
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

    /// ∂y/∂θ_ij, by the difference that `changed` makes.
    #[allow(clippy::too_many_arguments)]
    fn slope(
        &self,
        point: Point,
        changed: &[Vec<f64>],
        i: usize,
        q: &[Vec<f64>],
        by_actuator: &[f64],
        upstream: &[f64],
        y: &[f64],
        step: f64,
    ) -> Vec<f64> {
        let theta = refs(changed);
        let mut moved = upstream.to_vec();
        match point.instances[i].site() {
            Site::Actuation => {
                let there = augmented::actuation(point.instances, &theta, &self.series.record);
                self.add_moved(by_actuator, q, &there, &mut moved);
            }
            Site::Load | Site::Marker => {
                let before = self.loads(point.instances, &refs(point.theta));
                let after = self.loads(point.instances, &theta);
                if let (Some(before), Some(mut after)) = (before, after) {
                    for (after, before) in after.iter_mut().zip(&before) {
                        after.iter_mut().zip(before).for_each(|(after, before)| *after -= before);
                    }
                    augmented::displace(&after, &self.reference.fields, &mut moved);
                }
            }
            Site::Frame | Site::Output => {}
        }
        let moved = self.downstream(point, &theta, moved);
        moved.iter().zip(y).map(|(moved, y)| (moved - y) / step).collect()
    }

    /// Adds ∂y/∂q (q' − q).
    fn add_moved(&self, by_actuator: &[f64], q: &[Vec<f64>], there: &[Vec<f64>], y: &mut [f64]) {
        let (width, actuators) = (self.width(), q.len());
        for a in 0..actuators {
            if q[a] == there[a] {
                continue;
            }
            for (k, &t) in self.series.rows.iter().enumerate() {
                let step = there[a][t] - q[a][t];
                for o in 0..width {
                    y[k * width + o] += by_actuator[(k * width + o) * actuators + a] * step;
                }
            }
        }
    }

    /// weight × (measured − y).
    fn weighted(&self, y: &[f64]) -> DVector<f64> {
        let width = self.width();
        DVector::from_fn(y.len(), |row, _| self.setup.weight[row % width] * (self.series.measured[row] - y[row]))
    }

    /// −weight × slope.
    fn sloped_residual(&self, slope: &[f64]) -> DVector<f64> {
        let width = self.width();
        DVector::from_fn(slope.len(), |row, _| -self.setup.weight[row % width] * slope[row])
    }

    /// Zero where a sample does not count.
    fn mask<S: RawStorageMut<f64, Dyn, U1>>(&self, column: &mut Matrix<f64, Dyn, U1, S>) {
        let width = self.width();
        for k in (0..self.series.samples()).filter(|&k| !self.series.counts[k]) {
            column.rows_mut(k * width, width).fill(0.0);
        }
    }

    fn states(&self, point: Point, theta: &[&[f64]], by_actuator: Option<&[f64]>, state: StateFrom) -> Option<States> {
        let acts = |i: &Instance| i.site() == Site::Actuation;
        let memories = point.instances.iter().zip(theta).filter(|(i, _)| acts(i)).filter_map(|(i, th)| i.memory(th));
        let tau = memories.fold(0.0, f64::max);
        let time = &self.series.thin.time;
        let first = *time.first()?;
        if tau <= warm_up(time) - first {
            return None;
        }
        let by_actuator = by_actuator.unwrap_or(&self.reference.linear.by_actuator);
        let (width, actuators) = (self.width(), self.reference.q.len());
        let mut columns = DMatrix::zeros(time.len() * width, actuators);
        for a in 0..actuators {
            let slope: Vec<f64> = (0..time.len() * width)
                .map(|row| by_actuator[row * actuators + a] * (-(time[row / width] - first) / tau).exp())
                .collect();
            columns.column_mut(a).copy_from(&self.sloped_residual(&slope));
        }
        let prior = DVector::from_iterator(
            actuators,
            self.setup.rig.actuators.iter().map(|q| self.setup.noise / (STATE * q.span()).max(1e-12).powi(2)),
        );
        let mut telling = columns.clone();
        if state == StateFrom::WarmUp {
            for k in (0..time.len()).filter(|&k| self.series.counts[k]) {
                telling.rows_mut(k * width, width).fill(0.0);
            }
        }
        let normal = telling.tr_mul(&telling) + DMatrix::from_diagonal(&prior);
        let solver = normal.cholesky()?.solve(&telling.transpose());
        Some(States { columns, solver })
    }
}
