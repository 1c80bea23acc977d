//! Polynomials in several windows at a time, as many as a vector register holds; bit for bit as one at a time.

use pulp::{Arch, Simd, WithSimd};

use crate::kinematics::lanes::{Register, Wide};
use crate::kinematics::real::Real;

/// Windows that are fitted together.
pub(super) const TOGETHER: usize = 8;

/// Powers of time that are summed up, 0 to 12, and those times the signal, 0 to 8.
pub(super) const POWERS: usize = 13;
pub(super) const PRODUCTS: usize = 9;

/// Sums of powers, and of those times the signal.
pub(super) type Sums = [f64; POWERS + PRODUCTS];

/// Ridge on τ³ and τ⁴ of the quartic, as a share of the samples: shrinks them by 2 and 7 % where samples fill the window, and to
/// the parabola where they are undetermined.
const RIDGE: f64 = 1e-4;

/// Sums over windows, and what is fitted to them.
#[derive(Debug, Default)]
pub(super) struct Windows {
    count: usize,
    /// The sums about the middle of a block, and the time from there to the sample, in windows.
    sums: [[f64; TOGETHER]; POWERS + PRODUCTS],
    centre: [f64; TOGETHER],
    /// Share of the quartic; the rest is the parabola.
    share: [f64; TOGETHER],
}

impl Windows {
    pub(super) fn len(&self) -> usize {
        self.count
    }

    pub(super) fn is_full(&self) -> bool {
        self.count == TOGETHER
    }

    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// One more; they must not be full.
    pub(super) fn push(&mut self, sums: &Sums, centre: f64, share: f64) {
        self.sums.iter_mut().zip(sums).for_each(|(row, sum)| row[self.count] = *sum);
        (self.centre[self.count], self.share[self.count]) = (centre, share);
        self.count += 1;
    }

    /// c_0, c_1 and c_2 of each, of the quartic by its share and else of the parabola; none where they are undetermined.
    pub(super) fn fitted(&self) -> impl Iterator<Item = Option<[f64; 3]>> + use<> {
        let mut fits = Fits::default();
        if self.count > 0 {
            Arch::new().dispatch(Fit { windows: self, fits: &mut fits });
        }
        let (count, share) = (self.count, self.share);
        (0..count).map(move |k| fits.of(k, share[k]))
    }
}

/// What is fitted to each window.
#[derive(Debug, Default)]
struct Fits {
    parabola: [[f64; TOGETHER]; 3],
    /// Positive where the parabola is determined.
    told: [[f64; TOGETHER]; 2],
    quartic: [[f64; TOGETHER]; 3],
    /// All positive where the quartic is determined.
    pivots: [[f64; TOGETHER]; 5],
}

impl Fits {
    fn of(&self, k: usize, share: f64) -> Option<[f64; 3]> {
        let is_positive = |rows: &[[f64; TOGETHER]]| rows.iter().all(|row| row[k] > 0.0);
        if !is_positive(&self.told) {
            return None;
        }
        let share = if share > 0.0 && is_positive(&self.pivots) { share } else { 0.0 };
        let part = |j: usize| {
            let (parabola, quartic) = (self.parabola[j][k], self.quartic[j][k]);
            if share > 0.0 { parabola + share * (quartic - parabola) } else { parabola }
        };
        Some(std::array::from_fn(part))
    }
}

/// The work on all of them.
struct Fit<'w> {
    windows: &'w Windows,
    fits: &'w mut Fits,
}

impl WithSimd for Fit<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.on(Wide(simd));
    }
}

impl Fit<'_> {
    #[inline(always)]
    fn on<R: Register>(self, register: R) {
        let Windows { count, sums, centre, share } = self.windows;
        let has_quartic = share[..*count].iter().any(|share| *share > 0.0);
        for first in (0..*count).step_by(R::PLACES) {
            let load = |row: &[f64; TOGETHER]| register.load(&row[first..]);
            let centre = load(centre);
            let mut powers: [R::Value; POWERS] = std::array::from_fn(|k| load(&sums[k]));
            let mut products: [R::Value; PRODUCTS] = std::array::from_fn(|k| load(&sums[POWERS + k]));
            shift(&mut powers, centre);
            shift(&mut products, centre);
            let t: [R::Value; POWERS - 4] = std::array::from_fn(|k| weighted(&powers, k));
            let y: [R::Value; PRODUCTS - 4] = std::array::from_fn(|k| weighted(&products, k));
            let store = |rows: &mut [[f64; TOGETHER]], values: &[R::Value]| {
                rows.iter_mut().zip(values).for_each(|(row, value)| register.store(*value, &mut row[first..]));
            };
            let (parabola, told) = parabola(&[t[0], t[1], t[2], t[3], t[4], y[0], y[1], y[2]]);
            store(&mut self.fits.parabola, &parabola);
            store(&mut self.fits.told, &told);
            if has_quartic {
                let ridge = t[0] * RIDGE;
                let matrix = std::array::from_fn(|i| {
                    std::array::from_fn(|j| if i == j && i > 2 { t[i + j] + ridge } else { t[i + j] })
                });
                let (quartic, pivots) = first_of_solution(matrix, y);
                store(&mut self.fits.quartic, &quartic);
                store(&mut self.fits.pivots, &pivots);
            }
        }
    }
}

/// Sums with the weight (1 − τ²)².
#[inline(always)]
fn weighted<T: Real>(of: &[T], k: usize) -> T {
    of[k] - of[k + 2] * 2.0 + of[k + 4]
}

/// Moments about 0 become moments about `centre`: Horner's scheme of each power of (s − centre).
#[inline(always)]
fn shift<T: Real, const N: usize>(moments: &mut [T; N], centre: T) {
    for k in 1..N {
        for j in (k..N).rev() {
            moments[j] = moments[j] - centre * moments[j - 1];
        }
    }
}

/// The first three of five unknowns, and the pivots, which are positive where the matrix is positive definite. The last ones are
/// eliminated first. Sizes are compile-time constants, as it runs at every sample.
#[inline(always)]
fn first_of_solution<T: Real>(mut a: [[T; 5]; 5], mut b: [T; 5]) -> ([T; 3], [T; 5]) {
    for k in (1..5).rev() {
        for i in 0..k {
            let share = a[k][i] / a[k][k];
            for j in 0..=i {
                a[i][j] = a[i][j] - share * a[k][j];
            }
            b[i] = b[i] - share * b[k];
        }
    }
    let first = b[0] / a[0][0];
    let second = (b[1] - a[1][0] * first) / a[1][1];
    let third = (b[2] - a[2][0] * first - a[2][1] * second) / a[2][2];
    ([first, second, third], std::array::from_fn(|k| a[k][k]))
}

/// c_0, c_1 and c_2 by normal equations, and two values that are positive where these are determined.
#[inline(always)]
pub(super) fn parabola<T: Real>(s: &[T; 8]) -> ([T; 3], [T; 2]) {
    // Without the mean: [t2, t3; t3, t4] (b, c) = (y1, y2).
    let mean = [s[1] / s[0], s[2] / s[0]];
    let (t2, t3, t4) = (s[2] - mean[0] * s[1], s[3] - mean[1] * s[1], s[4] - mean[1] * s[2]);
    let (y1, y2) = (s[6] - mean[0] * s[5], s[7] - mean[1] * s[5]);
    let determinant = t2 * t4 - t3 * t3;
    let b = (t4 * y1 - t3 * y2) / determinant;
    let c = (t2 * y2 - t3 * y1) / determinant;
    ([s[5] / s[0] - b * mean[0] - c * mean[1], b, c], [s[0], determinant - t2 * t4 * 1e-9])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::lanes::Single;

    /// Oracle: each window by itself, without registers.
    #[test]
    fn company_changes_no_bit() {
        let mut windows = Windows::default();
        for k in 0..TOGETHER {
            let mut sums = [0.0; POWERS + PRODUCTS];
            for n in 0..30 + 5 * k {
                let (s, x) = (0.8 * (f64::from(n as u32) + 0.3 * k as f64).sin(), (0.37 * n as f64).cos());
                let powers = std::iter::successors(Some(1.0), |power| Some(power * s));
                for (j, power) in powers.take(POWERS).enumerate() {
                    sums[j] += power;
                    if j < PRODUCTS {
                        sums[POWERS + j] += power * x;
                    }
                }
            }
            windows.push(&sums, 0.05 * k as f64, if k % 3 == 0 { 0.0 } else { 0.1 * k as f64 });
        }
        let mut fits = Fits::default();
        Fit { windows: &windows, fits: &mut fits }.on(Single);
        let alone: Vec<_> = (0..TOGETHER).map(|k| fits.of(k, windows.share[k])).collect();
        assert!(windows.is_full() && alone.iter().all(Option::is_some));
        assert_eq!(windows.fitted().collect::<Vec<_>>(), alone);
    }
}
