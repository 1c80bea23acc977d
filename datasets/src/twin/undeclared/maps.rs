//! Mechanisms between servo and tendon without memory.
//!
//! | mechanism | equation |
//! | --- | --- |
//! | worn pulley | q̃ = (1 + γ)·q + ½·η·q² + o |
//! | warming servo | q̃ = q·(1 + γ·(1 − e^(−t/T)))   or   q̃ = q + o·ln(1 + t/T)/ln(1 + 50 s/T) |
//! | cam table | q̃₁ = q₁ + a·e(q₁/P), e periodic through twelve table entries, its first harmonic dominant |
//! | oblique tendons | q̃₁ = q₁ + c·sin(κ·q₂)/κ |
//! | yielding servo | q̃ = q/(1 + ǀq/lǀ⁸)^(1/8) |
//!
//! Angles in rad, times in s. Between table entries runs a cubic with central differences as slopes (Catmull & Rom 1974).

use super::course::Course;
use super::mechanism::Mechanism;
use super::memory::per_actuator;
use super::quiet::Rig;
use super::truth::Parameter;
use std::f64::consts::TAU;

/// Another gain and zero.
pub struct WornPulley {
    /// Change of gain, 1.
    pub gain: [f64; 2],
    /// Change of gain per angle, 1/rad.
    pub growth: f64,
    /// Offset, rad.
    pub offset: [f64; 2],
}

impl Mechanism for WornPulley {
    fn actuate(&self, _: &Course, actuators: &mut [Vec<f64>; 2]) {
        for (j, q) in actuators.iter_mut().enumerate() {
            for value in q {
                let angle = *value;
                *value += self.gain[j] * angle * (1.0 + 0.5 * self.growth * angle) + self.offset[j];
            }
        }
    }

    fn parameters(&self, _: &Rig) -> Vec<Parameter> {
        let mut all = per_actuator("gain", self.gain, "1", |gain| 0.01 + 0.2 * gain);
        all.extend(per_actuator("offset", self.offset, "rad", |offset| 0.015 + 0.2 * offset));
        all
    }

    fn formula(&self) -> String {
        let ([a, b], [c, d]) = (self.gain, self.offset);
        format!(
            "gain changed by {a:.4} and {b:.4}, growing by {:.3} per rad; zero by {c:.4} and {d:.4} rad",
            self.growth
        )
    }
}

/// Gain or zero that changes as the servo warms up.
pub struct Warming {
    /// Change of gain at the end of a long time, 1.
    pub gain: f64,
    /// Change of zero after 50 s, rad.
    pub zero: [f64; 2],
    /// Time of warming, s.
    pub time: f64,
}

impl Mechanism for Warming {
    fn actuate(&self, course: &Course, actuators: &mut [Vec<f64>; 2]) {
        for (j, q) in actuators.iter_mut().enumerate() {
            for (n, value) in q.iter_mut().enumerate() {
                let warm = course.time(n).max(0.0) / self.time;
                *value *= 1.0 + self.gain * -(-warm).exp_m1();
                *value += self.zero[j] * warm.ln_1p() / (50.0 / self.time).ln_1p();
            }
        }
    }

    fn parameters(&self, _: &Rig) -> Vec<Parameter> {
        let mut all = Vec::new();
        if self.gain != 0.0 {
            // Chord over the trial.
            let rate = self.gain * -(-50.0 / self.time).exp_m1() / 50.0;
            all.push(Parameter::new("rate", rate, "1/s", 0.25 * rate.abs()));
        }
        all.extend(per_actuator("rate", self.zero.map(|zero| zero / 50.0), "rad/s", |rate| 0.25 * rate + 1e-4));
        all
    }

    fn formula(&self) -> String {
        let [a, b] = self.zero;
        format!("warming in {:.1} s: gain by up to {:.4}, zero by {a:.4} and {b:.4} rad in 50 s", self.time, self.gain)
    }
}

/// Periodic error of the first encoder.
pub struct CamTable {
    /// Amplitude, rad.
    pub size: f64,
    /// Angle of one period, rad.
    pub period: f64,
    /// Entries of the table, about 1.
    pub table: [f64; 12],
}

impl CamTable {
    /// A table with a dominant first harmonic at a phase; `ripple` is added.
    pub fn new(size: f64, period: f64, phase: f64, ripple: [f64; 12]) -> Self {
        let entry = |k: usize| {
            let angle = TAU * k as f64 / 12.0 + phase;
            angle.cos() + 0.12 * (2.0 * angle + 0.7).cos() + 0.10 * (3.0 * angle).cos() + 0.05 * ripple[k]
        };
        Self { size, period, table: std::array::from_fn(entry) }
    }

    fn error(&self, angle: f64) -> f64 {
        let place = (angle / self.period).rem_euclid(1.0) * 12.0;
        let left = (place as usize) % 12;
        let entry = |k: usize| self.table[(left + 12 + k - 1) % 12];
        let (before, from, to, after) = (entry(0), entry(1), entry(2), entry(3));
        let u = place - place.floor();
        let bend = 2.0 * before - 5.0 * from + 4.0 * to - after;
        from + 0.5 * u * (to - before + u * (bend + u * (3.0 * (from - to) + after - before)))
    }
}

impl Mechanism for CamTable {
    fn actuate(&self, _: &Course, actuators: &mut [Vec<f64>; 2]) {
        for value in &mut actuators[0] {
            *value += self.size * self.error(*value);
        }
    }

    fn parameters(&self, _: &Rig) -> Vec<Parameter> {
        let part = |of: fn(f64) -> f64| {
            (0..12).map(|k| self.table[k] * of(TAU * k as f64 / 12.0)).sum::<f64>() / 6.0 * self.size
        };
        vec![
            Parameter::new("sine_q1", part(f64::sin), "rad", 0.015 + 0.15 * self.size),
            Parameter::new("cosine_q1", part(f64::cos), "rad", 0.015 + 0.15 * self.size),
            Parameter::new("periods_q1", 1.0 / self.period, "1/rad", 0.04 / self.period),
        ]
    }

    fn formula(&self) -> String {
        format!("table of 12 entries on a period of {:.4} rad of q1, {:.4} rad high", self.period, self.size)
    }
}

/// The second actuator pulls at the first plane.
pub struct Oblique {
    /// Coupling of small angles, 1.
    pub share: f64,
    /// Bend of the coupling, 1/rad.
    pub bend: f64,
}

impl Mechanism for Oblique {
    fn actuate(&self, _: &Course, actuators: &mut [Vec<f64>; 2]) {
        let [first, second] = actuators;
        for (q1, q2) in first.iter_mut().zip(second.iter()) {
            *q1 += self.share * (self.bend * q2).sin() / self.bend;
        }
    }

    fn parameters(&self, _: &Rig) -> Vec<Parameter> {
        vec![Parameter::new("q1_of_q2", self.share, "1", 0.15 * self.share.abs() + 0.01)]
    }

    fn formula(&self) -> String {
        format!("q1 + {:.4}·sin({:.3}·q2)/{:.3}", self.share, self.bend, self.bend)
    }
}

/// Largest angle of the first actuator in flight, rad.
pub const REACH: f64 = 2.25;

/// Servos that yield at their limit.
pub struct Yielding {
    /// Limit of the first actuator, rad.
    pub limit: f64,
}

impl Mechanism for Yielding {
    fn actuate(&self, _: &Course, actuators: &mut [Vec<f64>; 2]) {
        for value in &mut actuators[0] {
            *value /= (1.0 + (*value / self.limit).powi(8)).powf(0.125);
        }
    }

    fn parameters(&self, _: &Rig) -> Vec<Parameter> {
        let cut = REACH - self.limit;
        ["upper_cut_q1", "lower_cut_q1"].map(|name| Parameter::new(name, cut, "rad", 0.12 + 0.1 * cut)).into()
    }

    fn formula(&self) -> String {
        format!("q1/(1 + |q1/{:.4}|⁸)^(1/8)", self.limit)
    }
}
