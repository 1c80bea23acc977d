//! Smoothed value, first and second derivative of a noisy signal on irregular time stamps: a local polynomial in a window around
//! each sample.
//!
//! ```text
//! min over c of Σ_k w_k (x_k − Σ_j c_j τ_k^j)²,   w_k = (1 − (τ_k/h)²)² where |τ_k| < h,   x̃ = c_0,   ẋ = c_1,   ẍ = 2 c_2
//! ```
//!
//! | symbol | meaning                                   | unit |
//! | `τ_k`  | t_k − t, time from the sample             | s    |
//! | `h`    | window: half its width                    | s    |
//!
//! A parabola, j ≤ 2, or a quartic, j ≤ 4. Of a sine a parabola loses ω²h²/18 of the rate and ω²h²/22 of the acceleration, and a
//! quartic a fourteenth of that at most. The window is cut off at the ends of the known samples. The newest sample of a stream has
//! a past only: there a parabola's derivatives are about ten times as noisy, and a quartic's more. Weights that fade to the edge
//! make the result smooth in h, as a gradient search needs. For N uniform samples within the window, far from the ends and with
//! white noise σ, a parabola has var c_1 = 70 σ²/(11 N h²). A sharp edge would have 3 σ²/(N h²), the same at 0.78 h, and jump with
//! h. Fan & Gijbels (1996), Local Polynomial Modelling, ch. 3.
//!
//! No window is narrower than 1.6 times the reach of the five samples nearest by index; h = 0 means this window for derivatives.
//! There a parabola is used; the quartic is blended in up to twice that window. The signal itself is unsmoothed at h = 0, and up
//! to the narrowest window smoothed in proportion to h.
//!
//! Linear in the number of samples: running sums of powers in blocks of length h, each about its own middle, lose no more than
//! three digits.

mod windows;

use windows::{POWERS, PRODUCTS, Sums, TOGETHER, Windows, parabola};

use super::{State, take_room};
use crate::slope::slope_at;

/// Samples that a window must hold.
const FEWEST: usize = 5;

/// Narrowest window over the reach of these samples.
const NARROWEST: f64 = 1.6;

/// Most samples on either side in a narrowest window.
const NEAR: usize = 8;

/// Samples per second that memory is reserved for.
const FASTEST: f64 = 1000.0;

/// The polynomial at the sample.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Derivative {
    /// x̃, the smoothed signal.
    pub value: f64,
    /// ẋ, per second.
    pub rate: f64,
    /// ẍ, per second².
    pub acceleration: f64,
}

/// See the head of this file.
#[derive(Debug, Default)]
pub struct Derivatives {
    is_quartic: bool,
    time: Vec<f64>,
    x: Vec<f64>,
    block: Option<Block>,
    /// Sums over the first 0, 1, … samples from `block.from` on.
    sums: Vec<Sums>,
    found: Vec<Derivative>,
}

/// Samples whose windows share sums.
#[derive(Debug, Clone, Copy)]
struct Block {
    /// Time of its first sample, s, and the signal there.
    start: f64,
    x: f64,
    /// First sample of any window.
    from: usize,
    /// The window of the last requested sample.
    window: (usize, usize),
}

/// Samples whose windows are fitted together.
#[derive(Debug, Default)]
struct Waiting {
    windows: Windows,
    /// Index of each sample among those kept, and among those requested.
    samples: [(usize, usize); TOGETHER],
}

impl Clone for Derivatives {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, other: &Self) {
        self.is_quartic = other.is_quartic;
        take_room(&mut self.time, &other.time);
        take_room(&mut self.x, &other.x);
        take_room(&mut self.sums, &other.sums);
        take_room(&mut self.found, &other.found);
        self.block = other.block;
    }
}

impl State for Derivatives {
    fn restart(&mut self) {
        self.time.clear();
        self.x.clear();
        self.sums.clear();
        self.block = None;
    }
}

impl Derivatives {
    /// By quartics, for whole records; parabolas are the default.
    pub fn quartic() -> Self {
        Self { is_quartic: true, ..Self::default() }
    }

    /// Derivatives at the next samples; `window` is h, s, the same for the whole trial.
    pub fn of(&mut self, time: &[f64], x: &[f64], window: f64) -> &[Derivative] {
        self.make_room(window);
        let first = self.time.len();
        self.time.extend_from_slice(time);
        self.x.extend_from_slice(x);
        self.found.clear();
        let mut waiting = Waiting::default();
        for t in first..self.time.len() {
            let narrowest = narrowest(&self.time, t);
            // Blocks begin by time alone, independent of later samples.
            let block = (window > 0.0).then(|| self.block_of(t, window, &mut waiting));
            self.found.push(Derivative::default());
            match block.filter(|_| narrowest > 0.0 && window >= narrowest) {
                Some(block) => {
                    let (sums, centre) = self.sums_of(t, window, block);
                    let share = if self.is_quartic { (window / narrowest - 1.0).min(1.0) } else { 0.0 };
                    waiting.samples[waiting.windows.len()] = (t, t - first);
                    waiting.windows.push(&sums, centre, share);
                    if waiting.windows.is_full() {
                        self.fit(&mut waiting, window);
                    }
                }
                None => {
                    let near = near(&self.time, &self.x, t, narrowest, window.max(0.0));
                    self.found[t - first] = near.unwrap_or_else(|| self.line(t));
                }
            }
        }
        self.fit(&mut waiting, window);
        self.forget();
        &self.found
    }

    /// Result where a window holds too little.
    fn line(&self, t: usize) -> Derivative {
        Derivative { value: self.x[t], rate: slope_at(&self.time, &self.x, t), acceleration: 0.0 }
    }

    /// The block of sample `t`; a new one where the last one has ended.
    fn block_of(&mut self, t: usize, h: f64, waiting: &mut Waiting) -> Block {
        let block = match self.block {
            Some(block) if self.time[t] < block.start + h => block,
            _ => {
                self.fit(waiting, h);
                self.begin(t, h)
            }
        };
        self.block = Some(block);
        block
    }

    /// The sums over the window of sample `t`, and the time from the middle of the block to the sample, in windows.
    fn sums_of(&mut self, t: usize, h: f64, mut block: Block) -> (Sums, f64) {
        self.sum_up(&block, h);
        let (now, (mut low, mut high)) = (self.time[t], block.window);
        while self.time[low] <= now - h {
            low += 1;
        }
        while high < self.time.len() && self.time[high] < now + h {
            high += 1;
        }
        block.window = (low, high);
        self.block = Some(block);
        let (before, until) = (&self.sums[low - block.from], &self.sums[high - block.from]);
        (std::array::from_fn(|k| until[k] - before[k]), (now - block.start) / h - 0.5)
    }

    /// Fits what waits, all of one block.
    fn fit(&mut self, waiting: &mut Waiting, h: f64) {
        let Some(block) = self.block else { return };
        let fitted = waiting.windows.fitted();
        for (fitted, (t, k)) in fitted.into_iter().zip(waiting.samples) {
            let found = fitted.map(|[value, rate, bend]| Derivative {
                value: block.x + value,
                rate: rate / h,
                acceleration: 2.0 * bend / (h * h),
            });
            self.found[k] = found.unwrap_or_else(|| self.line(t));
        }
        waiting.windows.clear();
    }

    /// A new block whose first sample is `t`.
    fn begin(&mut self, t: usize, h: f64) -> Block {
        let start = self.time[t];
        let from = self.time.partition_point(|time| *time <= start - h);
        self.sums.clear();
        self.sums.push([0.0; POWERS + PRODUCTS]);
        Block { start, x: self.x[t], from, window: (from, from) }
    }

    /// Continues the sums as far as the block's windows and known samples reach.
    fn sum_up(&mut self, block: &Block, h: f64) {
        let mut k = block.from + self.sums.len() - 1;
        while k < self.time.len() && self.time[k] < block.start + 2.0 * h {
            let (s, x) = ((self.time[k] - block.start) / h - 0.5, self.x[k] - block.x);
            let mut sums = self.sums[k - block.from];
            let mut power = 1.0;
            for j in 0..POWERS {
                sums[j] += power;
                if j < PRODUCTS {
                    sums[POWERS + j] += power * x;
                }
                power *= s;
            }
            self.sums.push(sums);
            k += 1;
        }
    }

    /// Drops samples beyond all windows, once they are half of all.
    fn forget(&mut self) {
        let near = self.time.len().saturating_sub(NEAR);
        let stale = self.block.map_or(near, |block| block.from.min(near));
        if 2 * stale > self.time.len() {
            self.time.drain(..stale);
            self.x.drain(..stale);
            if let Some(block) = &mut self.block {
                block.from -= stale;
                block.window = (block.window.0 - stale, block.window.1 - stale);
            }
        }
    }

    fn make_room(&mut self, window: f64) {
        let room = 5 * NEAR + (6.0 * FASTEST * window.clamp(0.0, 60.0)) as usize;
        if self.time.capacity() < room {
            self.time.reserve(room - self.time.len());
            self.x.reserve(room - self.x.len());
            self.sums.reserve(room - self.sums.len().min(room));
        }
    }
}

/// The narrowest window of sample `t`, s.
fn narrowest(time: &[f64], t: usize) -> f64 {
    let first = t.saturating_sub(FEWEST / 2).min(time.len().saturating_sub(FEWEST));
    let last = (first + FEWEST).min(time.len()) - 1;
    NARROWEST * (time[last] - time[t]).max(time[t] - time[first])
}

/// The parabola of a narrowest window h, where the requested one, `asked`, is narrower.
fn near(time: &[f64], x: &[f64], t: usize, h: f64, asked: f64) -> Option<Derivative> {
    let mut s = [0.0; 8];
    for k in t.saturating_sub(NEAR)..(t + NEAR + 1).min(time.len()) {
        let (u, y) = ((time[k] - time[t]) / h, x[k] - x[t]);
        let weight = (1.0 - u * u).max(0.0).powi(2);
        let powers = [1.0, u, u * u, u * u * u, u * u * u * u, y, y * u, y * u * u];
        s.iter_mut().zip(powers).for_each(|(s, power)| *s += weight * power);
    }
    let ([value, rate, bend], told) = parabola(&s);
    told.iter().all(|told| *told > 0.0).then(|| Derivative {
        value: x[t] + (asked / h).min(1.0) * value,
        rate: rate / h,
        acceleration: 2.0 * bend / (h * h),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn jittered(samples: usize, step: f64) -> Vec<f64> {
        (0..samples).map(|k| 1e4 + step * (k as f64 + 0.7 * (0.618 * k as f64).fract())).collect()
    }

    fn both() -> [Derivatives; 2] {
        [Derivatives::default(), Derivatives::quartic()]
    }

    /// Oracle: the derivatives of a parabola, everywhere and on irregular time stamps far from zero.
    #[test]
    fn a_parabola_has_its_derivatives() {
        let time = jittered(400, 0.01);
        let x: Vec<f64> = time.iter().map(|t| 7e5 - 40.0 * (t - 1e4) + 3.0 * (t - 1e4).powi(2)).collect();
        let windows = [0.0, 0.015, 0.04, 0.3, 1.7, 50.0].into_iter();
        for (mut of, window) in windows.flat_map(|window| both().map(|of| (of, window))) {
            let found = of.of(&time, &x, window).to_vec();
            for (k, (t, found)) in time.iter().zip(&found).enumerate() {
                let rate = -40.0 + 6.0 * (t - 1e4);
                assert!((found.value - x[k]).abs() < 1e-6, "{window} s, sample {k}: {found:?}, {}", x[k]);
                assert!((found.rate - rate).abs() < 1e-5, "{window} s, sample {k}: {found:?}, {rate}");
                assert!((found.acceleration - 6.0).abs() < 2e-2, "{window} s, sample {k}: {found:?}");
            }
        }
    }

    /// Oracle: sums over each window as they are written, and an LU decomposition.
    #[test]
    fn running_sums_are_those_of_each_window() {
        let time = jittered(300, 0.1);
        let x: Vec<f64> =
            (0..300).map(|k| (0.37 * f64::from(k)).sin() + 0.2 * (1.7 * f64::from(k * k)).cos()).collect();
        for (h, degree) in [0.45, 1.3, 6.0, 100.0].into_iter().flat_map(|h| [(h, 2), (h, 4)]) {
            let mut of = if degree == 2 { Derivatives::default() } else { Derivatives::quartic() };
            let found = of.of(&time, &x, h).to_vec();
            for (t0, found) in time.iter().zip(&found) {
                let near: Vec<(f64, f64)> =
                    time.iter().zip(&x).map(|(t, x)| (t - t0, *x)).filter(|(u, _)| u.abs() < h).collect();
                // From here on it is a quartic as a whole.
                if near.len() < 17 {
                    continue;
                }
                let sum = |k: i32, l: i32| {
                    near.iter().map(|(u, x)| (1.0 - u * u / (h * h)).powi(2) * u.powi(k) * x.powi(l)).sum::<f64>()
                };
                let ridge = |i: usize| if i > 2 { 1e-4 * sum(0, 0) * h.powi(2 * i as i32) } else { 0.0 };
                let m = nalgebra::DMatrix::from_fn(degree + 1, degree + 1, |i, j| {
                    sum((i + j) as i32, 0) + if i == j { ridge(i) } else { 0.0 }
                });
                let exact = m.lu().solve(&nalgebra::DVector::from_fn(degree + 1, |i, _| sum(i as i32, 1))).unwrap();
                let scale = 1.0 + exact[1].abs().max(exact[2].abs());
                assert!((found.value - exact[0]).abs() < 1e-7 * scale, "{h}: {found:?} {exact}");
                assert!((found.rate - exact[1]).abs() < 1e-7 * scale, "{h}: {found:?} {exact}");
                assert!((found.acceleration - 2.0 * exact[2]).abs() < 1e-6 * scale, "{h}: {found:?} {exact}");
            }
        }
    }

    /// Oracle: the closed form of the variance at the middle, with N = 2h/d. By linearity it is the sum of squares of the
    /// answers to unit impulses.
    #[test]
    fn white_noise_fades_as_the_closed_form_says() {
        let (d, h, samples) = (0.01, 0.5, 201);
        let time: Vec<f64> = (0..samples).map(|k| d * f64::from(k)).collect();
        let answer = |k: i32| {
            let x: Vec<f64> = (0..samples).map(|j| if j == k { 1.0 } else { 0.0 }).collect();
            Derivatives::default().of(&time, &x, h)[100].rate
        };
        let variance: f64 = (0..samples).map(|k| answer(k).powi(2)).sum();
        let closed = 70.0 / (11.0 * (2.0 * h / d) * h * h);
        assert!((variance / closed - 1.0).abs() < 0.01, "{variance} {closed}");
    }

    /// Time stamps that are all alike, windows below rounding and beyond all time: nothing fails.
    #[test]
    fn odd_times_and_windows() {
        for window in [0.0, 1e-300, 1e-20, 1.0, 1e300, -1.0] {
            for time in [vec![5.0; 12], (0..12).map(|k| 1e9 + f64::from(k / 3)).collect(), vec![3.0, 2.0, 9.0, 1.0]] {
                let x: Vec<f64> = (0..time.len()).map(|k| k as f64).collect();
                let found = Derivatives::default().of(&time, &x, window).to_vec();
                assert!(
                    found.iter().all(|d| [d.value, d.rate, d.acceleration].iter().all(|x| x.is_finite())),
                    "{window}: {found:?}"
                );
            }
        }
    }

    /// Oracle: Taylor's series of a sine and the moments of the weight, 1/7, 1/21, 5/231 and 5/429: a parabola loses ω²h²/18 of the rate and
    /// ω²h²/22 of the acceleration, a quartic the shares of these that the ridge takes off τ³ and τ⁴.
    #[test]
    fn a_quartic_leaves_a_sine_as_it_is() {
        let (h, omega) = (0.4, std::f64::consts::TAU / 6.4);
        let time: Vec<f64> = (0..2000).map(|k| 0.01 * f64::from(k)).collect();
        let x: Vec<f64> = time.iter().map(|t| (omega * t).sin()).collect();
        let [lost, kept] = both().map(|mut of| {
            let found = of.of(&time, &x, h)[200..1800].to_vec();
            let most = |of: &dyn Fn(&Derivative) -> f64| found.iter().map(of).fold(0.0, f64::max);
            [most(&|d| d.rate) / omega, most(&|d| d.acceleration) / omega.powi(2)].map(|share| 1.0 - share)
        });
        let square = (omega * h).powi(2);
        let (cubic, even) = (5.0 / 231.0 - 7.0 / 441.0, [1.0 / 21.0 - 1.0 / 49.0, 5.0 / 231.0 - 1.0 / 147.0]);
        let quartic = 5.0 / 429.0 - 1.0 / 441.0 - even[1] * even[1] / even[0];
        for (k, (part, own)) in [(18.0, cubic), (22.0, quartic)].into_iter().enumerate() {
            let due = square / part;
            assert!((lost[k] / due - 1.0).abs() < 0.02, "{lost:?}, {due}");
            let left = due * 1e-4 / (own + 1e-4);
            assert!((kept[k] - left).abs() < 0.02 * due, "{kept:?}, {left}");
        }
    }

    /// The result has no jumps in h, on irregular time stamps too: a search can follow its slope.
    #[test]
    fn it_is_continuous_in_the_window() {
        let time = jittered(60, 1.0);
        let x: Vec<f64> = (0..60).map(|k| (0.9 * f64::from(k)).sin()).collect();
        let at = |h: f64| Derivatives::quartic().of(&time, &x, h).to_vec();
        let off = |a: Vec<Derivative>, b: Vec<Derivative>| {
            let apart = |(a, b): (&Derivative, &Derivative)| (a.rate - b.rate).abs().max((a.value - b.value).abs());
            a.iter().zip(&b).map(apart).fold(0.0f64, f64::max)
        };
        // From one h to the next, so that no jump falls between two.
        for k in 0..4000 {
            let [h, next] = [k, k + 1].map(|k| 0.002 * f64::from(k));
            assert!(off(at(h), at(next)) < 0.01, "{h}: {}", off(at(h), at(next)));
        }
        assert!(off(at(3.0), at(6.0)) > 0.1, "it does depend on h");
    }

    /// Oracle: a stream that is shown the whole so far. The same bits, and little is kept.
    #[test]
    fn the_newest_sample_is_the_end_of_what_is_known() {
        let time = jittered(500, 0.05);
        let x: Vec<f64> = (0..500).map(|k| (0.05 * f64::from(k)).sin()).collect();
        for h in [0.0, 0.3, 2.0] {
            let mut stream = Derivatives::default();
            for t in 0..500 {
                let found = stream.of(&time[t..=t], &x[t..=t], h)[0];
                let whole = Derivatives::default().of(&time[..=t], &x[..=t], h)[t];
                assert_eq!(found, whole, "{h} s, sample {t}");
            }
            assert!(stream.time.len() < 20 + (8.0 * h / 0.05) as usize, "{} are kept", stream.time.len());
            stream.restart();
            assert_eq!(stream.of(&[0.0], &[3.0], h), [Derivative { value: 3.0, ..Derivative::default() }]);
        }
    }
}
