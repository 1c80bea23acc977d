//! Times that a recording resolves: from its sampling step to a third of its longest trial.
//!
//! | what            | from       | to       |
//! | bounds          | Δt/5       | T/3      |
//! | bounds of what may only begin | Δt/5 | T |
//! | bounds of periods of what follows the actuators | 0 | T |
//! | grid of times   | Δt         | T/3      |
//! | grid of periods, of vibrations | 4 Δt | T/3 |
//! | bounds of windows | 0        | T/25     |
//! | grid of windows | 4 Δt       | T/25     |
//!
//! `Δt` is the median time between samples and `T` the longest trial, both s ([`Rig`]). Anything faster than Δt/5 leaves no
//! trace between two samples; anything slower than T/3 cannot be told from a drift.

use super::{ParameterSpec, Rig};

/// Ratio of neighbours on the grid of times: a misfit halves well within it.
const RATIO: f64 = 1.6;

/// Ratio of neighbours on the grid of periods, whose valleys are narrower.
const PERIOD_RATIO: f64 = 1.35;

/// Most points of the grid of times.
const MOST: usize = 24;

/// Most points of the grid of periods.
const MOST_PERIODS: usize = 48;

/// Ratio of neighbours on the grid of vibrations: as wide as the resonance of a damping of 0.04.
const VIBRATION_RATIO: f64 = 1.08;

/// Most points of the grid of vibrations.
const MOST_VIBRATIONS: usize = 140;

/// Windows to start from.
const WINDOWS: usize = 5;

/// Length of the longest trial, s; never 0, so that rates are finite.
pub fn trial(rig: &Rig) -> f64 {
    rig.duration.max(rig.step).max(1e-9)
}

/// Median time between samples, s; never 0, and at most a sixth of the trial.
pub fn step(rig: &Rig) -> f64 {
    rig.step.max(1e-6 * trial(rig)).min(trial(rig) / 6.0)
}

/// Shortest time constant that leaves a trace, s.
pub fn shortest(rig: &Rig) -> f64 {
    0.2 * step(rig)
}

/// Longest resolvable time constant, s.
pub fn longest(rig: &Rig) -> f64 {
    trial(rig) / 3.0
}

/// A typical time constant, s: the geometric middle of the grid.
pub fn typical(rig: &Rig) -> f64 {
    (step(rig) * longest(rig)).sqrt()
}

/// A time that makes the effect: silent at 0.
pub fn size(rig: &Rig, name: &str) -> ParameterSpec {
    ParameterSpec::size(name, "s", typical(rig)).within(0.0, longest(rig))
}

/// A time that shapes the effect.
pub fn shape(rig: &Rig, name: &str) -> ParameterSpec {
    ParameterSpec::shape(name, "s", typical(rig), typical(rig)).within(shortest(rig), longest(rig))
}

/// A time that shapes what may only begin in a trial, such as creep: nothing else follows the actuators so.
pub fn slow(rig: &Rig, name: &str) -> ParameterSpec {
    shape(rig, name).within(shortest(rig), trial(rig))
}

/// Delays and time constants to start from, s.
pub fn grid(rig: &Rig) -> Vec<f64> {
    geometric(step(rig), longest(rig), RATIO, MOST)
}

/// Periods to start from, s.
pub fn periods(rig: &Rig) -> Vec<f64> {
    geometric((4.0 * step(rig)).min(0.8 * longest(rig)), longest(rig), PERIOD_RATIO, MOST_PERIODS)
}

/// Periods of light vibrations to start from, s.
pub fn vibrations(rig: &Rig) -> Vec<f64> {
    geometric((4.0 * step(rig)).min(0.8 * longest(rig)), longest(rig), VIBRATION_RATIO, MOST_VIBRATIONS)
}

/// Half a window by which a signal is differentiated, s: at 0 the nearest five samples ([`super::memory::Derivatives`]).
pub fn window(rig: &Rig) -> ParameterSpec {
    let widest = widest(rig);
    ParameterSpec::shape("window", "s", 0.0, (2.0 * step(rig) * widest).sqrt().min(widest)).within(0.0, widest)
}

/// Windows to start from, s.
pub fn windows(rig: &Rig) -> Vec<f64> {
    let (narrowest, widest) = (4.0 * step(rig), widest(rig));
    if narrowest < widest { spread(narrowest, widest, WINDOWS) } else { vec![widest] }
}

/// A 25th of the trial: a quartic in a wider window smooths the motion itself.
fn widest(rig: &Rig) -> f64 {
    trial(rig) / 25.0
}

/// From `low` to `high`, neighbours at no more than `ratio`, or at what `most` points allow.
fn geometric(low: f64, high: f64, ratio: f64, most: usize) -> Vec<f64> {
    let steps = ((high / low).ln() / ratio.ln()).ceil();
    spread(low, high, (steps as usize + 1).clamp(2, most))
}

/// `count` values from `low` to `high`, both included, evenly on a logarithmic scale.
pub fn spread(low: f64, high: f64, count: usize) -> Vec<f64> {
    let at = |k: usize| low * (high / low).powf(k as f64 / (count.max(2) - 1) as f64);
    (0..count).map(|k| if k + 1 == count { high } else { at(k) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rig(step: f64, duration: f64) -> Rig {
        Rig {
            actuators: vec![],
            contexts: vec![],
            outputs: vec![],
            throttle: None,
            altitude: None,
            payload: None,
            carried: false,
            arm: None,
            step,
            duration,
        }
    }

    /// Oracle: by hand: 2 s over 0.01 s is a ratio of 200, twelve steps of 1.6, so thirteen points from end to end.
    #[test]
    fn the_grid_spans_the_record() {
        let grid = grid(&rig(0.01, 6.0));
        assert_eq!((grid.len(), grid[0], grid[12]), (13, 0.01, 2.0));
        assert!(grid.windows(2).all(|pair| pair[1] / pair[0] < 1.6 && pair[1] / pair[0] > 1.5));
        assert_eq!(super::grid(&rig(1e-4, 1e4)).len(), 24, "no more than that on the longest record");
        let periods = periods(&rig(0.01, 6.0));
        assert_eq!((periods.len(), periods[0], periods[14]), (15, 0.04, 2.0));
    }

    /// A record in milliseconds, in hours, of two samples, or of none has times all the same.
    #[test]
    fn every_record_has_times() {
        for (step, duration) in [(1e-6, 1e-3), (60.0, 1e6), (0.1, 0.1), (0.0, 0.0), (0.0, 5.0)] {
            let rig = rig(step, duration);
            for grid in [grid(&rig), periods(&rig)] {
                assert!(grid.len() >= 2 && grid.windows(2).all(|pair| pair[0] < pair[1]), "{grid:?}");
                assert!(grid.iter().all(|t| *t >= shortest(&rig) && *t <= longest(&rig)), "{grid:?}");
            }
        }
    }
}
