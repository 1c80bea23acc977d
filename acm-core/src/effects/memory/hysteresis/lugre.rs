//! Bristles of LuGre friction, whose deflection in units of the sliding one grows with less speed; at rest at the first sample.
//!
//! ```text
//! s ḋ = ẋ − |ẋ| d/g(ẋ),   g = 1 + r e^{−(ẋ/v)²}
//! ```
//!
//! A straight piece of x has one speed and so one g: there d relaxes to ±g over the way s g, whatever the length of the piece. At
//! r = 0 it is Dahl's state, to the last bit.

use crate::effects::memory::{Point, State};

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct LuGre {
    before: Option<Point>,
    d: f64,
}

impl State for LuGre {}

impl LuGre {
    /// d at the next sample; `presliding` is s, `surplus` is r, `speed` is v.
    #[inline]
    pub fn step(&mut self, time: f64, x: f64, presliding: f64, surplus: f64, speed: f64) -> f64 {
        let (h, past) = Point::since(self.before, time, x);
        let step = x - past;
        if step != 0.0 {
            let way = step.abs() / presliding.max(f64::MIN_POSITIVE);
            let u = step / h / speed;
            let most = 1.0 + surplus * (-u * u).exp();
            let d = step.signum() * self.d;
            self.d = step.signum() * (d - (most - d) * (-way / most).exp_m1());
        }
        self.before = Some(Point { time, x });
        self.d
    }
}

#[cfg(test)]
mod tests {
    use super::super::BoucWen;
    use super::*;

    /// d at the end of a motion from rest to rest and back, x = (1 − cos t)/2, of `samples` straight pieces; its turn is at a sample.
    fn swung(samples: usize) -> f64 {
        let (mut bristles, mut d) = (LuGre::default(), 0.0);
        for k in 0..=samples {
            let t = 5.0 * k as f64 / samples as f64 * std::f64::consts::PI / 4.0;
            d = bristles.step(t, 0.5 * (1.0 - t.cos()), 0.05, 1.5, 0.3);
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
        let (end, steps) = (5.0 * std::f64::consts::PI / 4.0, 400_000);
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
        assert!(coarse < 1e-3 && (order - 2.0).abs() < 0.1, "{coarse:.1e}, order {order:.2}");
    }

    /// Oracle: sliding at a constant speed v_k: g = 1 + r e^{−(v_k/v)²}, by hand 1 + 2/e at v, 3 far below it and 1 far above.
    #[test]
    fn sliding_ends_at_the_stribeck_curve() {
        let slow = 1.735_758_882_342_884_7;
        for (speed, most) in [(0.2f64, slow), (-0.2, -slow), (1e-4, 3.0), (-9.0, -1.0)] {
            let (mut bristles, mut d) = (LuGre::default(), 0.0);
            for k in 0..200 {
                let time = 0.1 * f64::from(k) / speed.abs();
                d = bristles.step(time, speed * time, 0.05, 2.0, 0.2);
            }
            assert!((d - most).abs() < 1e-6, "{speed}: {d} and {most}");
        }
    }

    /// Oracle: Dahl's state, to the last bit.
    #[test]
    fn without_a_surplus_it_is_dahls() {
        let (mut bristles, mut dahl) = (LuGre::default(), BoucWen::default());
        for k in 0..300 {
            let (time, x) = (0.05 * f64::from(k), (0.9 * f64::from(k)).sin() + 0.3 * (0.13 * f64::from(k)).cos());
            let (found, truth) = (bristles.step(time, x, 0.4, 0.0, 0.7), dahl.dahl(x, 0.4));
            assert_eq!(found.to_bits(), truth.to_bits(), "{k}");
        }
    }

    /// Whatever comes, jumps at one time too, no bristle is bent farther than breaking away takes.
    #[test]
    fn it_stays_within_the_breakaway() {
        let mut bristles = LuGre::default();
        for k in 0..300 {
            let x = if k % 50 == 7 { 1e200 } else { f64::from(k).sin() };
            let d = bristles.step(0.1 * f64::from(k - k % 3), x, 1e-6, 3.0, 1e-3);
            assert!(d.abs() <= 4.0, "{k}: {d}");
        }
    }
}
