//! Effects as this test plants them: in continuous time, by formulas of its own.
//!
//! | effect   | q̃                                                                     |
//! | dead time | q(t − Δ)                                                             |
//! | lag       | τ dq̃/dt = q − q̃                                                     |
//! | creep     | q + c (L − q), τ dL/dt = q − L                                        |
//! | friction  | f z, dz/dq = (1 − z sgn dq/dt)/δ                                      |
//! | backlash  | a carriage that a slider of play ±w pushes along                     |
//! | soft play | the mean of three of different width                                  |
//! | heat      | q (1 + g h), τ dh/dt = q² − h                                         |
//! | motor     | τ dv/dt = q − v − w sgn v, which rests at 0 while |q| ≤ w              |
//! | pendulum  | z̈ + 2ζω ż + ω² (sin z + f sgn ż) = ω² q                               |
//! | heater    | τ dT/dt = q² − T − T²                                                 |
//! | coil      | τ di/dt = (q − i) (1 + (i/s)²)                                        |
//!
//! What remembers starts settled, and is integrated in a hundred small steps between two samples.

use crate::motion::Motion;

/// Small steps between two samples.
const SMALL: usize = 100;

pub fn delayed(time: &[f64], motion: &Motion, delay: f64) -> Vec<f64> {
    time.iter().map(|t| motion.at(t - delay)).collect()
}

pub fn lagged(time: &[f64], motion: &Motion, tau: f64) -> Vec<f64> {
    integrated(time, motion, motion.at(time[0]), |state, from, to, h| {
        // Exact for the mean of both ends.
        let mean = 0.5 * (from + to);
        mean + (state - mean) * (-h / tau).exp()
    })
}

pub fn creeping(time: &[f64], motion: &Motion, share: f64, tau: f64) -> Vec<f64> {
    let late = lagged(time, motion, tau);
    time.iter().zip(late).map(|(t, late)| motion.at(*t) + share * (late - motion.at(*t))).collect()
}

pub fn loose(time: &[f64], motion: &Motion, width: f64) -> Vec<f64> {
    integrated(time, motion, motion.at(time[0]), |state, _, q, _| pushed(state, q, width))
}

/// Play whose sides give way: of three plays of different width, a third each.
pub fn soft(time: &[f64], motion: &Motion, width: f64) -> Vec<f64> {
    let parts = [0.6, 1.0, 1.4].map(|share| loose(time, motion, share * width));
    (0..time.len()).map(|t| parts.iter().map(|part| part[t]).sum::<f64>() / 3.0).collect()
}

/// A play, and behind it an arm that creeps.
pub fn loose_and_creeping(time: &[f64], motion: &Motion, width: f64, share: f64, tau: f64) -> Vec<f64> {
    let start = motion.at(time[0]);
    let states = integrated(time, motion, [start; 2], |[played, late], _, q, h| {
        let now = pushed(played, q, width);
        let mean = 0.5 * (played + now);
        [now, mean + (late - mean) * (-h / tau).exp()]
    });
    states.into_iter().map(|[played, late]| played + share * (late - played)).collect()
}

/// A muscle that its own load heats, and whose gain changes with the heat; cold at first.
pub fn heated(time: &[f64], motion: &Motion, gain: f64, tau: f64) -> Vec<f64> {
    let heat = integrated(time, motion, 0.0, |heat, from, to, h| {
        let mean = 0.5 * (from * from + to * to);
        mean + (heat - mean) * (-h / tau).exp()
    });
    time.iter().zip(heat).map(|(t, heat)| motion.at(*t) * (1.0 + gain * heat)).collect()
}

/// z of dry friction with presliding length δ, in [−1, 1].
pub fn rubbing(time: &[f64], motion: &Motion, presliding: f64) -> Vec<f64> {
    integrated(time, motion, 0.0, |z, from, to, _| {
        let way = to - from;
        z + (way - z * way.abs()) / presliding
    })
}

/// Speed of a motor with dry friction behind its voltage.
pub fn sticking(time: &[f64], motion: &Motion, tau: f64, friction: f64) -> Vec<f64> {
    integrated(time, motion, 0.0f64, |speed, from, to, h| {
        let pull = 0.5 * (from + to);
        let rubbed =
            if speed == 0.0 { pull - pull.clamp(-friction, friction) } else { pull - friction * speed.signum() };
        let next = rubbed + (speed - rubbed) * (-h / tau).exp();
        if next * speed < 0.0 { 0.0 } else { next }
    })
}

/// Angle of a pendulum that a torque swings in a bearing with dry friction, from rest.
pub fn swinging(time: &[f64], motion: &Motion, [period, damping, friction]: [f64; 3]) -> Vec<f64> {
    let omega = std::f64::consts::TAU / period;
    let states = integrated(time, motion, [motion.at(time[0]).asin(), 0.0], |[angle, speed], from, to, h| {
        let pull = omega * omega * (0.5 * (from + to) - angle.sin());
        let free = speed + h * (pull - 2.0 * damping * omega * speed);
        let speed = free - free.clamp(-h * omega * omega * friction, h * omega * omega * friction);
        [angle + h * speed, speed]
    });
    states.into_iter().map(|[angle, _]| angle).collect()
}

/// A lag behind a function of the input.
pub fn lagged_after(time: &[f64], motion: &Motion, tau: f64, of: impl Fn(f64) -> f64) -> Vec<f64> {
    integrated(time, motion, of(motion.at(time[0])), |state, from, to, h| {
        let mean = 0.5 * (of(from) + of(to));
        mean + (state - mean) * (-h / tau).exp()
    })
}

/// Temperature above the surroundings, by Heun's method.
pub fn warmed(time: &[f64], motion: &Motion, tau: f64) -> Vec<f64> {
    let power = motion.at(time[0]).powi(2);
    let settled = 0.5 * ((1.0 + 4.0 * power).sqrt() - 1.0);
    integrated(time, motion, settled, |state, from, to, h| {
        let rate = |q: f64, warm: f64| (q * q - warm - warm * warm) / tau;
        let first = rate(from, state);
        state + 0.5 * h * (first + rate(to, state + h * first))
    })
}

/// Current of a coil whose inductance falls to a half at the current `saturated`.
pub fn charging(time: &[f64], motion: &Motion, tau: f64, saturated: f64) -> Vec<f64> {
    integrated(time, motion, motion.at(time[0]), |current, from, to, h| {
        let (mean, tau) = (0.5 * (from + to), tau / (1.0 + (current / saturated).powi(2)));
        mean + (current - mean) * (-h / tau).exp()
    })
}

/// Level of the lower of two vessels in a row, by the midpoint rule: each empties by a rate times the root of its level, and fills by the
/// same of the one above, and a third of what that one spills. The motion, and 1.05, is the root of the level at which the inflow would hold
/// the upper one; neither rises above `brim`. At rest at first.
pub fn emptied(time: &[f64], motion: &Motion, rates: [f64; 2], brim: f64) -> Vec<f64> {
    let flow = |q: f64| (q + 1.05).max(0.0);
    let inflow = flow(motion.at(time[0]));
    let passed = inflow.min(brim.sqrt());
    let start = [passed, passed + (inflow - passed) / 3.0].map(|flow| flow.powi(2).min(brim));
    let levels = integrated(time, motion, start, |[upper, lower], from, to, h| {
        let speeds = |[upper, lower]: [f64; 2], above: f64| {
            let is_full = upper >= brim;
            let [upper, lower] = [upper, lower].map(|level: f64| level.max(0.0).sqrt());
            let spilt = if is_full { (flow(above) - upper).max(0.0) } else { 0.0 };
            [rates[0] * (flow(above) - upper), rates[1] * (upper + spilt / 3.0 - lower)]
        };
        let first = speeds([upper, lower], from);
        let middle = speeds([upper + 0.5 * h * first[0], lower + 0.5 * h * first[1]], 0.5 * (from + to));
        [(upper + h * middle[0]).min(brim), (lower + h * middle[1]).min(brim)]
    });
    levels.into_iter().map(|[_, lower]| lower).collect()
}

/// The motion behind two equal lags in a row, by the midpoint rule.
pub fn twice_lagged(time: &[f64], motion: &Motion, tau: f64) -> Vec<f64> {
    let states = integrated(time, motion, [motion.at(time[0]); 2], |[first, second], from, to, h| {
        let middle = first + 0.5 * h * (from - first) / tau;
        let next = first + h * (0.5 * (from + to) - middle) / tau;
        let halfway = second + 0.5 * h * (first - second) / tau;
        [next, second + h * (middle - halfway) / tau]
    });
    states.into_iter().map(|[_, second]| second).collect()
}

fn pushed(state: f64, q: f64, width: f64) -> f64 {
    if (q - state).abs() > width { q - width * (q - state).signum() } else { state }
}

/// States at the samples, from `start`; `next` takes a state from one end of a small step (of h seconds) to the other.
fn integrated<S: Copy>(time: &[f64], motion: &Motion, start: S, next: impl Fn(S, f64, f64, f64) -> S) -> Vec<S> {
    let mut state = start;
    let mut all = vec![state];
    for pair in time.windows(2) {
        let h = (pair[1] - pair[0]) / SMALL as f64;
        let mut from = motion.at(pair[0]);
        for k in 1..=SMALL {
            let to = motion.at(pair[0] + h * k as f64);
            state = next(state, from, to, h);
            from = to;
        }
        all.push(state);
    }
    all
}
