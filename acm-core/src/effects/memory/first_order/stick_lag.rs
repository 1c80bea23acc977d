//! First-order lag with dry friction: τ ż = x − z − w sgn z; z rests at zero while |x| ≤ w; at rest at the first sample.
//!
//! Exact for an input that is linear between samples: between two zeros of z it is a lag of x − w sgn z. Its zeros are found by
//! bisection.

use crate::effects::memory::lag::relax;
use crate::effects::memory::{Point, State};

/// Bisections of the time at which z reaches zero.
const BISECTIONS: usize = 50;

/// Most motions and rests between two samples: behind a straight input z stops once, rests, and breaks away.
const TURNS: usize = 4;

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct StickLag {
    before: Option<Point>,
    z: f64,
}

impl State for StickLag {}

/// Motion between two samples: the input goes straight from `from` to `to` in `h` seconds.
struct Piece {
    from: f64,
    to: f64,
    h: f64,
    tau: f64,
}

impl Piece {
    fn input(&self, t: f64) -> f64 {
        self.from + (self.to - self.from) * t / self.h
    }

    /// z at `t` where it was `z` at `start` and has kept the sign, with friction `w` against it.
    fn moving(&self, z: f64, start: f64, t: f64, w: f64) -> f64 {
        let (past, x) = (self.input(start) - w, self.input(t) - w);
        relax((z, past, x), (self.to - self.from) / self.h * self.tau, (-(t - start) / self.tau).exp())
    }

    /// First time after `start` at which the input leaves −w … w; the end where it does not.
    fn breaks_away(&self, start: f64, w: f64) -> f64 {
        let slope = (self.to - self.from) / self.h;
        let leaves = start + (w * slope.signum() - self.input(start)) / slope;
        if slope == 0.0 { self.h } else { leaves.max(start).min(self.h) }
    }

    /// Time after `start` at which z reaches zero; its sign at the end is another than that of `w`.
    fn stops(&self, z: f64, start: f64, w: f64) -> f64 {
        let (mut low, mut high) = (start, self.h);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if self.moving(z, start, middle, w) * w.signum() > 0.0 { low = middle } else { high = middle }
        }
        high
    }

    fn end(&self, mut z: f64, width: f64) -> f64 {
        let mut t = 0.0;
        for _ in 0..TURNS {
            if z == 0.0 && self.input(t).abs() <= width {
                t = self.breaks_away(t, width);
                if t >= self.h {
                    return 0.0;
                }
            }
            // From rest it has the input's sign, or its slope's.
            let heading = [z, self.input(t), self.to - self.from].into_iter().find(|x| *x != 0.0).unwrap_or(0.0);
            let w = width.copysign(heading);
            let next = self.moving(z, t, self.h, w);
            if next * w.signum() >= 0.0 {
                return next;
            }
            (t, z) = (self.stops(z, t, w), 0.0);
        }
        z
    }
}

impl StickLag {
    /// z at the next sample; `tau` is τ, s, `width` is w. Without a lag it is x.
    pub fn step(&mut self, time: f64, x: f64, tau: f64, width: f64) -> f64 {
        self.z = match self.before.filter(|before| time > before.time) {
            _ if tau <= 1e-9 => x,
            Some(before) => Piece { from: before.x, to: x, h: time - before.time, tau }.end(self.z, width),
            None => x - x.clamp(-width, width),
        };
        self.before = Some(Point { time, x });
        self.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: 20,000 steps of Euler's method between two samples, which stop where the sign would turn.
    #[test]
    fn it_stops_rests_and_breaks_away() {
        let (tau, width) = (0.3, 0.4);
        let x = [0.0, 0.3, 1.2, 0.5, -0.1, -0.2, 0.35, -1.5, -1.4, 1.4, 0.0, 0.39, 0.41];
        let (mut lag, mut z) = (StickLag::default(), 0.0f64);
        assert_eq!(lag.step(0.0, x[0], tau, width), 0.0);
        for (k, x) in x.windows(2).enumerate() {
            let h = 0.2 / 20_000.0;
            for n in 0..20_000 {
                let input = x[0] + (x[1] - x[0]) * (f64::from(n) + 0.5) / 20_000.0;
                let next = match z == 0.0 {
                    true if input.abs() <= width => 0.0,
                    true => h / tau * (input - width * input.signum()),
                    false => z + h / tau * (input - z - width * z.signum()),
                };
                z = if next * z < 0.0 { 0.0 } else { next };
            }
            let found = lag.step(0.2 * (k + 1) as f64, x[1], tau, width);
            assert!((found - z).abs() < 2e-5, "{k}: {found} and {z}");
        }
    }

    /// Oracle: without friction it is the lag.
    #[test]
    fn without_friction_it_is_a_lag() {
        let (mut stick, mut lag, mut decay) =
            (StickLag::default(), crate::effects::memory::Lag::default(), Default::default());
        for k in 0..60 {
            let (time, x) = (0.1 * f64::from(k), (0.7 * f64::from(k)).cos());
            let truth = lag.step(time, x, 0.25, &mut decay);
            assert!((stick.step(time, x, 0.25, 0.0) - truth).abs() < 1e-9, "{k}");
        }
    }

    /// Whatever comes, it is no farther out than the input was.
    #[test]
    fn it_stays_finite() {
        let mut lag = StickLag::default();
        for n in 0..300 {
            let x = if n % 50 == 7 { 1e200 } else { f64::from(n).sin() };
            assert!(lag.step(0.1 * f64::from(n), x, 1e-6, 0.5).abs() <= 1e200, "{n}");
        }
    }
}
