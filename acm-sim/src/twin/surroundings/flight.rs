//! Motion of the vehicle: altitude and throttle (recorded), tilt (unrecorded).
//!
//! Altitude is held with a slow wander. Throttle is the trim, raised as the battery sags, lowered near the ground
//! by Cheeseman & Bennett's (1955) factor T/T_∞ = 1/(1 − (R/4z)²), plus control activity, which alone changes
//! the rotor flow: trim is what keeps the thrust at the weight.

use crate::twin::random::{Gusts, Purpose, Seeds, normal};
use crate::twin::schedule::{Kind, TrialPlan};
use crate::twin::settings::TwinSettings;
use nalgebra::Rotation3;

/// Course of the vehicle on the simulator's time grid.
#[derive(Clone, Debug)]
pub struct Flight {
    /// Height of the attachment over the ground, m.
    pub altitude: Vec<f64>,
    /// Throttle, 1.
    pub throttle: Vec<f64>,
    /// Ratio of thrust to weight, 1; zero with rotors off.
    pub thrust: Vec<f64>,
    /// Attitude of the vehicle, unmeasured.
    pub attitude: Vec<Rotation3<f64>>,
}

impl Flight {
    /// Simulates flying (or parking) for the given number of steps.
    pub fn new(settings: &TwinSettings, plan: &TrialPlan, seeds: &Seeds, steps: usize) -> Self {
        if plan.kind == Kind::RotorsOff {
            return Self::parked(settings, steps);
        }
        let vehicle = &settings.vehicle;
        let step = settings.solver.step;
        let mut generator = seeds.stream(plan.number, Purpose::Flight);
        let mut hold = Gusts::new(1, step, vehicle.hold_time, &mut generator);
        let mut control = Gusts::new(1, step, vehicle.throttle_time, &mut generator);
        let trim = trim(settings, plan);
        let mut flight = Self {
            altitude: Vec::new(),
            throttle: Vec::new(),
            thrust: Vec::new(),
            attitude: tilt(settings, plan, seeds, steps),
        };
        for n in 0..steps {
            let activity = vehicle.throttle_spread * control.advance(&mut generator)[0];
            let sagged = trim + vehicle.sag * step * n as f64;
            flight.altitude.push(plan.altitude + vehicle.hold_spread * hold.advance(&mut generator)[0]);
            flight.throttle.push(sagged + activity);
            flight.thrust.push(((sagged + activity) / sagged).powi(2));
        }
        flight
    }

    fn parked(settings: &TwinSettings, steps: usize) -> Self {
        Self {
            altitude: vec![settings.vehicle.stand; steps],
            throttle: vec![0.0; steps],
            thrust: vec![0.0; steps],
            attitude: vec![Rotation3::identity(); steps],
        }
    }
}

/// Returns the throttle that carries the vehicle at the trial's altitude; thrust goes with its square.
fn trim(settings: &TwinSettings, plan: &TrialPlan) -> f64 {
    let payload = if plan.kind == Kind::Payload { settings.arm.payload } else { 0.0 };
    let weight = 1.0 + payload / settings.vehicle.mass;
    // Four rotors act on the ground like one of twice the radius.
    let near = 2.0 * settings.wind.rotor_radius / (4.0 * plan.altitude);
    settings.vehicle.throttle * (weight * (1.0 - near * near)).sqrt()
}

fn tilt(settings: &TwinSettings, plan: &TrialPlan, seeds: &Seeds, steps: usize) -> Vec<Rotation3<f64>> {
    let spread = &settings.unrecorded;
    let mut generator = seeds.stream(plan.number, Purpose::Tilt);
    let bias = [0, 1].map(|_| spread.tilt_bias * normal(&mut generator));
    let mut wander = Gusts::new(2, settings.solver.step, spread.tilt_time, &mut generator);
    (0..steps)
        .map(|_| {
            let moving = wander.advance(&mut generator);
            let angles = [0, 1].map(|axis| bias[axis] + spread.tilt * moving[axis]);
            Rotation3::new(nalgebra::Vector3::new(angles[0], angles[1], 0.0))
        })
        .collect()
}
