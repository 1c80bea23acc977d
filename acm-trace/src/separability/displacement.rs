//! Displacement of the outputs by an effect, and its derivative by the effect's values.
//!
//! ```text
//! d(θ) = W (O(F(y + ∂y/∂q (Q(q; θ) − q) + Σ_f w_f(θ) u_f; θ)) − y),   ∂d/∂θ_j = (d(θ + h e_j) − d(θ)) / h
//! ```
//!
//! | symbol | meaning                                                                 |
//! | `Q, w, F, O` | the effect at its place ([`acm_core::augmented`])                 |
//! | `W`    | weight of each output; zero where a sample does not count               |

use acm_core::augmented;
use acm_core::effects::Site;
use acm_core::effects::instance::Instance;
use nalgebra::{DMatrix, DVector};

use super::trials::{Trial, Trials};

/// Step of differences, as a share of a parameter's scale.
const STEP: f64 = 1e-3;

/// Returns the indices of the parameters that a fit may move.
pub fn free(instance: &Instance) -> Vec<usize> {
    (0..instance.parameters().len()).filter(|&j| instance.parameters()[j].is_free()).collect()
}

/// Returns d of all trials, NM.
pub fn displacement(trials: &Trials, instance: &Instance, theta: &[f64]) -> DVector<f64> {
    let mut displacement = DVector::zeros(trials.rows());
    displace(trials, instance, theta, displacement.as_mut_slice());
    displacement
}

/// Returns d, then its slopes with each free parameter, NM × (1 + n).
pub fn with_slopes(trials: &Trials, instance: &Instance, theta: &[f64]) -> DMatrix<f64> {
    let free = free(instance);
    let mut columns = DMatrix::zeros(trials.rows(), 1 + free.len());
    let (here, slopes) = columns.as_mut_slice().split_at_mut(trials.rows());
    displace(trials, instance, theta, here);
    for (slope, &j) in slopes.chunks_exact_mut(trials.rows().max(1)).zip(&free) {
        let (spec, mut moved) = (&instance.parameters()[j], theta.to_vec());
        let step = STEP * spec.scale * if theta[j] + STEP * spec.scale > spec.upper { -1.0 } else { 1.0 };
        moved[j] += step;
        displace(trials, instance, &moved, slope);
        slope.iter_mut().zip(&*here).for_each(|(slope, here)| *slope = (*slope - here) / step);
    }
    columns
}

/// Writes d into a column.
fn displace(trials: &Trials, instance: &Instance, theta: &[f64], column: &mut [f64]) {
    for trial in &trials.all {
        let y = outputs(trial, trials.prepared.weight.len(), instance, theta);
        trials.weigh(trial, &y, &trial.linear.outputs, column);
    }
}

/// Returns the outputs of one trial with the effect, N × M, row by row.
fn outputs(trial: &Trial, width: usize, instance: &Instance, theta: &[f64]) -> Vec<f64> {
    let (series, mut y) = (trial.series, trial.linear.outputs.clone());
    let (instances, theta) = (std::slice::from_ref(instance), [theta]);
    match instance.site() {
        Site::Actuation => {
            add_moved(trial, width, &augmented::actuation(instances, &theta, &series.record), &mut y);
        }
        Site::Load | Site::Marker => {
            let loads = augmented::loads(instances, &theta, &series.record).unwrap_or_default();
            let thin = loads.iter().map(|column| series.rows.iter().map(|&t| column[t]).collect());
            augmented::displace(&thin.collect::<Vec<Vec<f64>>>(), &trial.fields, &mut y);
        }
        Site::Frame | Site::Output => {
            let column = |o: usize| y.iter().skip(o).step_by(width).copied().collect::<Vec<f64>>();
            let mut columns: Vec<Vec<f64>> = (0..width).map(column).collect();
            augmented::downstream(instances, &theta, &series.thin, &mut columns);
            for (o, column) in columns.iter().enumerate() {
                y.iter_mut().skip(o).step_by(width).zip(column).for_each(|(y, value)| *y = *value);
            }
        }
    }
    y
}

/// Adds ∂y/∂q (q̃ − q).
fn add_moved(trial: &Trial, width: usize, there: &[Vec<f64>], y: &mut [f64]) {
    let q = &trial.series.record.actuators;
    let moving: Vec<usize> = (0..q.len()).filter(|&a| q[a] != there[a]).collect();
    let samples = y.chunks_exact_mut(width).zip(trial.linear.by_actuator.chunks_exact(width * q.len()));
    for ((y, slopes), &t) in samples.zip(&trial.series.rows) {
        for &a in &moving {
            let step = there[a][t] - q[a][t];
            y.iter_mut().zip(slopes.iter().skip(a).step_by(q.len())).for_each(|(y, slope)| *y += slope * step);
        }
    }
}
