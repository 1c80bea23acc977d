//! Errors with smoothed actuators: encoder noise reaches the prediction, and effects that smooth remove it.
//!
//! ```text
//! q̄(t) = a,   min over a, b, c of Σ_k (1 − (τ_k/h)²)² (q_k − a − b τ_k − c τ_k²)²,   |τ_k| < h
//! ```
//!
//! | symbol | meaning                          | unit            |
//! | `q̄`    | actuator, smoothed               | of the actuator |
//! | `τ_k`  | t_k − t, time from the sample    | s               |
//! | `h`    | half the window                  | s               |
//!
//! Parabolic motion within the window is unchanged. Fan & Gijbels (1996), Local Polynomial Modelling, ch. 3.

use acm_core::effects::times::windows;
use acm_core::record::Record;
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

use super::scan::{cross_validate, sum};
use crate::fit::columns::Columns;
use crate::fit::problem::Problem;
use crate::fit::state::State;
use crate::series::Series;

/// Returns the smallest sum of squares of a state left out, over windows that its actuators are smoothed with.
pub fn smallest_loss(problem: &Problem, state: &State) -> f64 {
    let loss = |window: f64| {
        let series: Vec<Series> = problem.series.par_iter().map(|series| smoother(series, window)).collect();
        let plain: Problem<'_> = problem.clone();
        let problem = Problem { series: series.into(), columns: Columns::default(), ..plain };
        cross_validate(&problem, state).map_or(f64::INFINITY, |losses| sum(&losses))
    };
    windows(problem.rig).into_iter().map(loss).fold(f64::INFINITY, f64::min)
}

/// Returns a trial with its actuators smoothed.
fn smoother(series: &Series, window: f64) -> Series {
    let of = |record: &Record| {
        let actuators = record.actuators.iter().map(|q| smoothed(&record.time, q, window)).collect();
        let mut smooth = record.clone();
        smooth.actuators = actuators;
        smooth
    };
    let record = of(&series.record);
    Series { thin: record.select(&series.rows), record, ..series.clone() }
}

/// Returns q̄ at each sample; q where the window holds too little.
fn smoothed(time: &[f64], q: &[f64], window: f64) -> Vec<f64> {
    let (mut low, mut high) = (0, 0);
    let at = |(k, &now): (usize, &f64)| {
        while time[low] <= now - window {
            low += 1;
        }
        while high < time.len() && time[high] < now + window {
            high += 1;
        }
        parabola(&time[low..high], &q[low..high], now, window).unwrap_or(q[k])
    };
    time.iter().enumerate().map(at).collect()
}

/// Fits a parabola, and returns its value a at `now`.
fn parabola(time: &[f64], q: &[f64], now: f64, window: f64) -> Option<f64> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (time, q) in time.iter().zip(q) {
        let u = (time - now) / window;
        let (powers, weight) = (Vector3::new(1.0, u, u * u), (1.0 - u * u).powi(2));
        normal += weight * powers * powers.transpose();
        right += weight * *q * powers;
    }
    normal.cholesky().map(|factor| factor.solve(&right).x).filter(|a| a.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;

    /// Oracle: a parabola stays, at its ends too; of an alternating sign next to nothing is left.
    #[test]
    fn a_parabola_stays_and_noise_goes() {
        let time: Vec<f64> = (0..60).map(|k| 0.1 * f64::from(k) + 0.03 * f64::from(k % 3)).collect();
        let parabola: Vec<f64> = time.iter().map(|t| 3.0 - 2.0 * t + 0.7 * t * t).collect();
        let found = smoothed(&time, &parabola, 0.9);
        assert!(found.iter().zip(&parabola).all(|(a, b)| (a - b).abs() < 1e-9));
        let sign: Vec<f64> = (0..60).map(|k| f64::from(1 - 2 * (k % 2))).collect();
        assert!(smoothed(&time, &sign, 0.9)[10..50].iter().all(|a| a.abs() < 0.15));
        assert_eq!(smoothed(&time, &sign, 1e-9), sign);
    }

    /// Oracle: y = q₀, of which q = q₀ + n is recorded: what is left is n² as it is, and a small part of it where q is smoothed.
    #[test]
    fn smoother_actuators_predict_better_where_encoders_are_noisy() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let noise = |k: usize| 0.05 * (((k * k) as f64 * 0.618_034).fract() - 0.5);
        let y: Vec<f64> = bench::time().iter().map(|t| (0.6 * t).sin()).collect();
        let q = y.iter().enumerate().map(|(k, y)| y + noise(k)).collect();
        let series = [bench::series(Record::new(bench::time(), vec![q], vec![], vec![]), y.clone())];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let bare = State::bare(Form::LINEAR);
        let as_it_is = sum(&cross_validate(&problem, &bare).unwrap());
        let noise: f64 = (0..y.len()).map(|k| noise(k).powi(2)).sum();
        assert!((as_it_is / noise - 1.0).abs() < 0.1, "{as_it_is} {noise}");
        assert!(smallest_loss(&problem, &bare) < 0.2 * noise);
    }
}
