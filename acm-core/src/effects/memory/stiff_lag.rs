//! Second-order lag with a hardening or softening spring and dry friction: z̈ + 2ζω ż + ω² (z − f(z) + r(ż)) = ω² x, at rest at the
//! first sample.
//!
//! ```text
//! f = −k (z − c)³ for k ≥ 0,   f = (z − c) − sin(κ (z − c))/κ with κ = √(−6k) for k < 0
//! ```
//!
//! It hardens as Duffing's spring does, and softens as gravity does on a pendulum, with −k (z − c)³ as its first term.
//!
//! The linear part is exact for an input that is linear over each part of an interval ([`parts`]). f is added to the input,
//! predicted by its last value and corrected by a Newton step; the friction r is constant over the part ([`Friction`]). Second
//! order in the part. Over a part of length h from input u₀ to u₁, with the cosine C and sine S of
//! [`swing`](super::second_order_lag::swing) and b = 2ζ/(ωh):
//!
//! ```text
//! e = z − u₀ + b (u₁ − u₀),   r = ż − (u₁ − u₀)/h
//! z₁ = u₁ − b (u₁ − u₀) + (C + ζS) e + S r/ω
//! ż₁ = (u₁ − u₀)/h + (C − ζS) r − ω S e
//! ```
//!
//! Both are sums of z − u₀, ż, u₁ − u₀ and u₁ with coefficients that depend on h, ω and ζ alone ([`Stride`]).

mod friction;

use super::second_order_lag::{Stride, Swing};
use super::substeps::parts;
use super::{Point, State};

pub use friction::Friction;

/// Largest distance of z from the input: a soft spring may diverge. A resonance reaches 1/(2ζ) half ranges, 30 at a damping of
/// 0.017.
const FARTHEST: f64 = 30.0;

/// Newton steps to the equilibrium; with a hard spring each reduces the error by a third at least.
const NEWTON: usize = 30;

/// The spring, k and c, and the friction beside it.
#[derive(Debug, Clone, Copy)]
pub struct Spring {
    /// k, hardening above 0, softening below.
    pub hardness: f64,
    /// c: where the spring is as soft, or as hard, as a linear one.
    pub rest: f64,
    /// r.
    pub friction: Friction,
}

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct StiffLag {
    before: Option<Point>,
    z: f64,
    speed: f64,
}

impl State for StiffLag {}

impl Spring {
    /// κ of a spring that softens.
    fn bend(self) -> Option<f64> {
        (self.hardness < 0.0).then(|| (-6.0 * self.hardness).sqrt())
    }

    /// f and its slope f'.
    fn pull(self, z: f64) -> (f64, f64) {
        let out = z - self.rest;
        match self.bend() {
            None => (-self.hardness * out.powi(3), -3.0 * self.hardness * out.powi(2)),
            Some(bend) => {
                let (sine, cosine) = (bend * out).sin_cos();
                (out - sine / bend, 1.0 - cosine)
            }
        }
    }

    /// 1/ω of small swings about z − c = 1, where a hard spring is stiffest within the range; `unit` is that of the linear one.
    fn unit(self, unit: f64) -> f64 {
        if self.hardness > 0.0 { unit / (1.0 + 3.0 * self.hardness).sqrt() } else { unit }
    }

    /// Returns the equilibrium z for a constant input, z − f(z) = x, by Newton's method; x if it fails.
    fn at_rest(self, x: f64) -> f64 {
        let newton = |z: f64, _: usize| {
            let (pull, slope) = self.pull(z);
            z + (x + pull - z) / (1.0 - slope)
        };
        let z = (0..NEWTON).fold(x, newton);
        let off = (x + self.pull(z).0 - z).abs();
        if off < 1e-9 && (z - x).abs() < FARTHEST { z } else { x }
    }
}

impl StiffLag {
    /// z at the next sample; `unit` is 1/ω, s, `damping` is ζ. Without a unit it is x. Signals with the same time stamps share
    /// `last`.
    pub fn step(&mut self, time: f64, x: f64, (unit, damping): (f64, f64), spring: Spring, last: &mut Swing) -> f64 {
        match self.before.filter(|before| time > before.time && unit > 1e-9) {
            Some(before) => {
                let (h, ends) = parts(before, time, x, spring.unit(unit));
                let part = last.of((h, unit, damping), || Stride::new(h, unit, damping));
                let (mut past, mut pull) = (before.x, spring.pull(self.z).0);
                for x in ends {
                    pull = self.advance(past, x, part, spring, pull);
                    past = x;
                }
            }
            None => (self.z, self.speed) = (if unit > 1e-9 { spring.at_rest(x) } else { x }, 0.0),
        }
        self.before = Some(Point { time, x });
        self.z
    }

    /// One part, from input `past` to `x`, with the pull f at its begin; returns that at its end.
    fn advance(&mut self, past: f64, x: f64, part: Stride, spring: Spring, pull: f64) -> f64 {
        let (free, fast) = part.take(self.z, self.speed, past + pull, x);
        let (moves, speeds_up) = part.of_input();
        let (held, braked) = part.take(0.0, 0.0, 1.0, 1.0);
        let friction = spring.friction.over(self.speed + fast + speeds_up * pull, braked);
        let (free, fast) = (free - held * friction, fast - braked * friction);
        // z = free + moves f(z).
        let predicted = free + moves * pull;
        let (near, slope) = spring.pull(predicted);
        // A soft spring's step is at most twice that without slope.
        let slope = if moves * slope > 0.5 { 0.5 / moves } else { slope };
        let correction = moves * (near - pull) / (1.0 - moves * slope);
        let pull = near + slope * correction;
        let (z, speed) = (predicted + correction, fast + speeds_up * pull);
        let off = z - x;
        if off.abs() < FARTHEST {
            (self.z, self.speed) = (z, speed);
            return pull;
        }
        (self.z, self.speed) = (if off.is_nan() { x } else { x + off.clamp(-FARTHEST, FARTHEST) }, 0.0);
        spring.pull(self.z).0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the spring pulls with at z: Duffing's, or that of a pendulum whose length is one over the root of six times its softness.
    fn pulls(k: f64, c: f64, z: f64) -> f64 {
        match k < 0.0 {
            true => c + ((z - c) * (6.0 * k.abs()).sqrt()).sin() / (6.0 * k.abs()).sqrt(),
            false => z + k * (z - c) * (z - c) * (z - c),
        }
    }

    /// Classical Runge–Kutta in 400 steps between two samples, of the equation as it is written.
    fn oracle(time: &[f64], x: &[f64], (period, damping): (f64, f64), spring: Spring) -> Vec<f64> {
        let w = std::f64::consts::TAU / period;
        let Spring { hardness: k, rest: c, friction: Friction { force, transition } } = spring;
        // Bisection to where the spring rests.
        let (mut low, mut high) = (x[0] - 2.0, x[0] + 2.0);
        for _ in 0..60 {
            let z = 0.5 * (low + high);
            if pulls(k, c, z) < x[0] { low = z } else { high = z }
        }
        let (mut z, mut v, mut found) = (low, 0.0, vec![low]);
        for (t, x) in time.windows(2).zip(x.windows(2)) {
            let h = (t[1] - t[0]) / 400.0;
            for n in 0..400 {
                let input = |part: f64| x[0] + (x[1] - x[0]) * (f64::from(n) + part) / 400.0;
                let f = |part: f64, z: f64, v: f64| {
                    let held = force * v / v.hypot(transition);
                    (v, w * w * (input(part) - pulls(k, c, z) - held) - 2.0 * damping * w * v)
                };
                let a = f(0.0, z, v);
                let b = f(0.5, z + 0.5 * h * a.0, v + 0.5 * h * a.1);
                let c = f(0.5, z + 0.5 * h * b.0, v + 0.5 * h * b.1);
                let d = f(1.0, z + h * c.0, v + h * c.1);
                z += h / 6.0 * (a.0 + 2.0 * b.0 + 2.0 * c.0 + d.0);
                v += h / 6.0 * (a.1 + 2.0 * b.1 + 2.0 * c.1 + d.1);
            }
            found.push(z);
        }
        found
    }

    fn worst(step: f64, k: f64, damping: f64) -> f64 {
        worst_rubbed(step, k, damping, Friction::NONE)
    }

    fn worst_rubbed(step: f64, k: f64, damping: f64, friction: Friction) -> f64 {
        // Corners where every step has a sample, so that steps alone tell the runs apart.
        let time: Vec<f64> = (0..=(12.0 / step).round() as usize).map(|n| step * n as f64).collect();
        let x: Vec<f64> = time.iter().map(|t| 0.9 * (1.0 - (t / 3.0 - (t / 3.0).floor() - 0.5).abs() * 4.0)).collect();
        let (mut lag, spring) = (StiffLag::default(), Spring { hardness: k, rest: 0.3, friction });
        let unit = 1.3 / std::f64::consts::TAU;
        let found: Vec<f64> = time
            .iter()
            .zip(&x)
            .map(|(t, x)| lag.step(*t, *x, (unit, damping), spring, &mut Swing::default()))
            .collect();
        let exact = oracle(&time, &x, (1.3, damping), spring);
        found.iter().zip(&exact).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
    }

    /// Oracle: Runge–Kutta. Halving the step divides the error by four.
    #[test]
    fn a_cubic_spring_converges_at_second_order() {
        for (k, damping) in [(0.8, 0.3), (-0.06, 0.3), (0.3, 1.2)] {
            let (coarse, fine) = (worst(0.15, k, damping), worst(0.075, k, damping));
            let order = (coarse / fine).log2();
            assert!(coarse < 0.02 && (order - 2.0).abs() < 0.3, "{k}: {coarse:.1e}, order {order:.2}");
        }
        assert!(worst(0.15, 0.0, 0.3) < 1e-7, "without the cubic part it is exact");
    }

    /// Oracle: Runge–Kutta. Friction that is smooth over a part converges at second order too; where it holds the mass, the error is small.
    #[test]
    fn friction_brakes_it_at_second_order() {
        let soft = Friction { force: 0.2, transition: 0.8 };
        let (coarse, fine) = (worst_rubbed(0.06, 0.5, 0.05, soft), worst_rubbed(0.03, 0.5, 0.05, soft));
        let order = (coarse / fine).log2();
        assert!(coarse < 3e-3 && (order - 2.0).abs() < 0.4, "{coarse:.1e}, order {order:.2}");
        let holds = Friction { force: 0.1, transition: 0.01 };
        let without = worst_rubbed(0.03, 0.0, 0.05, Friction::NONE);
        let off = worst_rubbed(0.03, 0.0, 0.05, holds);
        assert!(without < 1e-7 && off < 2e-3, "{off:.1e}");
    }

    /// Oracle: what is at rest stays there, until the input moves.
    #[test]
    fn it_begins_at_rest() {
        for (k, x) in [(2.0, 0.9), (5.0, -1.0), (-0.05, 0.8), (0.0, 0.4)] {
            let (mut lag, spring) = (StiffLag::default(), Spring { hardness: k, rest: 0.3, friction: Friction::NONE });
            let found: Vec<f64> =
                (0..50).map(|n| lag.step(0.1 * f64::from(n), x, (0.2, 0.1), spring, &mut Swing::default())).collect();
            assert!(found.iter().all(|z| (pulls(k, 0.3, *z) - x).abs() < 1e-9), "{k} {x}: {found:?}");
            assert_eq!(
                StiffLag::default().step(0.0, x, (0.0, 0.1), spring, &mut Swing::default()),
                x,
                "without a period there is no spring"
            );
        }
    }

    /// Whatever comes, it comes back: soft springs, periods of a fifth of a step, inputs beyond f64.
    #[test]
    fn it_stays_finite() {
        for (k, unit) in [(-0.5, 0.3), (2.0, 0.3), (2.0, 0.003), (-0.5, 0.003), (100.0, 0.1)] {
            let (mut lag, spring) = (StiffLag::default(), Spring { hardness: k, rest: 0.3, friction: Friction::NONE });
            for n in 0..400 {
                let x = if n % 50 == 7 { 1e200 } else { (0.7 * f64::from(n)).sin() };
                let z = lag.step(0.1 * f64::from(n), x, (unit, 0.05), spring, &mut Swing::default());
                assert!(z.is_finite() && (z - x).abs() <= FARTHEST + 1e-9 * x.abs(), "{k} {unit}: {z} at {x}");
            }
        }
    }
}
