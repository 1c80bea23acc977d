//! Forces on the arm: unrecorded weight, and air.
//!
//! | mechanism | equation |
//! | --- | --- |
//! | weight at the tip | f_tip = −m·g·e_z, in the rod's equilibrium |
//! | heavier rod | f_k = −δ·m_k·g·e_z |
//! | jet of the rotors | w² = V²·(u/u₀)^p/(1 + z/z₀)², straight down; z metres below the vehicle |
//! | late jet | the same with u(t − x) averaged over a gamma density of x, shape 3, mean τ |
//! | jet on the ground | w² = V²·(u/u₀)^p·sech²(h/h₀) |
//! | side wind | w² = V²·(1 + z/2 m), horizontal |
//!
//! A load has no counterpart among the values of the library: it divides by the stiffness of the backbone, and here
//! taut tendons hold the arm as well, about four times as stiffly. Drag of every element across its axis is quadratic
//! ([`element_drag`]). u₀ = 0.62 hovers. Jet decay: Pope, Turbulent Flows (2000), ch. 5.

use crate::twin::mechanics::rod::Chain;
use crate::twin::surroundings::wind::{element_drag, tip_drag};
use crate::twin::undeclared::mechanism::{Mechanism, Now, Ranges};
use crate::twin::undeclared::truth::Parameter;
use nalgebra::Vector3;

const HOVER: f64 = 0.62;

/// A mass at the tip.
pub struct TipMass {
    /// Masses, kg, three in turn; equal where they are unrecorded.
    pub mass: [f64; 3],
}

impl TipMass {
    /// Returns the mass in a trial, kg. The order is a Latin square, so that neither altitude nor q2 correlates with
    /// it.
    pub fn of(&self, trial: usize) -> f64 {
        self.mass[(trial + trial / 3) % 3]
    }
}

impl Mechanism for TipMass {
    fn push(&self, now: &Now, _: &Chain, forces: &mut [Vector3<f64>]) {
        if let Some(tip) = forces.last_mut() {
            tip.z -= now.rig.settings.arm.gravity * self.of(now.course.number);
        }
    }

    fn formula(&self) -> String {
        let [a, b, c] = self.mass.map(|mass| 1e3 * mass);
        format!("{a:.2}, {b:.2} or {c:.2} g at the tip, trial by trial")
    }
}

/// A rod heavier than it was.
pub struct HeavyRod {
    /// Share of the rod's mass that is added, 1.
    pub share: f64,
}

impl Mechanism for HeavyRod {
    fn push(&self, now: &Now, _: &Chain, forces: &mut [Vector3<f64>]) {
        let arm = &now.rig.settings.arm;
        let element = self.share * arm.line_density * now.rig.element() * arm.gravity;
        let joints = forces.len() - 1;
        forces[..joints].iter_mut().for_each(|force| force.z -= element);
    }

    fn formula(&self) -> String {
        format!("the rod is heavier by {:.4} of its mass", self.share)
    }
}

/// Direction of the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blow {
    /// Air down from the rotors, fading over this depth, m.
    Jet(f64),
    /// Push that is late by this mean delay, s.
    Late(f64, f64),
    /// Air near the ground, within this height, m; upwards where the last is positive.
    Ground(f64, f64),
    /// Push from one side, at this heading, rad.
    Side(f64),
}

/// Drag of air that blows along the arm.
pub struct Air {
    /// Square of the air's speed in hover, m²/s².
    pub square: f64,
    /// Exponent of the throttle, 1.
    pub power: f64,
    /// Direction of the air.
    pub blow: Blow,
}

impl Air {
    /// Returns the wind at the height of the attachment, m/s.
    fn top(&self, now: &Now) -> Vector3<f64> {
        let drive = |throttle: f64| self.square * (throttle.max(0.0) / HOVER).powf(self.power);
        let down = |square: f64| Vector3::new(0.0, 0.0, -square.max(0.0).sqrt());
        match self.blow {
            Blow::Jet(_) => down(drive(now.throttle(0.0))),
            Blow::Late(_, delay) => down(late(now, delay, &drive)),
            Blow::Ground(height, side) => {
                down(drive(now.throttle(0.0)) / (now.altitude() / height).cosh().powi(2)) * -side
            }
            Blow::Side(heading) => self.square.sqrt() * Vector3::new(heading.cos(), heading.sin(), 0.0),
        }
    }
}

/// Returns the mean of the drive over the past, with a gamma density of shape 3.
fn late(now: &Now, delay: f64, drive: &dyn Fn(f64) -> f64) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for k in 0..40 {
        let y = 0.25 * (f64::from(k) + 0.5);
        let weight = y * y * (-y).exp();
        sum += weight * drive(now.throttle(y * delay / 3.0));
        total += weight;
    }
    sum / total
}

impl Mechanism for Air {
    fn push(&self, now: &Now, arm: &Chain, forces: &mut [Vector3<f64>]) {
        let wind = &now.rig.settings.wind;
        let top = self.top(now);
        if top == Vector3::zeros() {
            return;
        }
        for (point, force) in forces.iter_mut().enumerate() {
            let depth = -arm.points[point].z;
            let felt = match self.blow {
                Blow::Jet(fade) | Blow::Late(fade, _) => top / (1.0 + depth.max(0.0) / fade),
                Blow::Ground(..) => top,
                Blow::Side(_) => top * (1.0 + 0.5 * depth.max(0.0)).sqrt(),
            };
            *force += match arm.tangents.get(point) {
                Some(tangent) => element_drag(wind, &felt, tangent, now.rig.element()),
                None => tip_drag(wind, &felt),
            };
        }
    }

    fn shaped(&self) -> bool {
        true
    }

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        match self.blow {
            Blow::Late(_, delay) => vec![Parameter::new("tau", delay, "s", 0.35 * delay)],
            _ => Vec::new(),
        }
    }

    fn formula(&self) -> String {
        let (square, power) = (self.square, self.power);
        let drive = format!("w² = {square:.3} m²/s²·(u/{HOVER})^{power:.2}");
        match self.blow {
            Blow::Jet(fade) => format!("{drive}/(1 + z/{fade:.3} m)², down"),
            Blow::Late(fade, delay) => format!("{drive}/(1 + z/{fade:.3} m)², down, after {delay:.3} s on average"),
            Blow::Ground(height, side) => {
                format!("{drive}·sech²(h/{height:.3} m), {}", if side > 0.0 { "up" } else { "down" })
            }
            Blow::Side(heading) => format!("w² = {square:.3} m²/s²·(1 + z/2 m), towards {heading:.3} rad"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twin::undeclared::course::{Course, trial_of};
    use crate::twin::undeclared::quiet::Rig;
    use nalgebra::{DVector, Rotation3};

    fn forces(mechanism: &dyn Mechanism, course: &Course, rig: &Rig, time: f64) -> Vec<Vector3<f64>> {
        let joints = rig.settings.arm.joints;
        let mut arm = Chain::new(joints);
        // Lying flat along x.
        let base = Rotation3::from_axis_angle(&Vector3::y_axis(), std::f64::consts::FRAC_PI_2);
        arm.place(&base, &DVector::zeros(2 * joints), rig.element());
        let mut forces = vec![Vector3::zeros(); joints + 1];
        mechanism.push(&Now { course, rig, time }, &arm, &mut forces);
        forces
    }

    /// Oracle: hand arithmetic. 20 g weigh 0.1962 N; a rod of 83.2 g that is heavier by a half adds 0.4081 N.
    #[test]
    fn weights_by_hand() {
        let (course, rig) = (trial_of(&|_| 0.0), Rig::new([0.0; 2]));
        let sum = |mechanism: &dyn Mechanism| forces(mechanism, &course, &rig, 0.0).iter().sum::<Vector3<f64>>();
        assert!((sum(&TipMass { mass: [0.02; 3] }) + Vector3::z() * 0.1962).norm() < 1e-12);
        assert!((sum(&HeavyRod { share: 0.5 }) + Vector3::z() * (0.5 * 16.0 * 0.0052 * 9.81)).norm() < 1e-12);
    }

    /// Oracle: quadratic drag. Rotors at rest push nothing; twice the square of speed pushes twice as much, downwards on an
    /// arm that lies flat; a jet on the ground of height h₀ is sech²(1) = 0.41997 of it at h₀.
    #[test]
    fn air_pushes_with_the_square_of_its_speed() {
        let rig = Rig::new([0.0; 2]);
        let mut course = trial_of(&|_| 0.0);
        let jet = |square: f64| Air { square, power: 1.3, blow: Blow::Jet(1.0) };
        course.throttle.fill(0.0);
        assert!(forces(&jet(10.0), &course, &rig, 5.0).iter().all(|force| *force == Vector3::zeros()));
        course.throttle.fill(HOVER);
        let (one, two) = (forces(&jet(10.0), &course, &rig, 5.0), forces(&jet(20.0), &course, &rig, 5.0));
        assert!(one.iter().zip(&two).all(|(one, two)| (two - 2.0 * one).norm() < 1e-12 && one.z < 0.0));
        course.altitude.fill(0.8);
        let ground = Air { square: 10.0, power: 1.3, blow: Blow::Ground(0.8, 1.0) };
        let lifted = forces(&ground, &course, &rig, 5.0);
        assert!((lifted[3].z + 0.419_974 * one[3].z).abs() < 1e-6 * one[3].z.abs(), "{} {}", lifted[3], one[3]);
    }

    /// Oracle: a gamma density of mean τ makes a ramp of the drive late by τ.
    #[test]
    fn late_jet_is_late_by_its_mean_delay() {
        let rig = Rig::new([0.0; 2]);
        let mut course = trial_of(&|_| 0.0);
        for (n, throttle) in course.throttle.iter_mut().enumerate() {
            *throttle = 0.1 + 1e-4 * n as f64;
        }
        let air = |blow| Air { square: 10.0, power: 1.0, blow };
        let late = forces(&air(Blow::Late(1.0, 1.5)), &course, &rig, 30.0);
        let then = forces(&air(Blow::Jet(1.0)), &course, &rig, 28.5);
        assert!((late[3].z / then[3].z - 1.0).abs() < 5e-3, "{} {}", late[3].z, then[3].z);
    }
}
