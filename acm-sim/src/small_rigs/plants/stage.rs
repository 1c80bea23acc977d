//! Stages of a chain from command to measurement, on the knots of a drive.
//!
//! | stage | equation | values |
//! | --- | --- | --- |
//! | delay | z(t) = u(t − T) | T |
//! | lag | τ ż = u − z | τ |
//! | spring | z̈ = (2π/P)²·(u − z − h z³) − 2ζ(2π/P)·ż | P, ζ (, h) |
//! | play | z = mean of three plays of half-width 0.9, 1 and 1.1 × (w + g·(c − c₀)) | w (, g) |
//! | spread | z = u + a·mean of (P_{kw/5}(u) − u), k = 1 … 5 | a, w |
//! | dead zone | z = u − w·r₈(u/w),  r_n(x) = x/(1 + ǀxǀⁿ)^(1/n) | w |
//! | saturation | z = l·r₁₆(u/l),  l = limit − cut | cut |
//! | bend | z = u + a u² + b u³ | a, b |
//! | outflow | θ ż = b·u − √z (Torricelli) | θ, b |
//! | map | z = g₀ + g₁ u + g₂ u² | g |
//! | context | z = u + k·(c − c₀) | k |
//!
//! `P_r` is the play of half-width r, started in its middle. Lag and linear spring are exact for inputs that are
//! straight between knots, the others step by [`crate::small_rigs::plants::ode`]. Each stage begins at rest.

use crate::small_rigs::drive::{Drive, interpolate};
use crate::small_rigs::plants::ode;

/// One stage. Values that no oracle fits are fields of the variant.
#[derive(Clone, Debug, PartialEq)]
pub enum Stage {
    /// Transport delay.
    Delay,
    /// First-order lag.
    Lag,
    /// Linear second-order system.
    Second,
    /// Second-order system with a hardening spring.
    Hardening,
    /// Play; its width depends on the first context around a centre where there is one.
    Play {
        /// Middle of the context.
        centre: Option<f64>,
    },
    /// Distribution of many plays.
    Spread,
    /// Dead zone around zero.
    DeadZone,
    /// Saturation at a limit.
    Saturation {
        /// Largest input.
        limit: f64,
    },
    /// Cubic map.
    Bend,
    /// Tank with a hole.
    Outflow,
    /// Static map of this degree.
    Map {
        /// Degree: 0 (offset alone), 1 or 2.
        degree: usize,
    },
    /// A term of the first context.
    Context {
        /// Middle of the context.
        centre: f64,
    },
}

impl Stage {
    /// Applies the stage to a signal on the knots, in place; `values` begin with its own.
    pub fn act(&self, values: &[f64], drive: &Drive, signal: &mut Vec<f64>) {
        let time = &drive.time;
        match self {
            Stage::Delay => {
                *signal = time.iter().map(|t| interpolate(time, signal, t - values[0])).collect();
            }
            Stage::Lag => ode::lag(time, signal, values[0]),
            Stage::Second => ode::spring(time, signal, values[0], values[1]),
            Stage::Hardening => ode::hardening(time, signal, [values[0], values[1], values[2]]),
            Stage::Play { centre } => {
                let width = |k: usize| match centre {
                    Some(centre) => (values[0] + values[1] * (drive.contexts[0][k] - centre)).max(0.0),
                    None => values[0],
                };
                let parts = [0.9, 1.0, 1.1].map(|share| play(signal, |k| share * width(k)));
                *signal = (0..signal.len()).map(|k| parts.iter().map(|part| part[k]).sum::<f64>() / 3.0).collect();
            }
            Stage::Spread => {
                let parts = [0.2, 0.4, 0.6, 0.8, 1.0].map(|share| play(signal, |_| share * values[1]));
                let mean = |k: usize| parts.iter().map(|part| part[k]).sum::<f64>() / 5.0;
                *signal = (0..signal.len()).map(|k| signal[k] + values[0] * (mean(k) - signal[k])).collect();
            }
            Stage::DeadZone if values[0] > 0.0 => {
                signal.iter_mut().for_each(|u| *u -= values[0] * rounded(*u / values[0], 8));
            }
            Stage::Saturation { limit } if values[0] > 0.0 => {
                let limit = (limit - values[0]).max(1e-3 * limit);
                signal.iter_mut().for_each(|u| *u = limit * rounded(*u / limit, 16));
            }
            Stage::DeadZone | Stage::Saturation { .. } => {}
            Stage::Bend => signal.iter_mut().for_each(|u| *u += *u * *u * (values[0] + values[1] * *u)),
            Stage::Outflow => ode::outflow(time, signal, values[0], values[1]),
            Stage::Map { degree: 0 } => signal.iter_mut().for_each(|u| *u += values[0]),
            Stage::Map { degree } => signal.iter_mut().for_each(|u| {
                let square = if *degree > 1 { values[2] } else { 0.0 };
                *u = values[0] + *u * (values[1] + square * *u);
            }),
            Stage::Context { centre } => {
                signal.iter_mut().zip(&drive.contexts[0]).for_each(|(u, c)| *u += values[0] * (c - centre));
            }
        }
    }
}

/// Computes x/(1 + |x|ⁿ)^(1/n), without overflow.
fn rounded(x: f64, n: i32) -> f64 {
    if x.abs() > 1e6 { x.signum() } else { x / (1.0 + x.abs().powi(n)).powf(1.0 / f64::from(n)) }
}

/// Follows a signal within a play, and not what is no number: a fit may try a resonance that runs away.
fn play(signal: &[f64], width: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut held = signal[0];
    let follow = |(k, u): (usize, &f64)| {
        held = held.max(u - width(k)).min(u + width(k));
        held
    };
    signal.iter().enumerate().map(follow).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drive(time: Vec<f64>, context: f64) -> Drive {
        let contexts = vec![vec![context; time.len()]];
        Drive { asked: time.clone(), time, actuators: vec![], contexts, motion: [const { vec![] }; 3] }
    }

    fn after(stage: &Stage, values: &[f64], signal: &[f64]) -> Vec<f64> {
        let mut signal = signal.to_vec();
        stage.act(values, &drive((0..signal.len()).map(|k| k as f64).collect(), 2.0), &mut signal);
        signal
    }

    fn near(got: &[f64], wanted: &[f64]) -> bool {
        got.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-9) && got.len() == wanted.len()
    }

    /// Oracle: hand arithmetic.
    #[test]
    fn static_stages_by_hand() {
        assert!(near(&after(&Stage::Bend, &[0.5, 0.1], &[2.0]), &[2.0 + 2.0 + 0.8]));
        assert!(near(&after(&Stage::Map { degree: 2 }, &[1.0, 2.0, 3.0], &[2.0]), &[17.0]));
        assert!(near(&after(&Stage::Context { centre: 0.5 }, &[3.0], &[1.0]), &[5.5]));
        assert!(near(&after(&Stage::Delay, &[0.5], &[0.0, 1.0, 3.0]), &[0.0, 0.5, 2.0]));
        // Far from its edge, a rounded dead zone takes its width, and a rounded saturation gives its limit.
        assert!((after(&Stage::DeadZone, &[0.2], &[5.0])[0] - 4.8).abs() < 1e-6);
        assert!(after(&Stage::DeadZone, &[0.2], &[0.05])[0].abs() < 1e-5);
        assert!((after(&Stage::Saturation { limit: 2.0 }, &[0.5], &[9.0])[0] - 1.5).abs() < 1e-6);
        assert!((after(&Stage::Saturation { limit: 2.0 }, &[0.5], &[0.7])[0] - 0.7).abs() < 1e-5);
    }

    /// Oracle: after a long way each play lags by its half-width, whose mean is the width; back by twice that.
    #[test]
    fn plays_by_hand() {
        let there = after(&Stage::Play { centre: None }, &[0.1], &[0.0, 1.0, 0.95, 0.0]);
        assert!(near(&there, &[0.0, 0.9, 0.9, 0.1]), "{there:?}");
        let wide = after(&Stage::Play { centre: Some(1.0) }, &[0.1, 0.05], &[0.0, 1.0]);
        assert!(near(&wide, &[0.0, 0.85]), "{wide:?}");
        // Half of the way through plays of 0.2 … 1.0 of 0.1, whose mean is 0.06.
        let spread = after(&Stage::Spread, &[0.5, 0.1], &[0.0, 1.0]);
        assert!(near(&spread, &[0.0, 1.0 - 0.5 * 0.06]), "{spread:?}");
    }

    /// Oracle: by hand. A fit of an oscillator may come to values for which it is no number.
    #[test]
    fn a_play_stays_where_its_signal_is_no_number() {
        let after = after(&Stage::Play { centre: None }, &[0.1], &[0.0, 1.0, f64::NAN, 0.0]);
        assert!(near(&after, &[0.0, 0.9, 0.9, 0.1]), "{after:?}");
    }

    /// Oracle: neutral values leave a signal as it is.
    #[test]
    fn neutral_stages_do_nothing() {
        let signal = [0.3, 0.7, -0.4, 0.1];
        for (stage, values) in [
            (Stage::Delay, vec![0.0]),
            (Stage::Lag, vec![0.0]),
            (Stage::Second, vec![0.0, 0.7]),
            (Stage::Hardening, vec![0.0, 0.7, 0.0]),
            (Stage::Play { centre: Some(2.0) }, vec![0.0, 0.0]),
            (Stage::Spread, vec![0.0, 0.1]),
            (Stage::DeadZone, vec![0.0]),
            (Stage::Saturation { limit: 1.0 }, vec![0.0]),
            (Stage::Bend, vec![0.0, 0.0]),
        ] {
            assert!(near(&after(&stage, &values, &signal), &signal), "{stage:?}");
        }
    }
}
