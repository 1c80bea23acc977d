//! The tip of one trial: actuators through the mechanisms, equilibria of the arm, measurement.

use super::super::campaign::TwinError;
use super::course::{Course, PREROLL, STEP, at};
use super::mechanism::{Mechanism, Now};
use super::quiet::{Acting, Follower, Rig};
use crate::twin::mechanics::equilibrium::NotBalanced;
use crate::twin::mechanics::rod::Chain;
use nalgebra::{Rotation3, Vector3};

/// Number of grid points between two equilibria where the whole course of the tip is needed.
const STRIDE: usize = 10;
/// Time before the first sample from which that course runs, s.
const LEAD: f64 = 3.0;

/// Returns the tips at the given times, without noise, m.
pub fn tips(
    rig: &Rig,
    course: &Course,
    active: &[&dyn Mechanism],
    times: &[f64],
) -> Result<Vec<Vector3<f64>>, TwinError> {
    let mut actuators = course.actuators.clone();
    active.iter().for_each(|mechanism| mechanism.actuate(course, &mut actuators));
    if !active.iter().any(|mechanism| mechanism.filters()) {
        return seen(rig, course, active, &actuators, times);
    }
    let last = course.time(course.throttle.len() - 1);
    let coarse: Vec<f64> = (0..).map(|n| STEP * (STRIDE * n) as f64 - LEAD).take_while(|time| *time <= last).collect();
    let knots = seen(rig, course, active, &actuators, &coarse)?;
    let mut whole = [0, 1, 2].map(|axis| between_knots(&knots, axis, course.throttle.len()));
    active.iter().for_each(|mechanism| mechanism.filter(&mut whole));
    Ok(times.iter().map(|time| Vector3::from([0, 1, 2].map(|axis| at(&whole[axis], *time)))).collect())
}

fn seen(
    rig: &Rig,
    course: &Course,
    active: &[&dyn Mechanism],
    actuators: &[Vec<f64>; 2],
    times: &[f64],
) -> Result<Vec<Vector3<f64>>, TwinError> {
    let unbalanced =
        |time| move |source: NotBalanced| TwinError::Unbalanced { trial: course.number, time, step: 0.1, source };
    let shaped = active.iter().any(|mechanism| mechanism.shaped());
    let mut follower: Option<Follower> = None;
    let mut found = Vec::with_capacity(times.len());
    for &time in times {
        let now = Now { course, rig, time };
        let forces = |arm: &Chain, forces: &mut [Vector3<f64>]| {
            active.iter().for_each(|mechanism| mechanism.push(&now, arm, forces));
        };
        let attitude = active.iter().fold(Rotation3::identity(), |turn, mechanism| turn * mechanism.tilt(&now));
        let acting = Acting { attitude, forces: &forces, shaped };
        let angles = [at(&actuators[0], time), at(&actuators[1], time)];
        let arm = match &mut follower {
            Some(arm) => arm,
            None => follower.insert(Follower::new(rig, angles, &acting).map_err(unbalanced(time))?),
        };
        let mut tip = arm.step(angles, &acting).map_err(unbalanced(time))?;
        active.iter().for_each(|mechanism| mechanism.see(&now, &mut tip));
        found.push(tip.place);
    }
    Ok(found)
}

/// Interpolates one coordinate on the grid, through knots by cubics with central differences as slopes; held before the
/// first.
fn between_knots(knots: &[Vector3<f64>], axis: usize, length: usize) -> Vec<f64> {
    let value = |k: isize| knots[k.clamp(0, knots.len() as isize - 1) as usize][axis];
    let first = ((PREROLL - LEAD) / STEP).round() as isize;
    (0..length as isize)
        .map(|n| {
            let place = (n - first).max(0);
            let (left, u) = (place / STRIDE as isize, (place % STRIDE as isize) as f64 / STRIDE as f64);
            let [before, from, to, after] = [-1, 0, 1, 2].map(|offset| value(left + offset));
            let bend = 2.0 * before - 5.0 * from + 4.0 * to - after;
            from + 0.5 * u * (to - before + u * (bend + u * (3.0 * (from - to) + after - before)))
        })
        .collect()
}
