//! Motions with exact derivatives, plants that follow them, and noise.

use std::f64::consts::TAU;

/// A seeded source of random numbers. SplitMix64: Steele, Lea & Flood (2014), OOPSLA.
pub struct Random(u64);

/// One step of the sequence, and what mixes it.
const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

fn mix(state: u64) -> u64 {
    let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

impl Random {
    /// Another seed begins elsewhere; unmixed, neighbours would be one sequence, shifted.
    pub fn new(seed: u64) -> Self {
        Self(mix(seed.wrapping_add(STEP)))
    }

    /// Uniform in 0 … 1.
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(STEP);
        (mix(self.0) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in `low … high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Standard normal. Box & Muller (1958), Annals of Mathematical Statistics 29(2).
    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.uniform()).ln()).sqrt() * (TAU * self.uniform()).cos()
    }
}

/// A sum of sines, `q(t) = Σ a sin(ω t + φ)`; before t = 0 it rests at q(0).
#[derive(Clone)]
pub struct Motion(Vec<[f64; 3]>);

impl Motion {
    /// `count` sines with periods between `slowest` and `fastest` (s) and a root mean square of `size`/√2.
    pub fn new(random: &mut Random, size: f64, count: usize, [slowest, fastest]: [f64; 2]) -> Self {
        let share = size / (0.5 * count as f64).sqrt() / 2f64.sqrt();
        let sine = |k: usize| {
            let place = (k as f64 + random.uniform()) / count as f64;
            let period = slowest * (fastest / slowest).powf(place);
            [share, TAU / period, random.between(0.0, TAU)]
        };
        Self((0..count).map(sine).collect())
    }

    /// The `order`-th derivative at a time, s.
    fn derivative(&self, t: f64, order: i32) -> f64 {
        if t < 0.0 {
            return if order == 0 { self.derivative(0.0, 0) } else { 0.0 };
        }
        let turned = f64::from(order) * TAU / 4.0;
        self.0.iter().map(|[a, w, phase]| a * w.powi(order) * (w * t + phase + turned).sin()).sum()
    }

    /// Position.
    pub fn at(&self, t: f64) -> f64 {
        self.derivative(t, 0)
    }

    /// Positions at these times.
    pub fn sampled(&self, time: &[f64]) -> Vec<f64> {
        time.iter().map(|t| self.at(*t)).collect()
    }

    /// Speed.
    pub fn speed(&self, t: f64) -> f64 {
        self.derivative(t, 1)
    }

    /// Acceleration.
    pub fn acceleration(&self, t: f64) -> f64 {
        self.derivative(t, 2)
    }
}

/// `count` instants, `step` apart.
pub fn clock(count: usize, step: f64) -> Vec<f64> {
    (0..count).map(|k| k as f64 * step).collect()
}

/// Solves ẋ = slope(t, x) from `x0` at the first instant; twenty steps of the classical Runge–Kutta method between two.
pub fn solve<const N: usize>(time: &[f64], x0: [f64; N], slope: impl Fn(f64, [f64; N]) -> [f64; N]) -> Vec<[f64; N]> {
    const STEPS: usize = 20;
    let moved = |x: [f64; N], h: f64, d: [f64; N]| std::array::from_fn(|i| x[i] + h * d[i]);
    let mut all = vec![x0];
    for pair in time.windows(2) {
        let (h, mut x) = ((pair[1] - pair[0]) / STEPS as f64, all[all.len() - 1]);
        for k in 0..STEPS {
            let t = pair[0] + k as f64 * h;
            let a = slope(t, x);
            let b = slope(t + 0.5 * h, moved(x, 0.5 * h, a));
            let c = slope(t + 0.5 * h, moved(x, 0.5 * h, b));
            let d = slope(t + h, moved(x, h, c));
            x = std::array::from_fn(|i| x[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
        all.push(x);
    }
    all
}

/// First-order lag, `τ ẋ = u − x`, that begins at rest.
pub fn lag(time: &[f64], tau: f64, u: impl Fn(f64) -> f64) -> Vec<f64> {
    solve(time, [u(time[0])], |t, [x]| [(u(t) - x) / tau]).into_iter().map(|[x]| x).collect()
}

/// Oscillator, `ẍ = ω² (u − x) − 2 ζ ω ẋ`, that begins at rest.
pub fn oscillator(time: &[f64], period: f64, damping: f64, u: impl Fn(f64) -> f64) -> Vec<f64> {
    let w = std::f64::consts::TAU / period;
    let slope = |t: f64, [x, v]: [f64; 2]| [v, w * w * (u(t) - x) - 2.0 * damping * w * v];
    solve(time, [u(time[0]), 0.0], slope).into_iter().map(|[x, _]| x).collect()
}
