//! Runs of samples without a gap, and the step within them.
//!
//! ```text
//! gap:  Δt > Δt_max,   Δt_max as given, or max(0.5 s, 5 · usual step) to two digits, since time stamps jitter
//! ```

use std::ops::Range;

/// Number of usual steps that a gap exceeds.
pub(crate) const GAP_STEPS: f64 = 5.0;

/// A step in time up to this one is not a gap, s.
const SHORTEST_GAP: f64 = 0.5;

/// Returns the longest step in time that is not a gap, s: as given, or else from the usual step of the samples, s.
pub fn max_gap(given: Option<f64>, usual_step: f64) -> f64 {
    let steps = GAP_STEPS * usual_step;
    given.unwrap_or_else(|| format!("{steps:.1e}").parse().unwrap_or(steps).max(SHORTEST_GAP))
}

/// Runs of samples whose steps are at most `max_gap` (a billionth longer, for rounding of time stamps).
pub fn segments(time: &[f64], max_gap: f64) -> Vec<Range<usize>> {
    let limit = max_gap * (1.0 + 1e-9);
    let mut segments = Vec::new();
    let mut start = 0;
    for t in 1..=time.len() {
        if t == time.len() || time[t] - time[t - 1] > limit {
            segments.push(start..t);
            start = t;
        }
    }
    segments
}

/// Returns the median of all steps, s; 0 of fewer than two samples.
pub fn usual_step(time: &[f64]) -> f64 {
    median_step(time, std::slice::from_ref(&(0..time.len())))
}

/// Median step within segments, s; 0 where no segment has two samples. Of an even number, the lower middle one.
pub fn median_step(time: &[f64], segments: &[Range<usize>]) -> f64 {
    let within = segments.iter().flat_map(|s| s.clone().skip(1));
    let mut steps: Vec<f64> = within.map(|t| time[t] - time[t - 1]).collect();
    if steps.is_empty() {
        return 0.0;
    }
    let middle = (steps.len() - 1) / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. Steps 1, 1, 4 (a gap), 2, 1; the median of 1, 1, 2, 1 is 1.
    #[test]
    fn a_gap_starts_a_segment() {
        let time = [10.0, 11.0, 12.0, 16.0, 18.0, 19.0];
        let parts = segments(&time, 2.0);
        assert_eq!(parts, [0..3, 3..6]);
        assert_eq!(median_step(&time, &parts), 1.0);
    }

    /// Oracle: by hand.
    #[test]
    fn a_gap_exceeds_five_usual_steps_and_half_a_second() {
        assert_eq!([0.02, 0.1004, 0.0].map(|step| max_gap(None, step)), [0.5; 3]);
        assert_eq!(max_gap(None, usual_step(&[0.0, 1.003, 2.006, 9.0])), 5.0);
        assert_eq!(max_gap(Some(0.3), 1.0), 0.3);
    }

    #[test]
    fn a_step_of_the_limit_is_no_gap_even_after_rounding() {
        assert_eq!(segments(&[0.0, 0.1, 0.2, 0.1 + 0.2], 0.1), [0..4]);
        assert_eq!(segments(&[], 0.5), Vec::<Range<usize>>::new());
        assert_eq!(segments(&[3.0], 0.5), [0..1]);
    }
}
