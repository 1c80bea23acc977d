//! Slopes of the residual of one trial: by differences through the effects, times ∂y/∂q of the model.
//!
//! ```text
//! ∂r/∂θ_j = −W (O(F(p + ∂p/∂q (Q(θ + h e_j) − Q(θ)) + …)) − y) / h
//! ```
//!
//! Only the effects are differentiated by differences; the model's own slopes are exact. What the effects before a changed one
//! make of the actuators is computed once.

use acm_core::augmented;
use acm_core::effects::Site;
use nalgebra::{DMatrix, DVector};

use super::{Point, StateFrom, Tip, Trial, free, refs};
use crate::separability::setup::Setup;

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

/// r of one trial and its slopes.
pub fn sloped(setup: &Setup, s: usize, point: Point, tip: Tip) -> Sloped {
    let trial = Trial { setup, series: &setup.series[s], reference: &setup.references[s] };
    let theta = refs(point.theta);
    let around = Around::new(&trial, point, &theta, tip);
    let by_actuator = around.by_actuator();
    let free = free(point.instances);
    let mut by_theta = DMatrix::zeros(around.y.len(), free.len());
    for (mut column, &(i, j)) in by_theta.column_iter_mut().zip(&free) {
        around.slope(i, j, column.as_mut_slice());
    }
    let mut residual = trial.weighted(&around.y);
    let mut by_delta = None;
    if let Some(states) = trial.states(point, &theta, Some(by_actuator), StateFrom::Trial) {
        states.remove(&mut by_theta);
        states.remove(by_delta.insert(trial.reference.by_parameter.clone()));
        residual = states.without(&residual);
    }
    trial.mask(&mut residual);
    by_theta.column_iter_mut().for_each(|mut column| trial.mask(&mut column));
    if let Some(by_delta) = &mut by_delta {
        by_delta.column_iter_mut().for_each(|mut column| trial.mask(&mut column));
    }
    Sloped { residual, by_theta, by_delta }
}

/// What differences are taken from.
struct Around<'t> {
    trial: &'t Trial<'t>,
    point: Point<'t>,
    theta: &'t [&'t [f64]],
    /// Actuators as each effect of the actuation finds them; nothing for the others.
    before: Vec<Vec<Vec<f64>>>,
    /// Actuators as the model sees them.
    q: Vec<Vec<f64>>,
    /// Slopes of the model there, where they are not those of the reference.
    fresh: Option<Vec<f64>>,
    /// Outputs before frame and output.
    upstream: Vec<f64>,
    y: Vec<f64>,
}

impl<'t> Around<'t> {
    fn new(trial: &'t Trial<'t>, point: Point<'t>, theta: &'t [&'t [f64]], tip: Tip) -> Self {
        let mut q = trial.series.record.actuators.clone();
        let mut before = Vec::with_capacity(theta.len());
        for (instance, theta) in point.instances.iter().zip(theta) {
            let acts = instance.site() == Site::Actuation;
            before.push(if acts { q.clone() } else { vec![] });
            if acts {
                instance.act(theta, &trial.series.record, &mut q);
            }
        }
        let upstream = trial.upstream(point, theta, &q, tip);
        let y = trial.downstream(point, theta, upstream.clone());
        let moved = tip == Tip::Exact && q != trial.reference.q;
        let fresh = moved.then(|| trial.setup.response.linearised_at(&q, &trial.series.rows).by_actuator);
        Self { trial, point, theta, before, q, fresh, upstream, y }
    }

    fn by_actuator(&self) -> &[f64] {
        self.fresh.as_deref().unwrap_or(&self.trial.reference.linear.by_actuator)
    }

    /// ∂r/∂θ_ij into a column.
    fn slope(&self, i: usize, j: usize, column: &mut [f64]) {
        let spec = &self.point.instances[i].parameters()[j];
        let mut own = self.theta[i].to_vec();
        let step = if own[j] + STEP * spec.scale > spec.upper { -STEP * spec.scale } else { STEP * spec.scale };
        own[j] += step;
        let mut theta = self.theta.to_vec();
        theta[i] = &own;
        let moved = self.trial.downstream(self.point, &theta, self.moved(i, &theta));
        let width = self.trial.width();
        let samples = column.chunks_exact_mut(width).zip(moved.chunks_exact(width)).zip(self.y.chunks_exact(width));
        for ((column, moved), y) in samples {
            let outputs = column.iter_mut().zip(moved).zip(y).zip(&self.trial.setup.weight);
            outputs.for_each(|(((column, moved), y), weight)| *column = -weight * ((moved - y) / step));
        }
    }

    /// Outputs before frame and output, where effect `i` has other values.
    fn moved(&self, i: usize, theta: &[&[f64]]) -> Vec<f64> {
        let (trial, instances) = (self.trial, self.point.instances);
        let mut moved = self.upstream.clone();
        match instances[i].site() {
            Site::Actuation => {
                let mut there = self.before[i].clone();
                augmented::actuate(&instances[i..], &theta[i..], &trial.series.record, &mut there);
                trial.add_moved(self.by_actuator(), &self.q, &there, &mut moved);
            }
            Site::Load | Site::Marker => {
                let (before, after) = (trial.loads(instances, self.theta), trial.loads(instances, theta));
                if let (Some(before), Some(mut after)) = (before, after) {
                    for (after, before) in after.iter_mut().zip(&before) {
                        after.iter_mut().zip(before).for_each(|(after, before)| *after -= before);
                    }
                    augmented::displace(&after, &trial.reference.fields, &mut moved);
                }
            }
            Site::Frame | Site::Output => {}
        }
        moved
    }
}
