//! Mechanisms that the effect library does not have.
//!
//! | mechanism | equation |
//! | --- | --- |
//! | cross term | q̃₁ = q₁ + c·q₁·q₂ |
//! | quadratic drag in the drive | q̃ = q − c·ǀq̇ǀ·q̇ |
//! | gain with height | q̃ = q·(1 + g·h/(h + 0.8 m)) |
//! | slip | q̃₁ = q₁ + s after a time, in one trial |
//! | twist | p turned about the vertical by c·q₁ |
//! | offset | p + d in one trial |
//! | vibration | p + d·sin(2πf·t + φ), φ of the trial |
//! | wandering air | p + a sum of waves with the spectrum 1/(1 + ω²τ²), drawn again in each trial |
//!
//! The last line: a Cauchy-distributed ω gives the covariance e^(−ǀtǀ/τ) (Shinozuka & Deodatis 1991, Appl. Mech. Rev. 44).

use crate::twin::undeclared::course::{Course, STEP};
use crate::twin::undeclared::mechanism::{Mechanism, Now};
use crate::twin::undeclared::quiet::Tip;
use nalgebra::{Rotation3, Vector3};
use std::f64::consts::TAU;

/// A cross term of both actuators.
pub struct CrossTerm {
    /// Coefficient of the product, 1/rad.
    pub share: f64,
}

impl Mechanism for CrossTerm {
    fn actuate(&self, _: &Course, actuators: &mut [Vec<f64>; 2]) {
        let [first, second] = actuators;
        first.iter_mut().zip(second.iter()).for_each(|(q1, q2)| *q1 += self.share * *q1 * q2);
    }

    fn formula(&self) -> String {
        format!("q1 {:+.5}·q1·q2", self.share)
    }
}

/// Lag proportional to the square of speed.
pub struct QuadraticDrag {
    /// Coefficient of the lag, s²/rad.
    pub trail: f64,
}

impl Mechanism for QuadraticDrag {
    fn actuate(&self, _: &Course, actuators: &mut [Vec<f64>; 2]) {
        for q in actuators {
            let now = q.clone();
            let last = now.len() - 1;
            for (n, value) in q.iter_mut().enumerate() {
                let (left, right) = (n.saturating_sub(1), (n + 1).min(last));
                let speed = (now[right] - now[left]) / (STEP * (right - left) as f64);
                *value -= self.trail * speed.abs() * speed;
            }
        }
    }

    fn formula(&self) -> String {
        format!("q − {:.5} s²/rad·|q̇|·q̇", self.trail)
    }
}

/// A gain that depends on altitude.
pub struct HeightGain {
    /// Largest relative change of the gain, 1.
    pub gain: f64,
}

impl Mechanism for HeightGain {
    fn actuate(&self, course: &Course, actuators: &mut [Vec<f64>; 2]) {
        for q in actuators {
            q.iter_mut().zip(&course.altitude).for_each(|(q, h)| *q *= 1.0 + self.gain * h / (h + 0.8));
        }
    }

    fn formula(&self) -> String {
        format!("gain 1 {:+.5}·h/(h + 0.8 m)", self.gain)
    }
}

/// A clamp that slips once.
pub struct Slip {
    /// Size of the slip, rad.
    pub way: f64,
    /// Time of the slip, s.
    pub time: f64,
}

impl Mechanism for Slip {
    fn actuate(&self, course: &Course, actuators: &mut [Vec<f64>; 2]) {
        for (n, value) in actuators[0].iter_mut().enumerate() {
            if course.time(n) >= self.time {
                *value += self.way;
            }
        }
    }

    fn formula(&self) -> String {
        format!("q1 slips by {:+.4} rad at {:.2} s", self.way, self.time)
    }
}

/// An arm that twists as it bends.
pub struct Twist {
    /// Ratio of the twist to the first actuator's angle, 1.
    pub share: f64,
}

impl Mechanism for Twist {
    fn see(&self, now: &Now, tip: &mut Tip) {
        tip.place = Rotation3::from_axis_angle(&Vector3::z_axis(), self.share * now.actuator(0)) * tip.place;
    }

    fn formula(&self) -> String {
        format!("tip turned about the vertical by {:+.5}·q1", self.share)
    }
}

/// A constant shift.
pub struct Shifted {
    /// Shift of the tip, m.
    pub shift: Vector3<f64>,
}

impl Mechanism for Shifted {
    fn see(&self, _: &Now, tip: &mut Tip) {
        tip.place += self.shift;
    }

    fn formula(&self) -> String {
        let shift = 1e3 * self.shift;
        format!("tip shifted by ({:.2}, {:.2}, {:.2}) mm", shift.x, shift.y, shift.z)
    }
}

/// One wave: direction and size (m), angular frequency (rad/s), and a phase for each trial (rad).
pub struct Wave {
    /// Direction and size, m.
    pub size: Vector3<f64>,
    /// Angular frequency for each trial, rad/s.
    pub rate: Vec<f64>,
    /// Phase for each trial, rad.
    pub phase: Vec<f64>,
}

/// Waves of the tip that no recorded signal explains.
pub struct Waves {
    /// Waves that are added.
    pub waves: Vec<Wave>,
    /// Description in words.
    pub formula: String,
}

impl Waves {
    /// Returns a vibration at one frequency, Hz.
    pub fn vibration(size: Vector3<f64>, frequency: f64, phases: Vec<f64>) -> Self {
        let way = 1e3 * size;
        let formula = format!("({:.2}, {:.2}, {:.2}) mm·sin(2π·{frequency:.4} Hz·t + φ)", way.x, way.y, way.z);
        Self { waves: vec![Wave { size, rate: vec![TAU * frequency; phases.len()], phase: phases }], formula }
    }

    /// Returns a process of standard deviation `size` (m) per axis and correlation time `time` (s), from uniform
    /// numbers.
    pub fn wandering(size: f64, time: f64, trials: usize, mut uniform: impl FnMut() -> f64) -> Self {
        let waves = 24;
        let mut wave = |k: usize| {
            let axis = Vector3::ith(k % 3, 1.0);
            // Strata of the Cauchy distribution, cut off at its hundredth.
            let rate = |u: f64| (0.98 * 0.5 * std::f64::consts::PI * u).tan() / time;
            let rates = (0..trials).map(|_| rate(((k / 3) as f64 + uniform()) / f64::from(waves))).collect();
            let phases = (0..trials).map(|_| TAU * uniform()).collect();
            Wave { size: axis * size * (2.0 / f64::from(waves)).sqrt(), rate: rates, phase: phases }
        };
        let waves = (0..3 * waves as usize).map(&mut wave).collect();
        Self { waves, formula: format!("wanders by {:.2} mm per axis with {time:.2} s of memory", 1e3 * size) }
    }
}

impl Mechanism for Waves {
    fn see(&self, now: &Now, tip: &mut Tip) {
        let trial = now.course.number - 1;
        for wave in &self.waves {
            tip.place += wave.size * (wave.rate[trial] * now.time + wave.phase[trial]).sin();
        }
    }

    fn formula(&self) -> String {
        self.formula.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twin::random::{Purpose, Seeds, between};
    use crate::twin::undeclared::course::trial_of;
    use crate::twin::undeclared::quiet::Rig;

    /// Oracle: hand arithmetic at q1 = 1.5 and q2 = 0.7 rad, and at a speed of 0.3 rad/s.
    #[test]
    fn moved_actuators_by_hand() {
        let after = |mechanism: &dyn Mechanism, of: &dyn Fn(f64) -> f64, time: f64| {
            let course = trial_of(of);
            let mut actuators = course.actuators.clone();
            mechanism.actuate(&course, &mut actuators);
            course.at(&actuators[0], time)
        };
        let still = |_: f64| 1.5;
        assert!((after(&CrossTerm { share: -0.09 }, &still, 3.0) - (1.5 - 0.09 * 1.5 * 0.7)).abs() < 1e-12);
        assert!((after(&QuadraticDrag { trail: 0.5 }, &|t| 0.3 * t, 10.0) - (3.0 - 0.5 * 0.09)).abs() < 1e-9);
        let slip = Slip { way: 0.2, time: 20.0 };
        assert_eq!((after(&slip, &still, 19.9), after(&slip, &still, 20.1)), (1.5, 1.7));
    }

    /// Oracle: variance 1 and covariance e^(−t/τ), averaged over trials.
    #[test]
    fn wandering_has_the_stated_size_and_memory() {
        let mut generator = Seeds::both(2).stream(1, Purpose::Circulation);
        let trials = 400;
        let waves = Waves::wandering(1.0, 3.0, trials, || between(&mut generator, [0.0, 1.0]));
        let (mut course, rig) = (trial_of(&|_| 0.0), Rig::new([0.0; 2]));
        let mut at = |trial: usize, time: f64| {
            course.number = trial + 1;
            let mut tip = Tip { place: Vector3::zeros(), turn: Rotation3::identity() };
            waves.see(&Now { course: &course, rig: &rig, time }, &mut tip);
            tip.place
        };
        let (mut square, mut lagged) = (0.0, 0.0);
        for trial in 0..trials {
            for time in [0.0, 20.0, 40.0] {
                let now = at(trial, time);
                square += now.norm_squared() / (9 * trials) as f64;
                lagged += now.dot(&at(trial, time + 3.0)) / (9 * trials) as f64;
            }
        }
        assert!((square - 1.0).abs() < 0.05 && (lagged - (-1.0f64).exp()).abs() < 0.06, "{square} {lagged}");
    }
}
