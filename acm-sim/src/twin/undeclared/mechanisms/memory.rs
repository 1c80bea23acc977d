//! Mechanisms with memory between servo and tendon.
//!
//! | mechanism | equation |
//! | --- | --- |
//! | play with soft contact | T·dx/dt = s·[ln(1+e^((e−w)/s)) − ln(1+e^((−e−w)/s))],  e = q − x |
//! | slipping fibres | q̃ = q − a·Σ ρ_i·z_i,  dz_i/dt = q̇·(1 − [z_i·q̇ > 0]·(z_i/r_i)⁴), r log-normal |
//! | bristles on a capstan | q̃ = q·e^(−μ·z·sgn q),  dz/dt = q̇/δ·(1 − z·sgn q̇/g),  g = 1 + 0.25·e^(−(q̇/v_s)²) |
//! | two poles | τ₁·dx/dt = q − x,  τ₂·dq̃/dt = x − q̃,  τ₂ = τ₁/5 |
//! | transport | q̃(t) = ∫ k(x)·q(t − T − x) dx, k a triangle of half width 0.2·T |
//! | hardening spring | d²q̃/dt² = ω²·e·(1 + 2·e²) − 2ζω·dq̃/dt,  e = q − q̃ |
//! | power law | q̃ = q − c·∫ (1 + (t−u)/t₀)^(−p) dq(u) |
//!
//! Angles in rad, times in s. Soft contact: Nordin & Gutman (2002), Automatica 38; fibres: Iwan (1966), J. Appl. Mech. 33,
//! with Bouc–Wen's blend to slip; bristles: Canudas de Wit et al. (1995), IEEE TAC 40, on Euler's capstan; power law:
//! Nutting (1921), J. Franklin Inst. 191.

use crate::twin::mechanics::creep::Creep;
use crate::twin::settings::CreepSettings;
use crate::twin::undeclared::course::{Course, STEP, at};
use crate::twin::undeclared::mechanism::{Mechanism, Ranges};
use crate::twin::undeclared::truth::Parameter;
use nalgebra::DVector;
use std::f64::consts::TAU;

/// Play with soft contact.
pub struct SoftPlay {
    /// Half the play of each actuator, rad.
    pub width: [f64; 2],
}

/// Time in which contact settles, s.
const CONTACT: f64 = 0.02;
/// Steps of its integration per grid step.
const CONTACT_STEPS: usize = 3;

impl Mechanism for SoftPlay {
    fn actuate(&self, _: &Course, actuators: &mut [Vec<f64>; 2]) {
        for (q, width) in actuators.iter_mut().zip(self.width) {
            let soft = 0.04 * width;
            let bend = |excess: f64| soft * (excess / soft).min(500.0).exp().ln_1p();
            let (mut follower, mut before) = (q[0], q[0]);
            for value in q {
                for k in 1..=CONTACT_STEPS {
                    let now = before + (*value - before) * k as f64 / CONTACT_STEPS as f64;
                    let gap = now - follower;
                    follower += STEP / (CONTACT * CONTACT_STEPS as f64) * (bend(gap - width) - bend(-gap - width));
                }
                before = *value;
                *value = follower;
            }
        }
    }

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        per_actuator("width", self.width, "rad", |width| 0.015 + 0.15 * width)
    }

    fn formula(&self) -> String {
        format!(
            "soft contact behind a play of ±{:.4} and ±{:.4} rad, settling in {CONTACT} s",
            self.width[0], self.width[1]
        )
    }
}

/// Fibres that slip one after the other.
pub struct Fibres {
    /// Friction limit when all fibres slip, rad.
    pub held: f64,
    /// Median of their thresholds, rad.
    pub threshold: f64,
}

impl Mechanism for Fibres {
    fn actuate(&self, _: &Course, actuators: &mut [Vec<f64>; 2]) {
        let thresholds: Vec<f64> = (0..9).map(|i| self.threshold * (0.25 * (f64::from(i) - 4.0)).exp()).collect();
        // A sampled normal density, from −2 to 2 standard deviations.
        let shares: Vec<f64> = (0..9).map(|i| (-0.5 * (0.5 * (f64::from(i) - 4.0)).powi(2)).exp()).collect();
        let full: f64 = thresholds.iter().zip(&shares).map(|(r, share)| r * share).sum();
        for q in actuators {
            let mut fibres = vec![0.0_f64; thresholds.len()];
            let mut before = q[0];
            for value in q.iter_mut() {
                let moved = *value - before;
                before = *value;
                for (z, r) in fibres.iter_mut().zip(&thresholds) {
                    let slip = if *z * moved > 0.0 { (*z / r).powi(4) } else { 0.0 };
                    *z = (*z + moved * (1.0 - slip)).clamp(-r, *r);
                }
                let sum: f64 = fibres.iter().zip(&shares).map(|(z, share)| z * share).sum();
                *value -= self.held * sum / full;
            }
        }
    }

    fn formula(&self) -> String {
        format!("nine slipping fibres hold back up to {:.4} rad, thresholds about {:.3} rad", self.held, self.threshold)
    }
}

/// Friction that grows exponentially with wrap, its sign carried by bristles.
pub struct Bristles {
    /// Friction number of each actuator, 1.
    pub friction: [f64; 2],
    /// Displacement over which the bristles turn over, rad.
    pub way: f64,
}

impl Mechanism for Bristles {
    fn actuate(&self, _: &Course, actuators: &mut [Vec<f64>; 2]) {
        for (q, friction) in actuators.iter_mut().zip(self.friction) {
            let mut z = 0.0;
            let mut before = q[0];
            for value in q.iter_mut() {
                let moved = *value - before;
                before = *value;
                let speed = moved / STEP;
                let level = 1.0 + 0.25 * (-(speed / 0.05).powi(2)).exp();
                // Exact for a speed that stays the same within the step.
                let end = level * moved.signum();
                z = end + (z - end) * (-moved.abs() / (self.way * level)).exp();
                *value *= (-friction * z * value.signum()).exp();
            }
        }
    }

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        per_actuator("friction", self.friction, "1", |friction| 0.01 + 0.2 * friction)
    }

    fn formula(&self) -> String {
        let [first, second] = self.friction;
        format!("q·exp(−μ z sgn q), μ = {first:.4} and {second:.4}, bristles turn over in {:.3} rad", self.way)
    }
}

/// A lag with two poles on the real axis.
pub struct TwoPoles {
    /// Slower time constant, s.
    pub slow: f64,
}

/// Ratio of the faster to the slower time constant.
const FAST: f64 = 0.2;

impl Mechanism for TwoPoles {
    fn actuate(&self, _: &Course, actuators: &mut [Vec<f64>; 2]) {
        for q in actuators {
            lag(q, self.slow);
            lag(q, FAST * self.slow);
        }
    }

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        let tau = (1.0 + FAST) * self.slow;
        vec![Parameter::new("tau", tau, "s", 0.15 * tau + 0.01)]
    }

    fn contained_in(&self) -> &'static [&'static str] {
        // ω² = 1/(τ₁ τ₂) and 2 ζ/ω = τ₁ + τ₂, with ζ = 1.34.
        &["second_order_lag"]
    }

    fn formula(&self) -> String {
        format!("two poles, {:.4} s and {:.4} s", self.slow, FAST * self.slow)
    }
}

/// Applies a first-order lag to a course on the grid, exact for a signal that is linear between grid points.
pub fn lag(course: &mut [f64], time: f64) {
    let keep = (-STEP / time).exp();
    let mut before = course[0];
    let mut state = course[0];
    for value in course {
        let slope = (*value - before) / STEP * time;
        before = *value;
        state = *value - slope + (state - (*value - slope) + slope * STEP / time) * keep;
        *value = state;
    }
}

/// Transport with a little dispersion.
pub struct Transport {
    /// Mean delay, s.
    pub delay: f64,
}

impl Mechanism for Transport {
    fn actuate(&self, course: &Course, actuators: &mut [Vec<f64>; 2]) {
        for q in actuators {
            let now = q.clone();
            for (n, value) in q.iter_mut().enumerate() {
                let time = course.time(n) - self.delay;
                let part =
                    |k: i32| (5.0 - f64::from(k.abs())) / 25.0 * at(&now, time + 0.05 * self.delay * f64::from(k));
                *value = (-4..=4).map(part).sum();
            }
        }
    }

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        vec![Parameter::new("delay", self.delay, "s", 0.02)]
    }

    fn formula(&self) -> String {
        format!("transport in {:.4} s, spread as a triangle of half width {:.4} s", self.delay, 0.25 * self.delay)
    }
}

/// Relaxation that follows a power law.
pub struct PowerLaw {
    /// Share that creeps, 1.
    pub share: f64,
    /// Time after which the power law sets in, s.
    pub onset: f64,
    /// Exponent of the power law, 1.
    pub exponent: f64,
}

/// Number of grid points per step of the memory.
const STRIDE: usize = 10;

impl Mechanism for PowerLaw {
    fn actuate(&self, _: &Course, actuators: &mut [Vec<f64>; 2]) {
        let settings = CreepSettings { share: 1.0, onset: self.onset, exponent: self.exponent };
        let steps = actuators[0].len() / STRIDE;
        let angles = |n: usize| DVector::from_vec(vec![actuators[0][STRIDE * n], actuators[1][STRIDE * n]]);
        let mut memory = Creep::new(&settings, STRIDE as f64 * STEP, steps, angles(0));
        let fresh: Vec<DVector<f64>> = (0..=(actuators[0].len() - 1) / STRIDE)
            .map(|n| {
                let now = angles(n);
                let fresh = memory.past() + memory.newest_weight() * &now;
                memory.accept(&now);
                fresh
            })
            .collect();
        for (j, q) in actuators.iter_mut().enumerate() {
            for (n, value) in q.iter_mut().enumerate() {
                let (left, share) = (n / STRIDE, (n % STRIDE) as f64 / STRIDE as f64);
                let right = (left + 1).min(fresh.len() - 1);
                *value -= self.share * (fresh[left][j] * (1.0 - share) + fresh[right][j] * share);
            }
        }
    }

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        // The exponential of the same area, which starts flatter.
        let tau = self.onset / (self.exponent - 1.0).max(0.2);
        vec![
            Parameter::new("share", self.share, "1", 0.35 * self.share),
            Parameter::new("tau", 0.6 * tau, "s", 0.5 * tau),
        ]
    }

    fn formula(&self) -> String {
        format!("q − {:.4}·∫(1 + x/{:.3} s)^−{:.3} dq", self.share, self.onset, self.exponent)
    }
}

/// A sprung mass whose spring hardens.
pub struct Sprung {
    /// Period of small oscillations, s.
    pub period: f64,
    /// Damping, 1.
    pub damping: f64,
}

/// Hardening of the spring, 1/rad².
const HARDENING: f64 = 2.0;
/// Steps of integration per grid step.
const SUBSTEPS: usize = 4;

impl Mechanism for Sprung {
    fn actuate(&self, _: &Course, actuators: &mut [Vec<f64>; 2]) {
        let rate = TAU / self.period;
        let step = STEP / SUBSTEPS as f64;
        for q in actuators {
            let (mut place, mut speed, mut before) = (q[0], 0.0, q[0]);
            for value in q.iter_mut() {
                let goal = *value;
                for k in 1..=SUBSTEPS {
                    let now = before + (goal - before) * k as f64 / SUBSTEPS as f64;
                    let gap = now - place;
                    // Semi-implicit Euler neither amplifies nor damps the oscillation.
                    speed +=
                        step * (rate * rate * gap * (1.0 + HARDENING * gap * gap) - 2.0 * self.damping * rate * speed);
                    place += step * speed;
                }
                before = goal;
                *value = place;
            }
        }
    }

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        vec![
            Parameter::new("period", self.period, "s", 0.1 * self.period),
            Parameter::new("damping", self.damping, "1", 0.1 + 0.2 * self.damping),
        ]
    }

    fn formula(&self) -> String {
        format!(
            "sprung mass of period {:.4} s and damping {:.3}, its spring hardening by {HARDENING} per rad²",
            self.period, self.damping
        )
    }
}

/// Returns one parameter for each actuator that acts.
pub fn per_actuator(name: &str, values: [f64; 2], unit: &str, tolerance: impl Fn(f64) -> f64) -> Vec<Parameter> {
    let one =
        |(j, value): (usize, f64)| Parameter::new(format!("{name}_q{}", j + 1), value, unit, tolerance(value.abs()));
    values.into_iter().enumerate().filter(|(_, value)| *value != 0.0).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twin::undeclared::course::trial_of;

    /// Returns a course after a mechanism: the first actuator follows `of`, the second stands still.
    fn after(mechanism: &dyn Mechanism, of: impl Fn(f64) -> f64) -> (Course, Vec<f64>) {
        let course = trial_of(&of);
        let mut actuators = course.actuators.clone();
        mechanism.actuate(&course, &mut actuators);
        let [moved, _] = actuators;
        (course, moved)
    }

    /// Oracle: in steady motion contact carries the speed, s·ln(1 + e^((e−w)/s)) = q̇·T, which gives the way e by which the
    /// arm trails (and one step of integration less); within the play next to nothing moves.
    #[test]
    fn play_trails_by_its_width_and_holds_within() {
        let play = SoftPlay { width: [0.1, 0.1] };
        let (course, moved) = after(&play, |time| 0.2 * time);
        let trail = course.at(&course.actuators[0], 30.0) - course.at(&moved, 30.0);
        let expected = 0.1 + 0.004 * ((0.2 * CONTACT / 0.004).exp() - 1.0).ln() - 0.2 * STEP / 3.0;
        assert!((trail - expected).abs() < 1e-6, "{trail} {expected}");
        let (course, moved) = after(&play, |time| 0.05 * time.sin());
        let way = course.at(&moved, 31.4) - course.at(&moved, 33.0);
        assert!(way.abs() < 0.008, "{way} of 0.1 rad");
    }

    /// Oracle: in steady motion all fibres slip, and the arm trails by what they hold, whatever the speed.
    #[test]
    fn slipping_fibres_hold_back_the_same_at_any_speed() {
        for speed in [0.05, 0.5] {
            let (course, moved) = after(&Fibres { held: 0.1, threshold: 0.2 }, |time| speed * time);
            let trail = course.at(&course.actuators[0], 40.0) - course.at(&moved, 40.0);
            assert!((trail - 0.1).abs() < 2e-3, "{trail}");
        }
    }

    /// Oracle: Euler's capstan, a factor e^(−μ) outwards and e^μ inwards.
    #[test]
    fn bristles_make_a_capstan() {
        let capstan = Bristles { friction: [0.08, 0.0], way: 0.1 };
        let (course, moved) = after(&capstan, |time| 1.0 + 0.4 * (time - 20.0).clamp(0.0, 10.0));
        assert!((course.at(&moved, 28.0) / course.at(&course.actuators[0], 28.0) - (-0.08f64).exp()).abs() < 1e-4);
        let (course, moved) = after(&capstan, |time| 5.0 - 0.4 * (time - 20.0).clamp(0.0, 10.0));
        assert!((course.at(&moved, 28.0) / course.at(&course.actuators[0], 28.0) - 0.08f64.exp()).abs() < 1e-4);
    }

    /// Oracle: a ramp trails by slope × the sum of the time constants; a transported one by slope × delay.
    #[test]
    fn lags_and_transport_trail_a_ramp() {
        for (mechanism, late) in [
            (Box::new(TwoPoles { slow: 0.3 }) as Box<dyn Mechanism>, 0.36),
            (Box::new(Transport { delay: 0.25 }), 0.25),
        ] {
            let (course, moved) = after(&*mechanism, |time| 0.4 * time);
            let trail = course.at(&course.actuators[0], 30.0) - course.at(&moved, 30.0);
            assert!((trail - 0.4 * late).abs() < 1e-9, "{trail}");
        }
    }

    /// Oracle: the step response of y″/ω² + 2ζy′/ω + y = u with 1/ω² = 0.2τ² and 2ζ/ω = 1.2τ, in closed form.
    #[test]
    fn two_poles_are_a_second_order_lag() {
        let poles = TwoPoles { slow: 0.5 };
        assert_eq!(poles.contained_in(), ["second_order_lag"]);
        let rate = 1.0 / (0.2f64 * 0.25).sqrt();
        let damping = 0.6 * rate / 2.0;
        let root = (damping * damping - 1.0).sqrt();
        let (slow, fast) = (rate * (root - damping), -rate * (root + damping));
        let (course, moved) = after(&poles, |time| if time < 0.0 { 0.0 } else { 1.0 });
        for time in [0.2, 0.5, 1.5] {
            let expected = 1.0 - (fast * (slow * time).exp() - slow * (fast * time).exp()) / (fast - slow);
            assert!((course.at(&moved, time) - expected).abs() < 0.02, "{time}");
        }
    }

    /// Oracle: after a step of 1 rad the arm is at 1 − c·(1 + t/t₀)^(−p).
    #[test]
    fn creep_follows_its_power_law() {
        let creep = PowerLaw { share: 0.2, onset: 2.0, exponent: 0.8 };
        let (course, moved) = after(&creep, |time| if time < 0.0 { 0.0 } else { 1.0 });
        for time in [1.0, 10.0, 40.0] {
            let expected = 1.0 - 0.2 * (1.0 + time / 2.0f64).powf(-0.8);
            assert!((course.at(&moved, time) - expected).abs() < 3e-3, "{time}");
        }
    }

    /// Oracle: a small step rings with the stated period and decays by e^(−2πζ/√(1−ζ²)) in each.
    #[test]
    fn sprung_mass_rings() {
        let spring = Sprung { period: 1.0, damping: 0.1 };
        let (course, moved) = after(&spring, |time| if time < 0.0 { 0.0 } else { 0.01 });
        let ringing = 1.0 / (1.0 - 0.01f64).sqrt();
        let over = |n: f64| course.at(&moved, (n + 0.5) * ringing) - 0.01;
        let decay = (-TAU * 0.1 * ringing).exp();
        assert!((over(1.0) / over(0.0) - decay).abs() < 0.02 && (over(0.0) / 0.01 - decay.sqrt()).abs() < 0.03);
    }
}
