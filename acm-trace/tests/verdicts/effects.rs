//! Effects as this test plants them: in continuous time, by formulas of its own.
//!
//! | effect   | q̃                                                                     |
//! | dead time | q(t − Δ)                                                             |
//! | lag       | τ dq̃/dt = q − q̃                                                     |
//! | creep     | q + c (L − q), τ dL/dt = q − L                                        |
//! | backlash  | a carriage that a slider of play ±w pushes along                     |
//! | soft play | the same with a spring between them: dq̃/dq grows as the play closes |
//!
//! What remembers is integrated in a hundred small steps between two samples.

use crate::motion::Motion;

/// Small steps between two samples.
const SMALL: usize = 100;

pub fn delayed(time: &[f64], motion: &Motion, delay: f64) -> Vec<f64> {
    time.iter().map(|t| motion.at(t - delay)).collect()
}

pub fn lagged(time: &[f64], motion: &Motion, tau: f64) -> Vec<f64> {
    integrated(time, motion, |state, q, h| state + h / tau * (q - state))
}

pub fn creeping(time: &[f64], motion: &Motion, share: f64, tau: f64) -> Vec<f64> {
    let late = lagged(time, motion, tau);
    time.iter().zip(late).map(|(t, late)| motion.at(*t) + share * (late - motion.at(*t))).collect()
}

pub fn loose(time: &[f64], motion: &Motion, width: f64) -> Vec<f64> {
    integrated(time, motion, |state, q, _| if (q - state).abs() > width { q - width * (q - state).signum() } else { state })
}

/// Play whose sides give way: of three plays of different width, a third each.
pub fn soft(time: &[f64], motion: &Motion, width: f64) -> Vec<f64> {
    let parts = [0.6, 1.0, 1.4].map(|share| loose(time, motion, share * width));
    (0..time.len()).map(|t| parts.iter().map(|part| part[t]).sum::<f64>() / 3.0).collect()
}

fn integrated(time: &[f64], motion: &Motion, next: impl Fn(f64, f64, f64) -> f64) -> Vec<f64> {
    let mut state = motion.at(time[0]);
    let mut all = vec![state];
    for pair in time.windows(2) {
        let h = (pair[1] - pair[0]) / SMALL as f64;
        for k in 1..=SMALL {
            state = next(state, motion.at(pair[0] + h * k as f64), h);
        }
        all.push(state);
    }
    all
}
