//! The arm with its internal states, advanced step by step through its equilibria.
//!
//! A step takes, in this order: the wind loads that have travelled to the arm, its weight, the tilt of the vehicle, the
//! pulleys (through their cams and zero offsets), the past of the backbone; then the equilibrium; then the memory is
//! brought up to date, and the wind at the new place is sent on its way.

use super::random::{Purpose, Seeds, normal};
use super::schedule::{Kind, TrialPlan};
use super::settings::TwinSettings;
use crate::twin::mechanics::cam::Cam;
use crate::twin::mechanics::creep::Creep;
use crate::twin::mechanics::equilibrium::{Equilibrium, Instant, NotBalanced, joint_stiffness};
use crate::twin::mechanics::rod::Chain;
use crate::twin::mechanics::sheath::Sheath;
use crate::twin::mechanics::tendons::{TENDONS, preload};
use crate::twin::surroundings::air::Air;
use crate::twin::surroundings::flight::Flight;
use crate::twin::surroundings::transport::Transport;
use crate::twin::surroundings::wind::{element_drag, hover_velocity, mean_wind, tip_drag};
use nalgebra::{DVector, Matrix3, Rotation3, Vector3};

/// Steps in which the arm is wound from straight to where the trial starts.
const SET_UP_STEPS: u32 = 40;
/// Duration of each set-up step, s: slow enough that friction is that of a careful hand.
const SET_UP_STEP: f64 = 0.25;

/// The arm of one trial.
pub struct Arm<'a> {
    settings: &'a TwinSettings,
    mount: Rotation3<f64>,
    cams: [Cam; 2],
    zero: [f64; 2],
    preloads: [f64; TENDONS],
    stiffness: DVector<f64>,
    weights: Vec<Vector3<f64>>,
    angles: DVector<f64>,
    trend: DVector<f64>,
    given: [f64; TENDONS],
    sheaths: [Sheath; TENDONS],
    creep: Creep,
    transport: Transport,
    air: Air,
    chain: Chain,
    residual: f64,
}

impl<'a> Arm<'a> {
    /// Returns the arm where the trial starts, wound there from straight and rested; it will make `steps` steps.
    ///
    /// # Errors
    /// There is no equilibrium on the way there.
    pub fn new(settings: &'a TwinSettings, plan: &TrialPlan, seeds: &Seeds, steps: usize) -> Result<Self, NotBalanced> {
        let joints = settings.arm.joints;
        let mut rig = seeds.stream(plan.number, Purpose::Rig);
        let zero = [0, 1].map(|_| settings.unrecorded.zero * normal(&mut rig));
        let pretension = settings.tendons.pretension * (settings.unrecorded.pretension * normal(&mut rig)).exp();
        let angles = DVector::zeros(2 * joints);
        let element = settings.arm.length / joints as f64;
        let mut arc: Vec<f64> = (0..joints).map(|k| (k as f64 + 0.5) * element).collect();
        arc.push(settings.arm.length);
        let mut arm = Self {
            settings,
            // Arm axis down, x forward: half a turn about x.
            mount: Rotation3::from_matrix_unchecked(Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0))),
            cams: [0, 1].map(|pulley| Cam::of_pulley(pulley, settings.cam[pulley])),
            zero,
            preloads: [preload(&settings.tendons, pretension); TENDONS],
            stiffness: joint_stiffness(settings),
            weights: weights(settings, plan),
            trend: angles.clone(),
            given: [0.0; TENDONS],
            sheaths: [0, 0, 1, 1].map(|pair| Sheath::new(&settings.sheath, pair)),
            creep: Creep::new(&settings.creep, settings.solver.step, 0, angles.clone()),
            transport: Transport::new(&settings.wind, &arc, settings.solver.step),
            air: Air::new(settings, plan, seeds),
            chain: Chain::new(joints),
            residual: 0.0,
            angles,
        };
        arm.set_up(plan)?;
        arm.creep = Creep::new(&settings.creep, settings.solver.step, steps, arm.angles.clone());
        Ok(arm)
    }

    /// Winds the relaxed arm slowly from straight to where the trial starts.
    fn set_up(&mut self, plan: &TrialPlan) -> Result<(), NotBalanced> {
        let goal = plan.actuators(-self.settings.measurement.preroll);
        for n in 1..=SET_UP_STEPS {
            let actuators = goal.map(|angle| angle * f64::from(n) / f64::from(SET_UP_STEPS));
            let past = DVector::zeros(self.angles.len());
            let loads = self.weights.clone();
            let found = self.balance(actuators, &Rotation3::identity(), past, 0.0, &loads, SET_UP_STEP)?;
            self.accept(found, SET_UP_STEP);
        }
        self.trend.fill(0.0);
        Ok(())
    }

    /// Advances by one step and returns the tip relative to the attachment, m.
    ///
    /// # Errors
    /// There is no equilibrium at this step.
    pub fn advance(&mut self, actuators: [f64; 2], flight: &Flight, n: usize) -> Result<Vector3<f64>, NotBalanced> {
        let step = self.settings.solver.step;
        let mut loads = self.weights.clone();
        for (point, load) in loads.iter_mut().enumerate() {
            *load += self.transport.acting(point);
        }
        let found =
            self.balance(actuators, &flight.attitude[n], self.creep.past(), self.creep.newest_weight(), &loads, step)?;
        let tip = found.tip;
        self.creep.accept(&found.angles);
        self.accept(found, step);
        self.blow(flight, n);
        Ok(tip)
    }

    fn balance(
        &mut self,
        actuators: [f64; 2],
        attitude: &Rotation3<f64>,
        past: DVector<f64>,
        newest_weight: f64,
        loads: &[Vector3<f64>],
        step: f64,
    ) -> Result<Equilibrium, NotBalanced> {
        let instant = Instant {
            settings: self.settings,
            base: attitude * self.mount,
            stiffness: &self.stiffness,
            past,
            newest_weight,
            taken_up: self.taken_up(actuators),
            given_before: self.given,
            sheaths: &self.sheaths,
            loads,
            step,
        };
        let ahead = &self.angles + &self.trend;
        instant.solve(&ahead, &mut self.chain).or_else(|_| instant.solve(&self.angles, &mut self.chain))
    }

    /// Returns the elongation of each tendon in the straight arm, m.
    fn taken_up(&self, actuators: [f64; 2]) -> [f64; TENDONS] {
        let mut taken_up = self.preloads;
        for pulley in 0..2 {
            let angle = self.cams[pulley].effective(actuators[pulley] + self.zero[pulley]);
            let length = self.settings.tendons.pulley[pulley] * angle;
            taken_up[2 * pulley] += length;
            taken_up[2 * pulley + 1] -= length;
        }
        taken_up
    }

    fn accept(&mut self, found: Equilibrium, step: f64) {
        for tendon in 0..TENDONS {
            let speed = (found.given[tendon] - self.given[tendon]) / step;
            self.sheaths[tendon].accept(&self.settings.sheath, speed, step);
        }
        self.trend = &found.angles - &self.angles;
        self.angles = found.angles;
        self.given = found.given;
        self.residual = self.residual.max(found.residual);
    }

    /// Returns the largest joint moment left unbalanced so far, N·m.
    pub fn largest_residual(&self) -> f64 {
        self.residual
    }

    /// Computes the wind at the arm's present position; it acts later.
    fn blow(&mut self, flight: &Flight, n: usize) {
        let thrust = flight.thrust[n];
        if thrust == 0.0 {
            return;
        }
        let wind = &self.settings.wind;
        let weight = self.settings.vehicle.mass * self.settings.arm.gravity;
        let hover = hover_velocity(wind, thrust * weight);
        let element = self.settings.arm.length / self.chain.joints() as f64;
        self.air.advance();
        for point in 0..self.chain.points.len() {
            let place = self.chain.points[point];
            let in_vehicle = flight.attitude[n].inverse() * place;
            let mean = flight.attitude[n] * mean_wind(wind, &in_vehicle, hover, flight.altitude[n]);
            let felt = mean + self.air.disturbance(self.settings, point, &mean, hover, flight.altitude[n]);
            let load = match self.chain.tangents.get(point) {
                Some(tangent) => element_drag(wind, &felt, tangent, element),
                None => tip_drag(wind, &felt),
            };
            self.transport.push(point, load);
        }
    }
}

/// Returns the weight of every element and of the tip body, N.
fn weights(settings: &TwinSettings, plan: &TrialPlan) -> Vec<Vector3<f64>> {
    let arm = &settings.arm;
    let element = arm.line_density * arm.length / arm.joints as f64;
    let payload = if plan.kind == Kind::Payload { arm.payload } else { 0.0 };
    let mut masses = vec![element; arm.joints];
    masses.push(arm.tip_mass + payload);
    masses.iter().map(|mass| Vector3::new(0.0, 0.0, -arm.gravity * mass)).collect()
}
