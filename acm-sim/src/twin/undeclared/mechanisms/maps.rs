//! Mechanisms between servo and tendon without memory.
//!
//! | mechanism | equation |
//! | --- | --- |
//! | worn pulley | q̃ = (1 + γ)·q + ½·η·q² + o |
//! | warming servo | q̃ = q·(1 + γ·(1 − e^(−t/T)))   or   q̃ = q + o·ln(1 + t/T)/ln(1 + 50 s/T) |
//! | cam table | q̃₁ = q₁ + a·e(q₁/P), e periodic through twelve table entries, its first harmonic dominant |
//! | oblique tendons | q̃₁ = q₁ + c·sin(κ·q₂)/κ |
//! | yielding servo | q̃ = q/(1 + ǀq/lǀ²⁰)^(1/20) |
//!
//! Angles in rad, times in s. Between table entries runs a cubic with central differences as slopes (Catmull & Rom 1974).

use crate::twin::undeclared::course::Course;
use crate::twin::undeclared::mechanism::{Mechanism, Ranges};
use crate::twin::undeclared::mechanisms::memory::per_actuator;
use crate::twin::undeclared::truth::Parameter;
use std::f64::consts::TAU;

/// Pulley with another gain and zero.
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

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
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

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
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
    /// Returns a table with a dominant first harmonic at a phase; `ripple` is added.
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

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
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

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        vec![Parameter::new("q1_of_q2", self.share, "1", 0.15 * self.share.abs() + 0.01)]
    }

    fn formula(&self) -> String {
        format!("q1 + {:.4}·sin({:.3}·q2)/{:.3}", self.share, self.bend, self.bend)
    }
}

/// Largest angle of the first actuator in flight, rad.
pub const REACH: f64 = 2.25;

/// Servos that deflect at their limit.
pub struct Yielding {
    /// Limit of the first actuator, rad.
    pub limit: f64,
}

impl Mechanism for Yielding {
    fn actuate(&self, _: &Course, actuators: &mut [Vec<f64>; 2]) {
        for value in &mut actuators[0] {
            *value /= (1.0 + (*value / self.limit).powi(20)).powf(0.05);
        }
    }

    fn parameters(&self, [[low, high], _]: &Ranges) -> Vec<Parameter> {
        let cuts = [("upper_cut_q1", high - self.limit), ("lower_cut_q1", -self.limit - low)];
        let cut = |(name, cut): (&str, f64)| Parameter::new(name, cut, "rad", 0.12 + 0.1 * cut);
        cuts.into_iter().filter(|(_, cut)| *cut > 0.0).map(cut).collect()
    }

    fn formula(&self) -> String {
        format!("q1/(1 + |q1/{:.4}|²⁰)^(1/20)", self.limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twin::undeclared::course::trial_of;

    fn after(mechanism: &dyn Mechanism, angle: f64, time: f64) -> f64 {
        let course = trial_of(&|_| angle);
        let mut actuators = course.actuators.clone();
        mechanism.actuate(&course, &mut actuators);
        course.at(&actuators[0], time)
    }

    /// Oracle: hand arithmetic.
    #[test]
    fn maps_by_hand() {
        let worn = WornPulley { gain: [0.1, 0.0], growth: 0.2, offset: [0.03, 0.0] };
        assert!((after(&worn, 2.0, 5.0) - (2.0 + 0.1 * 2.0 * 1.2 + 0.03)).abs() < 1e-12);
        let oblique = Oblique { share: 0.1, bend: 0.5 };
        assert!((after(&oblique, 2.0, 5.0) - (2.0 + 0.2 * 0.35f64.sin())).abs() < 1e-12);
        let yielding = Yielding { limit: 1.5 };
        let cuts = |low: f64, high: f64| -> Vec<(String, f64)> {
            let stated = yielding.parameters(&[[low, high], [0.0; 2]]);
            stated.into_iter().map(|cut| (cut.name, cut.value)).collect()
        };
        // The library counts what is cut off the range that was recorded.
        assert_eq!(cuts(-2.0, 1.75), [("upper_cut_q1".into(), 0.25), ("lower_cut_q1".into(), 0.5)]);
        assert_eq!(cuts(-1.0, 1.75), [("upper_cut_q1".into(), 0.25)]);
        assert!((after(&yielding, 0.5, 0.0) - 0.5).abs() < 1e-4 && (after(&yielding, -9.0, 0.0) + 1.5).abs() < 1e-4);
    }

    /// Oracle: 63 % of the way after the time of warming, nothing before the trial.
    #[test]
    fn warming_by_hand() {
        let gain = Warming { gain: 0.2, zero: [0.0; 2], time: 30.0 };
        assert_eq!(after(&gain, 2.0, -5.0), 2.0);
        assert!((after(&gain, 2.0, 30.0) - 2.0 * (1.0 + 0.2 * 0.632_120_6)).abs() < 1e-6);
        let zero = Warming { gain: 0.0, zero: [0.1, 0.0], time: 50.0 };
        assert!((after(&zero, 2.0, 50.0) - 2.1).abs() < 1e-9 && after(&zero, 2.0, 25.0) > 2.05);
    }

    /// Oracle: the table at its entries, the same one period on, and a first harmonic found by a sum over many angles.
    #[test]
    fn cam_meets_its_table_and_has_the_stated_harmonic() {
        let cam = CamTable::new(0.1, 1.3, 0.4, [0.3; 12]);
        for k in 0..12 {
            let angle = 1.3 * (k as f64 / 12.0 + 2.0) + 1e-9;
            assert!((cam.error(angle) - cam.table[k]).abs() < 1e-6);
            assert!((cam.error(angle) - cam.error(angle - 3.9)).abs() < 1e-9);
        }
        let sum: f64 =
            (0..1200).map(|n| cam.error(1.3 * f64::from(n) / 1200.0) * (TAU * f64::from(n) / 1200.0).sin()).sum();
        let sine = &cam.parameters(&[[0.0; 2]; 2])[0];
        assert!((sum / 600.0 * 0.1 - sine.value).abs() < 0.03 * 0.1, "{} {}", sum / 600.0 * 0.1, sine.value);
    }
}
