//! One stream of random numbers per trial and purpose.
//!
//! So a trial's numbers depend neither on the order of the trials nor on the number of threads. Unrecorded quantities
//! (turbulence, tilt, zero offsets …) can be redrawn while time stamps, joystick and encoder readings stay fixed.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::StandardNormal;

/// Seeds of a campaign; equal numbers are as independent as different ones, for the streams differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seeds {
    /// Seed of all that the recordings show: joystick, clock, altitude, throttle, encoders.
    pub recorded: u64,
    /// Seed of all that they do not show.
    pub unrecorded: u64,
}

/// Purpose of a stream of random numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Time stamps.
    Clock = 0,
    /// Motion of the joystick.
    Excitation = 1,
    /// Altitude hold and throttle.
    Flight = 2,
    /// Encoder noise.
    Encoder = 3,
    /// Noise of logged altitude and throttle.
    Logger = 4,
    /// Zero offsets and pretension (unrecorded from here on).
    Rig = 8,
    /// Vehicle tilt.
    Tilt = 9,
    /// Turbulence on each element.
    Turbulence = 10,
    /// Room circulation.
    Circulation = 11,
    /// Registration error.
    Registration = 12,
    /// Marker noise.
    Marker = 13,
}

impl Seeds {
    /// Returns the recorded and unrecorded numbers from one seed.
    pub fn both(seed: u64) -> Self {
        Self { recorded: seed, unrecorded: seed }
    }

    /// Returns the seeds of a repetition of the campaign, counted from 0, which is the campaign of `seed` itself.
    pub fn of_repetition(seed: u64, repetition: usize) -> Self {
        if repetition == 0 {
            return Self::both(seed);
        }
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        // far beyond the streams of the trials
        generator.set_stream((1 << 40) + repetition as u64);
        Self::both(generator.random())
    }

    /// Returns the stream of one purpose in one trial.
    pub fn stream(&self, trial: usize, purpose: Purpose) -> ChaCha8Rng {
        let unrecorded = purpose as u64 >= Purpose::Rig as u64;
        let seed = if unrecorded { self.unrecorded } else { self.recorded };
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(16 * trial as u64 + purpose as u64);
        generator
    }
}

/// Returns a standard normal number.
pub fn normal(generator: &mut ChaCha8Rng) -> f64 {
    generator.sample(StandardNormal)
}

/// Returns a number between two limits, each equally likely.
pub fn between(generator: &mut ChaCha8Rng, limits: [f64; 2]) -> f64 {
    limits[0] + (limits[1] - limits[0]) * generator.random::<f64>()
}

/// Draws whether an event of this probability happens.
pub fn happens(generator: &mut ChaCha8Rng, probability: f64) -> bool {
    generator.random::<f64>() < probability
}

/// Stationary Gaussian process with covariance exp(−|t|/τ), sampled exactly at any step.
///
/// ```text
/// x(t + Δ) = a·x(t) + √(1 − a²)·n,   a = exp(−Δ/τ),   n ~ N(0, 1)
/// ```
#[derive(Clone, Debug)]
pub struct Gusts {
    state: Vec<f64>,
    keep: f64,
}

impl Gusts {
    /// Starts `size` independent processes of unit variance in their stationary distribution.
    pub fn new(size: usize, step: f64, time: f64, generator: &mut ChaCha8Rng) -> Self {
        let state = (0..size).map(|_| normal(generator)).collect();
        Self { state, keep: (-step / time).exp() }
    }

    /// Advances by one step and returns the new values.
    pub fn advance(&mut self, generator: &mut ChaCha8Rng) -> &[f64] {
        let fresh = (1.0 - self.keep * self.keep).sqrt();
        for value in &mut self.state {
            *value = self.keep * *value + fresh * normal(generator);
        }
        &self.state
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn redrawing_the_unrecorded_leaves_the_recorded() {
        let one = Seeds { recorded: 5, unrecorded: 5 };
        let two = Seeds { recorded: 5, unrecorded: 6 };
        for purpose in [Purpose::Clock, Purpose::Excitation, Purpose::Flight, Purpose::Encoder, Purpose::Logger] {
            assert_eq!(normal(&mut one.stream(3, purpose)), normal(&mut two.stream(3, purpose)));
        }
        for purpose in [Purpose::Rig, Purpose::Tilt, Purpose::Turbulence, Purpose::Marker] {
            assert_ne!(normal(&mut one.stream(3, purpose)), normal(&mut two.stream(3, purpose)));
        }
        assert_ne!(normal(&mut one.stream(3, Purpose::Rig)), normal(&mut one.stream(4, Purpose::Rig)));
    }

    /// Oracle: variance 1 and correlation exp(−Δ/τ) of the exact process.
    #[test]
    fn gusts_have_unit_variance_and_the_stated_correlation() {
        let mut generator = Seeds::both(1).stream(1, Purpose::Turbulence);
        let mut gusts = Gusts::new(1, 0.05, 0.5, &mut generator);
        let values: Vec<f64> = (0..200_000).map(|_| gusts.advance(&mut generator)[0]).collect();
        let count = values.len() as f64;
        let variance = values.iter().map(|v| v * v).sum::<f64>() / count;
        let lagged = values.iter().zip(&values[10..]).map(|(a, b)| a * b).sum::<f64>() / count;
        assert!((variance - 1.0).abs() < 0.03, "variance {variance}");
        assert!((lagged - (-1.0f64).exp()).abs() < 0.03, "correlation {lagged}");
    }
}
