//! Plan of a recording: rate, trials, pace of the inputs, clocks, encoders.
//!
//! | drawn | range |
//! | --- | --- |
//! | rate | 20–1000 Hz, slow rigs 0.05–1 Hz |
//! | development trials | 1–20, each order of magnitude alike; 1–3 held out |
//! | stroke | 25–100 samples, at most a sixth of a trial; 50–150 where rates matter |
//! | clock | samples up to 15 % of a period off with right stamps, or stamps up to 5 % off (2 % where rates matter), or neither |
//! | encoder | 10–16 bits over the range (13–17 where rates matter), noise of up to a step |
//! | noise | 0.3–4 % of the output's standard deviation (1–6 % where rates matter), quantised at 0.05–1 of it |
//!
//! Rates matter where the output is a torque: encoders of motors are finer than those of tanks, and torques noisier.

use super::draw::Draw;
use super::motion::Style;
use crate::role::Role;

/// Errors of the clock, in periods (standard deviation).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clock {
    /// Samples are taken early or late, and stamped so.
    Samples(f64),
    /// Samples are regular, stamps are not.
    Stamps(f64),
}

/// The plan of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Sampling period, s.
    pub step: f64,
    /// Time of a usual stroke, s.
    pub pace: f64,
    /// Role and duration (s) of each trial.
    pub trials: Vec<(Role, f64)>,
    /// Form of the inputs.
    pub style: Style,
    /// Clock of the recording.
    pub clock: Clock,
    /// Number of bits of an encoder over the range of its input.
    pub bits: i32,
    /// Noise of an encoder in its steps.
    pub encoder: f64,
    /// Noise of the output over its standard deviation.
    pub noise: f64,
    /// Step of the output over its noise.
    pub digit: f64,
}

/// Subject of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A response within seconds.
    Fast,
    /// A response within minutes.
    Slow,
    /// A torque, in which rates and accelerations matter.
    Torque,
}

/// Samples of all development trials together.
const SAMPLES: [f64; 2] = [2400.0, 5000.0];

impl Plan {
    /// Draws a plan.
    pub fn new(subject: Subject, draw: &mut Draw) -> Self {
        let rate = if subject == Subject::Slow { draw.scale(0.05, 1.0) } else { draw.scale(20.0, 1000.0) };
        let torque = subject == Subject::Torque;
        let step = 1.0 / rate;
        let many = draw.scale(1.0, 20.99).floor().clamp(1.0, 20.0);
        let samples = (draw.scale(SAMPLES[0], SAMPLES[1]) / many).max(if torque { 320.0 } else { 200.0 }).round();
        let stroke = if torque { draw.scale(50.0, 150.0) } else { draw.scale(25.0, 100.0) }.min(samples / 6.0);
        let held = 1 + usize::from(many >= 4.0) + usize::from(many >= 10.0);
        let short = if many < 2.0 { 0.4 } else { 1.0 };
        let mut trials = vec![(Role::Development, samples * step); many as usize];
        trials.extend(vec![(Role::HeldOut, short * samples * step); held]);
        let clock = match draw.index(3) {
            0 => Clock::Samples(draw.between(0.02, 0.15)),
            1 => Clock::Stamps(draw.between(0.005, if torque { 0.02 } else { 0.05 })),
            _ => Clock::Samples(0.0),
        };
        Self {
            step,
            pace: stroke * step,
            trials,
            style: if draw.happens(0.6) { Style::Strokes } else { Style::Sines },
            clock,
            bits: draw.index(if torque { 5 } else { 7 }) as i32 + if torque { 13 } else { 10 },
            encoder: draw.between(0.0, 1.0),
            noise: if torque { draw.scale(0.01, 0.06) } else { draw.scale(0.003, 0.04) },
            digit: draw.scale(0.05, 1.0),
        }
    }

    /// Returns the sampling times of a trial, and its time stamps, s.
    pub fn clock(&self, duration: f64, draw: &mut Draw) -> (Vec<f64>, Vec<f64>) {
        let many = (duration / self.step).round() as usize + 1;
        let (early, wrong) = match self.clock {
            Clock::Samples(share) => (share, 0.0),
            Clock::Stamps(share) => (0.0, share),
        };
        // Less than half a period, so that time goes on.
        let mut off = |share: f64| self.step * (share * draw.normal()).clamp(-0.4, 0.4);
        let taken: Vec<f64> = (0..many).map(|k| if k == 0 { 0.0 } else { self.step * k as f64 + off(early) }).collect();
        let stamps = taken.iter().map(|t| if *t == 0.0 { 0.0 } else { t + off(wrong) }).collect();
        (taken, stamps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plans_keep_within_their_ranges_and_clocks_go_on() {
        let mut counts = std::collections::BTreeSet::new();
        for seed in 0..200 {
            for subject in [Subject::Fast, Subject::Slow, Subject::Torque] {
                let mut draw = Draw::new(9, seed, 0);
                let plan = Plan::new(subject, &mut draw);
                let rate = 1.0 / plan.step;
                assert!(if subject == Subject::Slow {
                    (0.05..=1.0).contains(&rate)
                } else {
                    (20.0..=1000.0).contains(&rate)
                });
                counts.insert(plan.trials.iter().filter(|(role, _)| *role == Role::Development).count());
                assert!(plan.trials.iter().all(|(_, duration)| *duration >= 2.0 * plan.pace));
                let (taken, stamps) = plan.clock(plan.trials[0].1, &mut draw);
                assert!(taken.windows(2).chain(stamps.windows(2)).all(|pair| pair[1] > pair[0]));
                assert_eq!(taken == stamps, matches!(plan.clock, Clock::Samples(_)));
            }
        }
        assert!(
            counts.contains(&1) && counts.contains(&20) && counts.iter().all(|n| (1..=20).contains(n)),
            "{counts:?}"
        );
    }
}
