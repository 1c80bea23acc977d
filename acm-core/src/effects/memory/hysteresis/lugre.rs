//! LuGre bristle deflection, in units of that of fast sliding; larger at low speed, 0 at the first sample.
//!
//! ```text
//! s ḋ = v − |v| d/g(v),   g = 1 + r e^{−(v/w)²}
//! ```
//!
//! The speed is linear between samples, and an interval is split where it changes sign: a reversal within an interval is seen even
//! if its net displacement is zero. Each piece is taken at its mean speed, where d relaxes to ±g over the length s g. At r = 0 it
//! is Dahl's state over the same displacements.

use super::super::{Point, State};

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct LuGre {
    before: Option<Point>,
    d: f64,
}

impl State for LuGre {}

impl LuGre {
    /// d at the next sample; `rate` is v, `presliding` is s, `surplus` is r, `speed` is w.
    #[inline]
    pub fn step(&mut self, time: f64, rate: f64, presliding: f64, surplus: f64, speed: f64) -> f64 {
        let (h, past) = Point::since(self.before, time, rate);
        let slide = |d: f64, h: f64, mean: f64| {
            let way = mean.abs() * h / presliding.max(f64::MIN_POSITIVE);
            let u = mean / speed;
            let most = 1.0 + surplus * (-u * u).exp();
            let d = mean.signum() * d;
            mean.signum() * (d - (most - d) * (-way / most).exp_m1())
        };
        if past * rate < 0.0 {
            let turn = past / (past - rate);
            self.d = slide(self.d, turn * h, 0.5 * past);
            self.d = slide(self.d, (1.0 - turn) * h, 0.5 * rate);
        } else if past != 0.0 || rate != 0.0 {
            self.d = slide(self.d, h, 0.5 * (past + rate));
        }
        self.before = Some(Point { time, x: rate });
        self.d
    }
}

#[cfg(test)]
mod tests {
    use super::super::BoucWen;
    use super::*;

    /// d at the end of a motion of the speed ½ sin t through a turn at π, which lies within a piece.
    fn swung(samples: usize) -> f64 {
        let (mut bristles, mut d) = (LuGre::default(), 0.0);
        for k in 0..=samples {
            let t = 4.0 * k as f64 / samples as f64;
            d = bristles.step(t, 0.5 * t.sin(), 0.05, 1.5, 0.3);
        }
        d
    }

    /// Oracle: 400,000 steps of classical Runge–Kutta along the sine itself. Halving the pieces divides the error by four.
    #[test]
    fn pieces_converge_to_a_sine_at_second_order() {
        let f = |t: f64, d: f64| {
            let speed = 0.5 * t.sin();
            let g = 1.0 + 1.5 * (-(speed / 0.3) * (speed / 0.3)).exp();
            (speed - speed.abs() * d / g) / 0.05
        };
        let (end, steps) = (4.0, 400_000);
        let (h, mut d) = (end / f64::from(steps), 0.0);
        for k in 0..steps {
            let t = h * f64::from(k);
            let a = f(t, d);
            let b = f(t + 0.5 * h, d + 0.5 * h * a);
            let c = f(t + 0.5 * h, d + 0.5 * h * b);
            let e = f(t + h, d + h * c);
            d += h / 6.0 * (a + 2.0 * b + 2.0 * c + e);
        }
        let (coarse, fine) = ((swung(500) - d).abs(), (swung(1000) - d).abs());
        let order = (coarse / fine).log2();
        assert!(coarse < 1e-3 && (order - 2.0).abs() < 0.3, "{coarse:.1e}, order {order:.2}");
    }

    /// Oracle: sliding at a constant speed v: g = 1 + r e^{−(v/w)²}, by hand 1 + 2/e at w, 3 far below it and 1 far above.
    #[test]
    fn sliding_ends_at_the_stribeck_curve() {
        let slow = 1.735_758_882_342_884_7;
        for (speed, most) in [(0.2f64, slow), (-0.2, -slow), (1e-4, 3.0), (-9.0, -1.0)] {
            let (mut bristles, mut d) = (LuGre::default(), 0.0);
            for k in 0..200 {
                d = bristles.step(0.1 * f64::from(k) / speed.abs(), speed, 0.05, 2.0, 0.2);
            }
            assert!((d - most).abs() < 1e-6, "{speed}: {d} and {most}");
        }
    }

    /// Oracle: Dahl's state over the ways of straight speeds, ½ h (v + v′), cut where they turn round.
    #[test]
    fn without_a_surplus_it_is_dahls() {
        let (mut bristles, mut dahl) = (LuGre::default(), BoucWen::default());
        let rate = |k: i32| 18.0 * (0.9 * f64::from(k)).cos() + 0.8 * (0.13 * f64::from(k)).sin();
        let (mut x, mut truth) = (0.0, dahl.dahl(0.0, 0.4));
        for k in 0..300 {
            if k > 0 {
                let (before, now) = (rate(k - 1), rate(k));
                let turn = if before * now < 0.0 { before / (before - now) } else { 1.0 };
                let ways = if turn < 1.0 { [turn * before, (1.0 - turn) * now] } else { [before + now, 0.0] };
                for way in ways {
                    x += 0.5 * 0.05 * way;
                    truth = dahl.dahl(x, 0.4);
                }
            }
            let found = bristles.step(0.05 * f64::from(k), rate(k), 0.4, 0.0, 0.7);
            assert!((found - truth).abs() < 1e-9, "{k}: {found} and {truth}");
        }
    }

    /// Oracle: by hand: from rest to −1 and back to 1 m/s within one interval of 0.1 s, 25 mm each way, on which bristles of 25 mm relax by
    /// 1 − 1/e: no way between the ends, and yet they are bent.
    #[test]
    fn a_turn_within_an_interval_is_seen() {
        let mut bristles = LuGre::default();
        bristles.step(0.0, -1.0, 0.025, 0.0, 1.0);
        let found = bristles.step(0.1, 1.0, 0.025, 0.0, 1.0);
        let faded = (-1.0f64).exp();
        let truth = 1.0 - faded - faded * (1.0 - faded);
        assert!((found - truth).abs() < 1e-9, "{found} and {truth}");
    }

    /// Whatever comes, jumps at one time too, no bristle is bent farther than breaking away takes.
    #[test]
    fn it_stays_within_the_breakaway() {
        let mut bristles = LuGre::default();
        for k in 0..300 {
            let rate = if k % 50 == 7 { 1e200 } else { f64::from(k).sin() };
            let d = bristles.step(0.1 * f64::from(k - k % 3), rate, 1e-6, 3.0, 1e-3);
            assert!(d.abs() <= 4.0, "{k}: {d}");
        }
    }
}
