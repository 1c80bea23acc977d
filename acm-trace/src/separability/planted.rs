//! One effect of a given size in outputs that the nominal model explains exactly.
//!
//! Its sizes are scaled together from a typical initial guess; its shapes stay as in that guess.

use std::ops::Range;

use acm_core::effects::ParameterSpec;
use acm_core::effects::instance::Instance;
use nalgebra::DVector;

use super::displacement::displacement;
use super::trials::Trials;

/// An effect of the requested size, or the largest that its bounds allow.
#[derive(Debug, Clone)]
pub struct Planted {
    /// Effect and carrier.
    pub instance: Instance,
    /// Parameters θ.
    pub theta: Vec<f64>,
    /// Displacement of the weighted outputs of all trials [NM], zero where a sample does not count.
    pub displacement: DVector<f64>,
    /// Root mean square of the displacement at its typical size.
    pub strength: f64,
    /// Root mean square that was reached, as a share of the requested one.
    reached: f64,
}

/// Share of the requested size below which an effect leaves no trace, within its bounds.
const TRACE: f64 = 1e-3;

/// Most steps of the search for the size, and its tolerance.
const STEPS: (usize, f64) = (40, 0.005);

/// Largest size, in typical ones.
const LARGEST: f64 = 1e4;

impl Planted {
    /// Scales the effect to `size`, the root mean square of the displacement of the `reported` outputs, weighted.
    pub fn new(trials: &Trials, instance: &Instance, size: f64, reported: &Range<usize>) -> Self {
        let starts = instance.initial_guesses(&trials.prepared.case.rig);
        let start = starts[starts.len() / 2].clone();
        let rms = |scale: f64| {
            let theta = scaled(instance.parameters(), &start, scale);
            root_mean_square(trials, &displacement(trials, instance, &theta), reported)
        };
        let strength = rms(1.0);
        let scale = solve(rms, strength, size);
        let theta = scaled(instance.parameters(), &start, scale);
        let displacement = displacement(trials, instance, &theta);
        let reached = root_mean_square(trials, &displacement, reported) / size;
        Self { instance: instance.clone(), theta, displacement, strength, reached }
    }

    /// Returns whether these trials show the effect at all.
    pub fn is_seen(&self) -> bool {
        self.reached.is_finite() && self.reached > TRACE
    }
}

/// Returns θ with its sizes at `scale` times those of the start.
fn scaled(specs: &[ParameterSpec], start: &[f64], scale: f64) -> Vec<f64> {
    let of = |(spec, value): (&ParameterSpec, &f64)| {
        if spec.may_vary { spec.inside(spec.neutral + scale * (value - spec.neutral)) } else { *value }
    };
    specs.iter().zip(start).map(of).collect()
}

/// Returns the scale that reaches `size`: first doubled or guessed until it lies between two, then by false position.
fn solve(rms: impl Fn(f64) -> f64, at_one: f64, size: f64) -> f64 {
    let (mut low, mut high) = ((0.0, 0.0), (1.0, at_one));
    while high.1 < size {
        if high.0 >= LARGEST {
            return high.0;
        }
        low = high;
        let guess = if high.1 > 0.0 { 1.1 * size / high.1 } else { 4.0 };
        let scale = (high.0 * guess.clamp(1.3, 4.0)).min(LARGEST);
        high = (scale, rms(scale));
    }
    for step in 0..STEPS.0 {
        if (high.1 - size).abs() < STEPS.1 * size {
            break;
        }
        // Every third step halves, so that a curved function cannot keep one end fixed.
        let share = if step % 3 == 2 { 0.5 } else { ((size - low.1) / (high.1 - low.1)).clamp(0.02, 1.0) };
        let middle = low.0 + share * (high.0 - low.0);
        let there = (middle, rms(middle));
        if there.1 < size * (1.0 - STEPS.1) { low = there } else { high = there }
    }
    high.0
}

fn root_mean_square(trials: &Trials, displacement: &DVector<f64>, reported: &Range<usize>) -> f64 {
    let width = trials.prepared.weight.len();
    let rows = displacement.iter().enumerate().filter(|(row, _)| reported.contains(&(row % width)));
    (rows.map(|(_, d)| d * d).sum::<f64>() / trials.counted().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracles: curves whose inverse is known, one of them with a dead zone and one that saturates.
    #[test]
    fn the_size_is_found_on_bent_curves() {
        let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
        near(solve(|s| 0.3 * s, 0.3, 3.0), 10.0);
        near(solve(|s| s * s, 1.0, 0.01), 0.1);
        near(solve(|s| (s - 2.0).max(0.0), 0.0, 1.0), 3.0);
        near(solve(f64::sqrt, 1.0, 0.1), 0.01);
        assert!(solve(|s| s.min(2.0), 1.0, 3.0) >= LARGEST);
    }
}
