//! First-order lag with one time constant up and another down: τ_u ż = x − z where x > z, τ_d ż = x − z where x < z; at rest at the
//! first sample.
//!
//! Exact for an input that is linear between samples. With slope m, x − z relaxes to m τ, and so passes zero at most once in a
//! piece, after t = τ ln(1 + (x − z)/(−m τ)); from there on z follows with the other time constant. With equal time constants it
//! is [`Lag`], bit for bit.

use crate::effects::memory::beside::Beside;
use crate::effects::memory::lag::relax;
use crate::effects::memory::{Lag, Last, Point, State};

/// The step of the last h, τ_u and τ_d: what [`Lag`] has for either.
pub type Decays = Last<(f64, [f64; 2]), [(f64, f64); 2]>;

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct AsymmetricLag {
    before: Option<Point>,
    z: f64,
}

impl State for AsymmetricLag {}

impl AsymmetricLag {
    /// z at the next sample; `taus` are τ_u and τ_d, s. Signals with the same time stamps share `decays`.
    #[inline]
    pub fn step(&mut self, time: f64, x: f64, taus: [f64; 2], decays: &mut Decays) -> f64 {
        let (h, past) = Point::since(self.before, time, x);
        let strides = decays.of((h, taus), || taus.map(|tau| Lag::stride(h, tau)));
        self.before = Some(Point { time, x });
        self.z = end(self.z, [past, x], h, taus, strides);
        self.z
    }
}

/// z after a piece of `h` s, in which the input goes from `past` to `x`.
fn end(z: f64, [past, x]: [f64; 2], h: f64, taus: [f64; 2], strides: [(f64, f64); 2]) -> f64 {
    // A state at the input moves the way the input moves.
    let ahead = if z == past { x - past } else { past - z };
    let way = usize::from(ahead < 0.0);
    let (decay, lasting) = strides[way];
    let next = relax((z, past, x), (x - past) * lasting, decay);
    if (x - next) * ahead.signum() >= 0.0 || taus[0] == taus[1] {
        return next;
    }
    let (slope, tau) = ((x - past) / h, taus[way]);
    let passes = (tau * ((past - z) / (-slope * tau)).max(0.0).ln_1p()).min(h);
    let input = past + slope * passes;
    let (decay, lasting) = Lag::stride(h - passes, taus[1 - way]);
    relax((input, input, x), (x - input) * lasting, decay)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TAUS: [f64; 2] = [0.9, 0.2];

    /// z after samples, the first of which is at rest.
    fn through(samples: &[(f64, f64)], taus: [f64; 2]) -> Vec<f64> {
        let (mut lag, mut decays) = (AsymmetricLag::default(), Decays::default());
        samples.iter().map(|(time, x)| lag.step(*time, *x, taus, &mut decays)).collect()
    }

    /// 4000 steps of classical Runge–Kutta for one piece of `h` s; the kink costs it a little of its order.
    fn integrated(mut z: f64, [past, x]: [f64; 2], h: f64, [up, down]: [f64; 2]) -> f64 {
        const STEPS: usize = 4000;
        let input = |at: f64| past + (x - past) * at / STEPS as f64;
        let f = |at: f64, z: f64| (input(at) - z) / if input(at) > z { up } else { down };
        let step = h / STEPS as f64;
        for n in 0..STEPS {
            let n = n as f64;
            let a = f(n, z);
            let b = f(n + 0.5, z + 0.5 * step * a);
            let c = f(n + 0.5, z + 0.5 * step * b);
            let d = f(n + 1.0, z + step * c);
            z += step / 6.0 * (a + 2.0 * b + 2.0 * c + d);
        }
        z
    }

    /// Oracle: Runge–Kutta behind a sum of sines that is straight between irregular samples, some of them many time constants long.
    #[test]
    fn it_follows_its_equation() {
        let x = |t: f64| (1.1 * t).sin() + 0.6 * (2.9 * t + 1.0).cos() + 0.3 * (7.3 * t).sin();
        let mut time = vec![0.0];
        for k in 0..200 {
            time.push(time[k] + if k % 20 == 19 { 4.0 } else { 0.02 + 0.07 * (k % 5) as f64 });
        }
        let samples: Vec<(f64, f64)> = time.iter().map(|t| (*t, x(*t))).collect();
        for taus in [TAUS, [0.2, 0.9], [0.05, 3.0]] {
            let found = through(&samples, taus);
            let mut z = samples[0].1;
            for (k, pair) in samples.windows(2).enumerate() {
                z = integrated(z, [pair[0].1, pair[1].1], pair[1].0 - pair[0].0, taus);
                assert!((found[k + 1] - z).abs() < 1e-6, "{taus:?} at {k}: {} and {z}", found[k + 1]);
            }
        }
    }

    /// Oracle: by hand. From z = 0 behind 1 − t with τ_u = 1: z = 2 − t − 2 e^{−t} meets the input at t = ln 2, at 1 − ln 2; from there
    /// the input leads by τ_d = ½ times 1 − e^{−2(t − ln 2)}: at t = 3, z = −2 + ½ (1 − 4 e^{−6}). In one sample, and in thirty.
    #[test]
    fn the_input_is_met_within_a_long_sample() {
        let truth = -2.0 + 0.5 * (1.0 - 4.0 * (-6.0f64).exp());
        let start = [(0.0, 0.0), (1e-12, 1.0)];
        for pieces in [1, 30] {
            let fall = (1..=pieces).map(|k| 3.0 * f64::from(k) / f64::from(pieces)).map(|t| (1e-12 + t, 1.0 - t));
            let samples: Vec<(f64, f64)> = start.into_iter().chain(fall).collect();
            let z = through(&samples, [1.0, 0.5])[samples.len() - 1];
            assert!((z - truth).abs() < 1e-10, "{pieces}: {z} and {truth}");
        }
    }

    /// Oracle: turned over, up is down.
    #[test]
    fn upside_down_the_times_change_places() {
        let samples: Vec<(f64, f64)> = (0..90).map(|k| (0.3 * f64::from(k), (0.8 * f64::from(k)).sin())).collect();
        let over: Vec<(f64, f64)> = samples.iter().map(|(time, x)| (*time, -x)).collect();
        let turned: Vec<f64> = through(&over, [TAUS[1], TAUS[0]]).into_iter().map(|z| -z).collect();
        assert_eq!(through(&samples, TAUS), turned);
    }

    /// Oracle: the lag, to the last bit, with time stamps that repeat; and no lag where there is no time.
    #[test]
    fn alike_it_is_a_lag() {
        let (mut lag, mut decay) = (Lag::default(), Default::default());
        let samples: Vec<(f64, f64)> =
            (0..90).map(|k| (0.1 * f64::from(k - k % 7 / 6), (0.7 * f64::from(k)).cos())).collect();
        let truth: Vec<f64> = samples.iter().map(|(time, x)| lag.step(*time, *x, 0.25, &mut decay)).collect();
        assert_eq!(through(&samples, [0.25; 2]), truth);
        assert!(through(&samples, [0.0; 2]).iter().zip(&samples).all(|(z, (_, x))| z == x));
    }

    /// Whatever comes, it is no farther out than the input was.
    #[test]
    fn it_stays_finite() {
        let x = |n: i32| if n % 50 == 7 { 1e200 } else { f64::from(n).sin() };
        let samples: Vec<(f64, f64)> = (0..300).map(|n| (0.1 * f64::from(n - n % 3), x(n))).collect();
        for taus in [[1e-6, 0.3], [0.3, 1e-6], [1e-300, 1e12], [0.0, 0.1], [5.0, 0.0]] {
            assert!(through(&samples, taus).iter().all(|z| z.abs() <= 1.001e200), "{taus:?}");
        }
    }
}
