//! How actuators move, as functions of continuous time, and how noise is drawn.
//!
//! ```text
//! q(t) = Σ_k a_k sin(2π f_k t + φ_k)
//! ```
//!
//! A delayed signal is then q(t − Δ), whatever the time stamps are.

use std::f64::consts::TAU;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// Sines, each with its amplitude, frequency in Hz and phase.
#[derive(Debug, Clone)]
pub struct Motion(Vec<[f64; 3]>);

impl Motion {
    /// Three sines of random frequency; the magnitude stays below 0.95.
    pub fn new(random: &mut ChaCha8Rng) -> Self {
        let mut sine = |a: f64, low: f64, high: f64| [a, random.random_range(low..high), random.random_range(0.0..TAU)];
        Self(vec![sine(0.6, 0.02, 0.1), sine(0.25, 0.1, 0.25), sine(0.1, 0.25, 0.4)])
    }

    pub fn of(sines: &[[f64; 3]]) -> Self {
        Self(sines.to_vec())
    }

    /// Both together, the other `times` as large.
    pub fn with(&self, times: f64, other: &Self) -> Self {
        let other = other.0.iter().map(|[a, f, phase]| [times * a, *f, *phase]);
        Self(self.0.iter().copied().chain(other).collect())
    }

    /// The product: sin α sin β = (cos(α − β) − cos(α + β))/2.
    pub fn times(&self, other: &Self) -> Self {
        let product = |[a, f, phase]: [f64; 3], [b, g, other]: [f64; 3]| {
            let size = 0.5 * a * b;
            [[size, f - g, phase - other + 0.25 * TAU], [-size, f + g, phase + other + 0.25 * TAU]]
        };
        Self(self.0.iter().flat_map(|own| other.0.iter().flat_map(move |their| product(*own, *their))).collect())
    }

    pub fn at(&self, time: f64) -> f64 {
        self.0.iter().map(|[a, f, phase]| a * (TAU * f * time + phase).sin()).sum()
    }
}

pub fn random(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// Mean 0, variance 1: a sum of twelve uniform draws.
pub fn normal(random: &mut ChaCha8Rng) -> f64 {
    (0..12).map(|_| random.random_range(-0.5..0.5)).sum()
}

/// Ornstein–Uhlenbeck process of standard deviation `sd` that forgets in `tau`, at steps of `step`.
pub fn wandering(random: &mut ChaCha8Rng, samples: usize, step: f64, sd: f64, tau: f64) -> Vec<f64> {
    let keep = (-step / tau).exp();
    let mut state = sd * normal(random);
    let mut next = || {
        let now = state;
        state = keep * state + (1.0 - keep * keep).sqrt() * sd * normal(random);
        now
    };
    (0..samples).map(|_| next()).collect()
}

/// A random walk from 0 whose steps have standard deviation `sd`.
pub fn walk(random: &mut ChaCha8Rng, samples: usize, sd: f64) -> Vec<f64> {
    let mut state = 0.0;
    (0..samples)
        .map(|_| {
            state += sd * normal(random);
            state
        })
        .collect()
}
