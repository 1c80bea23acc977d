//! The quasi-static arm: the campaign's rod and tendons, with round pulleys and no friction, creep or wind.
//!
//! Each instant is then an equilibrium by itself. Besides tendons and weight, only the undeclared mechanism bends the arm.

use super::super::settings::TwinSettings;
use crate::twin::mechanics::cam::Cam;
use crate::twin::mechanics::equilibrium::{Instant, NotBalanced, joint_stiffness};
use crate::twin::mechanics::rod::Chain;
use crate::twin::mechanics::sheath::Sheath;
use crate::twin::mechanics::tendons::{TENDONS, preload};
use nalgebra::{DVector, Matrix3, Rotation3, Vector3};

/// Steps in which the arm is wound from straight to where it starts.
const SET_UP_STEPS: usize = 24;

/// Constants of the arm.
#[derive(Clone, Debug)]
pub struct Rig {
    /// Constants of rod, tendons and air; the rest of the full campaign's settings is not used.
    pub settings: TwinSettings,
    stiffness: DVector<f64>,
    weights: Vec<Vector3<f64>>,
    preloads: [f64; TENDONS],
    sheaths: [Sheath; TENDONS],
    cams: [Cam; 2],
}

/// Position and orientation of the tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    /// Relative to the attachment, world axes, m.
    pub place: Vector3<f64>,
    /// Rotation from the tip's frame (z along the arm) to the world.
    pub turn: Rotation3<f64>,
}

impl Rig {
    /// Returns an arm; `misfit` scales the pulleys' errors of shape, zero is a round pulley.
    pub fn new(misfit: [f64; 2]) -> Self {
        let settings = settings();
        let arm = &settings.arm;
        let mut masses = vec![arm.line_density * arm.length / arm.joints as f64; arm.joints];
        masses.push(arm.tip_mass);
        Self {
            stiffness: joint_stiffness(&settings),
            weights: masses.iter().map(|mass| Vector3::new(0.0, 0.0, -arm.gravity * mass)).collect(),
            preloads: [preload(&settings.tendons, settings.tendons.pretension); TENDONS],
            sheaths: [0, 0, 1, 1].map(|pair| Sheath::new(&settings.sheath, pair)),
            cams: [0, 1].map(|pulley| Cam::of_pulley(pulley, misfit[pulley])),
            settings,
        }
    }

    /// Returns the length of one element, m.
    pub fn element(&self) -> f64 {
        self.settings.arm.length / self.settings.arm.joints as f64
    }

    fn taken_up(&self, actuators: [f64; 2]) -> [f64; TENDONS] {
        let mut taken_up = self.preloads;
        for pulley in 0..2 {
            let length = self.settings.tendons.pulley[pulley] * self.cams[pulley].effective(actuators[pulley]);
            taken_up[2 * pulley] += length;
            taken_up[2 * pulley + 1] -= length;
        }
        taken_up
    }
}

/// Returns the full campaign's constants, stiffer (so that weight leaves a linear strain nearly linear) and without
/// friction.
fn settings() -> TwinSettings {
    let mut settings = TwinSettings::default();
    settings.arm.stiffness = 0.12;
    settings.arm.taper = 0.15;
    settings.sheath.level = [0.0; 2];
    settings.sheath.ageing = 0.0;
    // With no level and no ageing, friction is this much times a logarithm of speed: nothing.
    settings.sheath.direct = 1e-12;
    settings.solver.tolerance = 1e-7;
    settings
}

/// Solver of the arm's equilibria in sequence; each starts from the one before.
pub struct Follower<'a> {
    rig: &'a Rig,
    angles: DVector<f64>,
    trend: DVector<f64>,
    chain: Chain,
}

/// Loads besides tendons and weight.
pub struct Acting<'a> {
    /// Attitude of the vehicle.
    pub attitude: Rotation3<f64>,
    /// Adds forces at the joint centres and (last) the tip, N, for a shape of the arm.
    pub forces: &'a dyn Fn(&Chain, &mut [Vector3<f64>]),
    /// Whether the forces depend on the shape.
    pub shaped: bool,
}

impl<'a> Follower<'a> {
    /// Starts from the straight arm and moves it to its first equilibrium.
    pub fn new(rig: &'a Rig, actuators: [f64; 2], acting: &Acting) -> Result<Self, NotBalanced> {
        let joints = rig.settings.arm.joints;
        let angles = DVector::zeros(2 * joints);
        let mut follower = Self { rig, trend: angles.clone(), angles, chain: Chain::new(joints) };
        for n in 1..=SET_UP_STEPS {
            follower.step(actuators.map(|angle| angle * n as f64 / SET_UP_STEPS as f64), acting)?;
        }
        follower.trend.fill(0.0);
        Ok(follower)
    }

    /// Returns the equilibrium at these actuator angles.
    pub fn step(&mut self, actuators: [f64; 2], acting: &Acting) -> Result<Tip, NotBalanced> {
        // Arm axis down, x forward: half a turn about x.
        let mount = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
        let base = acting.attitude * Rotation3::from_matrix_unchecked(mount);
        let mut start = &self.angles + &self.trend;
        self.chain.place(&base, &start, self.rig.element());
        let mut place = Vector3::zeros();
        // Drag depends on the shape that it makes: once more with the shape found.
        for _ in 0..if acting.shaped { 2 } else { 1 } {
            let mut loads = self.rig.weights.clone();
            (acting.forces)(&self.chain, &mut loads);
            let instant = Instant {
                settings: &self.rig.settings,
                base,
                stiffness: &self.rig.stiffness,
                past: DVector::zeros(start.len()),
                newest_weight: 0.0,
                taken_up: self.rig.taken_up(actuators),
                given_before: [0.0; TENDONS],
                sheaths: &self.rig.sheaths,
                loads: &loads,
                step: 1.0,
            };
            let found =
                instant.solve(&start, &mut self.chain).or_else(|_| instant.solve(&self.angles, &mut self.chain))?;
            place = found.tip;
            start = found.angles;
        }
        self.trend = &start - &self.angles;
        self.angles = start;
        Ok(Tip { place, turn: self.turn(&base) })
    }

    fn turn(&self, base: &Rotation3<f64>) -> Rotation3<f64> {
        self.angles.as_slice().chunks_exact(2).fold(*base, |turn, pair| {
            turn * Rotation3::from_axis_angle(&Vector3::x_axis(), pair[0])
                * Rotation3::from_axis_angle(&Vector3::y_axis(), pair[1])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn calm() -> Acting<'static> {
        Acting { attitude: Rotation3::identity(), forces: &|_, _| {}, shaped: false }
    }

    /// Oracle: the way there does not matter to an arm without memory.
    #[test]
    fn same_angles_from_both_sides_give_the_same_tip() -> Result<(), NotBalanced> {
        let rig = Rig::new([0.0; 2]);
        let from = |start: f64| -> Result<Tip, NotBalanced> {
            let mut follower = Follower::new(&rig, [start, 0.4], &calm())?;
            for n in 0..=20 {
                follower.step([start + (0.7 - start) * f64::from(n) / 20.0, 0.4], &calm())?;
            }
            follower.step([0.7, 0.4], &calm())
        };
        let distance = (from(-1.5)?.place - from(2.0)?.place).norm();
        assert!(distance < 1e-6, "{distance}");
        Ok(())
    }

    /// Oracle: the tip's frame points along the last element, by finite differences of the chain's points.
    #[test]
    fn frame_of_the_tip_points_along_the_arm() -> Result<(), NotBalanced> {
        let rig = Rig::new([0.0; 2]);
        let mut follower = Follower::new(&rig, [1.2, 0.8], &calm())?;
        let tip = follower.step([1.2, 0.8], &calm())?;
        let points = &follower.chain.points;
        let along = (points[16] - points[15]).normalize();
        assert!((tip.turn * Vector3::z() - along).norm() < 1e-9);
        Ok(())
    }
}
