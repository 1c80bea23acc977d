//! Signals that jump by a whole period: an angle that is written within one turn, a counter that starts again, a quaternion
//! that changes its sign. Between the two samples the value did not pass through those in between, so interpolation,
//! rates and effects with memory are wrong there.
//!
//! ```text
//! a jump of P at k:   3/4 P ≤ |d_k| ≤ 5/4 P,   |d_k ∓ P| ≤ 3·max(|d_{k−1}|, |d_{k+1}|),   d_k = x_k − x_{k−1}
//! ```
//!
//! All other steps must be shorter than P/4: a signal that is sampled more coarsely, such as a random set point, does not show
//! whether it wraps. The step that remains must be of the size of its neighbours (a factor of 3 allows for acceleration).

use std::cmp::Reverse;
use std::collections::BTreeMap;

use crate::ingest::stamps::COUNTERS;

/// Jumps of a signal by its period.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wraps {
    /// In the unit of the signal.
    pub period: f64,
    /// Indices of the samples after the jumps.
    pub samples: Vec<usize>,
}

/// The jumps of a signal; `turn` is a full turn in its unit if it is an angle. NaN is a missing value.
pub(crate) fn find(values: &[f64], turn: Option<f64>) -> Option<Wraps> {
    let present: Vec<usize> = (0..values.len()).filter(|i| values[*i].is_finite()).collect();
    let whole = present.iter().all(|i| values[*i].fract() == 0.0);
    let counters = COUNTERS.into_iter().filter(|_| whole && turn.is_none());
    turn.into_iter().chain(counters).find_map(|period| jumps(values, &present, period))
}

fn jumps(values: &[f64], present: &[usize], period: f64) -> Option<Wraps> {
    let steps: Vec<f64> = present.windows(2).map(|pair| values[pair[1]] - values[pair[0]]).collect();
    let is_long = |step: &f64| (0.75 * period..=1.25 * period).contains(&step.abs());
    if !steps.iter().all(|step| step.abs() < 0.25 * period || is_long(step)) {
        return None;
    }
    let step = |k: Option<usize>| k.and_then(|k| steps.get(k)).map_or(0.0, |step| step.abs());
    let goes_on = |k: &usize| {
        let beside = step(k.checked_sub(1)).max(step(Some(k + 1)));
        beside > 0.0 && (steps[*k].abs() - period).abs() <= 3.0 * beside
    };
    let long: Vec<usize> = (0..steps.len()).filter(|k| is_long(&steps[*k])).collect();
    let samples: Vec<usize> = long.iter().filter(|k| goes_on(k)).map(|k| present[k + 1]).collect();
    (!samples.is_empty() && 2 * samples.len() > long.len()).then_some(Wraps { period, samples })
}

/// Samples at which the four columns of a unit quaternion change their sign, though it hardly turns; none if they are no
/// unit quaternion.
pub(crate) fn flips(four: [&[f64]; 4]) -> Vec<usize> {
    let at = |i: usize| four.map(|column| column[i]);
    let dot = |a: [f64; 4], b: [f64; 4]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let present: Vec<usize> = (0..four[0].len()).filter(|i| at(*i).iter().all(|value| value.is_finite())).collect();
    let is_unit = present.iter().all(|i| (dot(at(*i), at(*i)) - 1.0).abs() < 0.01);
    let flips = |pair: &&[usize]| is_unit && dot(at(pair[0]), at(pair[1])) < -0.5;
    present.windows(2).filter(flips).map(|pair| pair[1]).collect()
}

/// Takes whole periods out of the steps of a signal: no step is longer than half a period. The number of turns before the
/// first sample is unknown; it is chosen so that most samples keep their value. NaN stays.
pub(crate) fn unwrap(values: &mut [f64], period: f64) {
    let (mut turns, mut before) = (0_i32, None);
    let mut samples = BTreeMap::<i32, usize>::new();
    for value in values.iter_mut().filter(|value| value.is_finite()) {
        let step = before.map_or(0.0, |before| *value + f64::from(turns) * period - before);
        turns = turns.saturating_sub((step / period).round() as i32);
        *value += f64::from(turns) * period;
        before = Some(*value);
        *samples.entry(turns).or_default() += 1;
    }
    let usual = samples.into_iter().max_by_key(|(turns, count)| (*count, Reverse(turns.unsigned_abs())));
    let shift = usual.map_or(0.0, |(turns, _)| f64::from(turns) * period);
    values.iter_mut().for_each(|value| *value -= shift);
}

/// Turns the sign of quaternions so that none is more than a right angle from the one before. NaN stays.
pub(crate) fn align_signs(four: &mut [Vec<f64>; 4]) {
    let mut before: Option<[f64; 4]> = None;
    for i in 0..four[0].len() {
        let here = four.each_ref().map(|column| column[i]);
        if here.iter().any(|value| !value.is_finite()) {
            continue;
        }
        let turned = before.is_some_and(|before| before.iter().zip(here).map(|(x, y)| x * y).sum::<f64>() < 0.0);
        if turned {
            four.iter_mut().for_each(|column| column[i] = -column[i]);
        }
        before = Some(four.each_ref().map(|column| column[i]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wrapped(period: f64, low: f64, of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..400).map(|k| (of(f64::from(k)) - low).rem_euclid(period) + low).collect()
    }

    /// Oracle: planted; and unwrapped it is the motion again, up to whole periods.
    #[test]
    fn angles_and_counters_that_wrap_are_found_and_unwrapped() {
        let turn = 2.0 * std::f64::consts::PI;
        let motion = |k: f64| 5.0 * (0.02 * k).sin() + 0.01 * k;
        for (period, low, scale) in [(turn, -turn / 2.0, 1.0), (turn, 0.0, 1.0), (360.0, -180.0, 60.0)] {
            let mut values = wrapped(period, low, |k| scale * motion(k));
            values[7] = f64::NAN;
            let found = find(&values, Some(period)).expect("wraps");
            assert_eq!(found.period, period);
            unwrap(&mut values, period);
            let offset = values[0] - scale * motion(0.0);
            let error = (0..400).filter(|k| *k != 7).map(|k| (values[k] - offset - scale * motion(k as f64)).abs());
            assert!(error.fold(0.0, f64::max) < 1e-9 && values[7].is_nan());
        }
        for range in COUNTERS {
            let values = wrapped(range, 0.0, |k| (range * (0.9 + 0.02 * k)).round());
            assert_eq!(find(&values, None).map(|found| (found.period, found.samples.len())), Some((range, 8)));
        }
    }

    /// Oracle: the motion, which begins beyond half a turn and is within it for most of the time.
    #[test]
    fn a_trial_that_begins_in_another_turn_keeps_its_zero() {
        let turn = 2.0 * std::f64::consts::PI;
        let motion = |k: f64| 4.0 * (0.05 * k).cos();
        let mut values = wrapped(turn, -turn / 2.0, motion);
        assert!(values[0] < 0.0, "written in another turn");
        unwrap(&mut values, turn);
        let error = values.iter().zip(0..).map(|(value, k)| (value - motion(f64::from(k))).abs());
        assert!(error.fold(0.0, f64::max) < 1e-9);
    }

    #[test]
    fn what_does_not_wrap_is_left_alone() {
        let none = |what: &str, turn: Option<f64>, of: &dyn Fn(i64) -> f64| {
            let values: Vec<f64> = (0..400).map(of).collect();
            assert_eq!(find(&values, turn), None, "{what}");
        };
        let turn = Some(360.0);
        none("a rotation that is unwrapped", turn, &|k| 3.0 * k as f64);
        none("a square wave of a turn", turn, &|k| if k / 50 % 2 == 0 { -180.0 } else { 180.0 });
        none("random set points", turn, &|k| ((k / 10 * 7919) % 360) as f64 - 180.0);
        none("a motor that is on or off", None, &|k| if k / 50 % 2 == 0 { 0.0 } else { 255.0 });
        none("a sine", turn, &|k| 179.0 * (0.1 * k as f64).sin());
    }

    #[test]
    fn quaternions_that_change_their_sign_are_found_and_turned() {
        let half = |k: usize| 0.01 * k as f64;
        let sign = |k: usize| if (100..150).contains(&k) { -1.0 } else { 1.0 };
        let column = |of: &dyn Fn(f64) -> f64| (0..200).map(|k| sign(k) * of(half(k))).collect::<Vec<f64>>();
        let mut four = [column(&f64::cos), column(&f64::sin), column(&|_| 0.0), column(&|_| 0.0)];
        assert_eq!(flips(four.each_ref().map(Vec::as_slice)), [100, 150]);
        align_signs(&mut four);
        assert!((0..200).all(|k| (four[0][k] - half(k).cos()).abs() < 1e-12));
        assert_eq!(flips([&four[1], &four[1], &four[1], &four[1]]), [0; 0], "no unit quaternion");
    }
}
