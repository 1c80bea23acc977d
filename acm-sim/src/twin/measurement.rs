//! Measurement: registration error, marker noise, encoder quantization.

use super::random::{Purpose, Seeds, normal};
use super::schedule::{Kind, TrialPlan};
use super::settings::{MeasurementSettings, TwinSettings};
use crate::twin::surroundings::flight::Flight;
use nalgebra::{Rotation3, Vector3};
use rand_chacha::ChaCha8Rng;

pub use super::rounding::round_to;

/// Returns the tip positions as motion capture gives them, m: `C·p + p_0 + noise` with a registration of the trial's
/// own.
pub fn capture(settings: &TwinSettings, plan: &TrialPlan, seeds: &Seeds, tips: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let spread = &settings.unrecorded;
    let mut generator = seeds.stream(plan.number, Purpose::Registration);
    let turn = vector(&mut generator).component_mul(&Vector3::new(
        spread.registration_tilt,
        spread.registration_tilt,
        spread.registration_heading,
    ));
    let rotation = Rotation3::new(turn);
    let shift = spread.registration * vector(&mut generator);
    let mut noise = seeds.stream(plan.number, Purpose::Marker);
    tips.iter()
        .map(|tip| rotation * tip + shift + settings.measurement.marker_noise * vector(&mut noise))
        .map(|tip| tip.map(|value| round_to(value, settings.measurement.decimals[1])))
        .collect()
}

/// Returns the encoder readings of both servos at the time stamps, rad.
pub fn encoders(settings: &MeasurementSettings, plan: &TrialPlan, seeds: &Seeds) -> Vec<[f64; 2]> {
    let mut generator = seeds.stream(plan.number, Purpose::Encoder);
    plan.times.iter().map(|time| plan.actuators(*time).map(|angle| read(settings, angle, &mut generator))).collect()
}

fn read(settings: &MeasurementSettings, angle: f64, generator: &mut ChaCha8Rng) -> f64 {
    let step = std::f64::consts::TAU / f64::from(1u32 << settings.encoder_bits);
    ((angle + settings.encoder_noise * normal(generator)) / step).round() * step
}

/// Returns the altitude (m) and throttle (1) as logged at the time stamps; `at` reads a course on the time grid.
pub fn log(
    settings: &TwinSettings,
    plan: &TrialPlan,
    seeds: &Seeds,
    flight: &Flight,
    at: &dyn Fn(&[f64]) -> Vec<f64>,
) -> [Vec<f64>; 2] {
    let mut generator = seeds.stream(plan.number, Purpose::Logger);
    let [_, position, throttle] = settings.measurement.decimals;
    // A vehicle on its stand reports a throttle of exactly zero.
    let noise = if plan.kind == Kind::RotorsOff { 0.0 } else { settings.vehicle.throttle_noise };
    let mut noisy = |course: &[f64], noise: f64, decimals: i32| -> Vec<f64> {
        at(course).into_iter().map(|value| round_to(value + noise * normal(&mut generator), decimals)).collect()
    };
    let altitude = noisy(&flight.altitude, settings.measurement.marker_noise, position);
    [altitude, noisy(&flight.throttle, noise, throttle)]
}

fn vector(generator: &mut ChaCha8Rng) -> Vector3<f64> {
    let [x, y, z] = [0, 1, 2].map(|_| normal(generator));
    Vector3::new(x, y, z)
}

#[cfg(test)]
mod tests {
    use super::super::random::between;
    use super::*;

    /// Oracle: 4096 steps per turn, and an error of at most half a step without noise.
    #[test]
    fn encoder_rounds_to_its_steps() {
        let settings = MeasurementSettings { encoder_noise: 0.0, ..MeasurementSettings::default() };
        let mut generator = Seeds::both(1).stream(1, Purpose::Encoder);
        let step = std::f64::consts::TAU / 4096.0;
        for _ in 0..100 {
            let angle = between(&mut generator, [-3.0, 3.0]);
            let reading = read(&settings, angle, &mut generator);
            assert!((reading - angle).abs() <= 0.5 * step + 1e-12);
            assert!((reading / step - (reading / step).round()).abs() < 1e-9);
        }
    }
}
