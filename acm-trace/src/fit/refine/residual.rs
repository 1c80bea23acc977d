//! The residual of a state over its nonlinear parameters u, with all linear ones solved for.
//!
//! ```text
//! J⁺ = J + (r⁺ − r − J p) pᵀ / pᵀp
//! ```
//!
//! | symbol   | meaning                                                        |
//! | -------- | -------------------------------------------------------------- |
//! | `J, r`   | slopes by differences, and the residual, at one point          |
//! | `p`      | step to the next point                                         |
//! | `J⁺, r⁺` | slopes and residual there                                      |
//!
//! Differences need one evaluation per parameter, so they are computed at every second point; J⁺ serves the points between. Broyden
//! (1965), Mathematics of Computation 19.

use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use acm_core::least_squares::Residuals;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::coordinates::{Coordinate, put};
use crate::fit::design::keep_inputs;
use crate::fit::problem::Problem;
use crate::fit::projected::project;
use crate::fit::state::State;

/// A point and the residual there.
#[derive(Debug, Clone)]
struct Point {
    u: DVector<f64>,
    residual: DVector<f64>,
}

/// The residual as a least-squares problem: one sample with all residuals.
pub struct ProjectedResidual<'r, 'a> {
    problem: &'r Problem<'a>,
    state: &'r State,
    coordinates: &'r [Coordinate],
    rows: usize,
    /// The last point: slopes are computed where a step ended.
    last: Mutex<Point>,
    /// Slopes by differences, until they have served the next point.
    known: Mutex<Option<(Point, DMatrix<f64>)>>,
}

impl<'r, 'a> ProjectedResidual<'r, 'a> {
    /// Returns the residual of a state; none where its equations are singular.
    pub fn new(problem: &'r Problem<'a>, state: &'r State, coordinates: &'r [Coordinate]) -> Option<Self> {
        keep_inputs(problem, state);
        let residual = DVector::from_column_slice(project(problem, state)?.residual.as_slice());
        let (rows, u) = (residual.len(), DVector::from_element(coordinates.len(), 1.0));
        let last = Mutex::new(Point { u, residual });
        Some(Self { problem, state, coordinates, rows, last, known: Mutex::default() })
    }

    fn residual(&self, u: &[f64]) -> DVector<f64> {
        let projected = project(self.problem, &put(self.state, self.coordinates, u));
        projected.map_or_else(
            || DVector::from_element(self.rows, f64::NAN),
            |projected| DVector::from_column_slice(projected.residual.as_slice()),
        )
    }

    fn point(&self, u: &[f64]) -> Point {
        let last = lock(&self.last).clone();
        if last.u.as_slice() == u {
            return last;
        }
        // Effects before the one that is varied are reused.
        keep_inputs(self.problem, &put(self.state, self.coordinates, u));
        let point = Point { u: DVector::from_column_slice(u), residual: self.residual(u) };
        lock(&self.last).clone_from(&point);
        point
    }

    /// Returns the slopes by differences.
    fn differences(&self, point: &Point) -> DMatrix<f64> {
        let column = |j: usize| {
            let mut u = point.u.clone();
            let step = self.coordinates[j].step_from(u[j]);
            u[j] += step;
            let slope = (self.residual(u.as_slice()) - &point.residual) / step;
            slope.map(|slope| if slope.is_finite() { slope } else { 0.0 })
        };
        let columns: Vec<DVector<f64>> = (0..point.u.len()).into_par_iter().map(column).collect();
        DMatrix::from_columns(&columns)
    }
}

impl Residuals for ProjectedResidual<'_, '_> {
    fn parameters(&self) -> usize {
        self.coordinates.len()
    }

    fn samples(&self) -> usize {
        1
    }

    fn outputs(&self) -> usize {
        self.rows
    }

    fn residuals(&self, u: &[f64], _: Range<usize>, out: &mut [f64]) {
        out.copy_from_slice(self.point(u).residual.as_slice());
    }

    fn slopes(&self, u: &[f64], _: Range<usize>, out: &mut [f64], slopes: &mut DMatrix<f64>) {
        let point = self.point(u);
        out.copy_from_slice(point.residual.as_slice());
        let known = lock(&self.known).take();
        match known {
            Some((before, known)) => slopes.copy_from(&updated(&before, known, &point)),
            None => {
                slopes.copy_from(&self.differences(&point));
                *lock(&self.known) = Some((point, slopes.clone()));
            }
        }
    }
}

/// Returns slopes J updated by the step to another point; see the head of this file.
fn updated(before: &Point, mut slopes: DMatrix<f64>, now: &Point) -> DMatrix<f64> {
    let step = &now.u - &before.u;
    let missed = &now.residual - &before.residual - &slopes * &step;
    slopes.ger(1.0 / step.norm_squared(), &missed, &step, 1.0);
    slopes
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the two conditions that define the update: J⁺ p = r⁺ − r, and J⁺ v = J v for v at right angles to p.
    #[test]
    fn slopes_agree_with_the_step_and_change_in_no_other_direction() {
        let point = |u: [f64; 2], r: [f64; 3]| Point { u: u.to_vec().into(), residual: r.to_vec().into() };
        let (before, now) = (point([1.0, 2.0], [0.3, -1.0, 4.0]), point([1.6, 1.2], [1.1, 0.2, -0.7]));
        let slopes = DMatrix::from_row_slice(3, 2, &[1.0, 0.5, -2.0, 0.1, 0.0, 3.0]);
        let next = updated(&before, slopes.clone(), &now);
        let (p, v) = (DVector::from_vec(vec![0.6, -0.8]), DVector::from_vec(vec![0.8, 0.6]));
        assert!((&next * p - (now.residual - before.residual)).amax() < 1e-14);
        assert!(((next - slopes) * v).amax() < 1e-14);
    }
}
