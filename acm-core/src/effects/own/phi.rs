//! Exact steps of a linear system whose forcing is linear between samples.
//!
//! ```text
//! ż = A z + f,   z(h) = φ0 z(0) + h (φ1 − φ2) f(0) + h φ2 f(h),   φk of hA
//! φ0 = e^Z,   φ1 = (e^Z − 1)/Z,   φ2 = (φ1 − 1)/Z
//! φ2 = Σ Z^k/(k + 2)!,   φ1 = 1 + Z φ2,   φ0 = 1 + Z φ1
//! φ0(2Z) = φ0²,   φ1(2Z) = ½ φ1 (φ0 + 1),   φ2(2Z) = ½ φ2 + ¼ φ1²
//! ```
//!
//! The series runs at ‖Z‖ ≤ ½, after A is balanced by powers of two; its sixteenth term is below 1e-19. Al-Mohy & Higham
//! (2011), SIAM J. Sci. Comput. 33(2); for φ: Hochbruck & Ostermann (2010), Acta Numerica 19.

/// A square matrix.
pub type Square<const N: usize> = [[f64; N]; N];

/// Most states of a linear system.
pub const MOST: usize = 6;

/// 1/(k + 2)!.
const SERIES: [f64; 16] = inverse_factorials();

const fn inverse_factorials() -> [f64; 16] {
    let (mut all, mut value, mut k) = ([0.0; 16], 0.5, 0);
    while k < 16 {
        all[k] = value;
        value /= (k + 3) as f64;
        k += 1;
    }
    all
}

/// A step h: φ0 of the state, and what the forcing adds.
#[derive(Debug, Clone, Copy)]
pub struct Step<const N: usize> {
    /// Of the state.
    pub state: Square<N>,
    /// Of the forcing.
    pub forcing: Forcing<N>,
}

/// Part of a forcing that is linear over a step.
#[derive(Debug, Clone, Copy)]
pub enum Forcing<const N: usize> {
    /// h(φ1 − φ2) f(0) + hφ2 f(h).
    Weights {
        /// h(φ1 − φ2).
        before: Square<N>,
        /// hφ2.
        now: Square<N>,
    },
    /// p(h) − φ0 p(0) with the motion p = −A⁻¹(f + A⁻¹ ḟ) that follows the forcing.
    Followed {
        /// A⁻¹.
        inverse: Square<N>,
        /// 1/h.
        per_second: f64,
    },
}

impl<const N: usize> Step<N> {
    /// The state after the step, of the state `z` and the forcing before and after it.
    #[inline]
    pub fn advance(&self, z: [f64; N], before: [f64; N], now: [f64; N]) -> [f64; N] {
        match &self.forcing {
            Forcing::Weights { before: b, now: n } => {
                let (own, first, last) = (apply(&self.state, z), apply(b, before), apply(n, now));
                sum(sum(own, first, 1.0), last, 1.0)
            }
            Forcing::Followed { inverse, per_second } => {
                let bent = apply(inverse, sum(now, before, -1.0));
                let first = apply(inverse, sum(before, bent, *per_second));
                let last = apply(inverse, sum(now, bent, *per_second));
                sum(apply(&self.state, sum(z, first, 1.0)), last, -1.0)
            }
        }
    }
}

/// A x.
#[inline(always)]
fn apply<const N: usize>(a: &Square<N>, x: [f64; N]) -> [f64; N] {
    let mut y = [0.0; N];
    for (y, row) in y.iter_mut().zip(a) {
        row.iter().zip(x).for_each(|(a, x)| *y += a * x);
    }
    y
}

/// x + c y.
#[inline(always)]
fn sum<const N: usize>(mut x: [f64; N], y: [f64; N], c: f64) -> [f64; N] {
    x.iter_mut().zip(y).for_each(|(x, y)| *x += c * y);
    x
}

/// A matrix with what every step of it needs.
#[derive(Debug, Clone, Copy)]
pub struct System<const N: usize> {
    a: Square<N>,
    scale: [f64; N],
    balanced: Square<N>,
    norm: f64,
    pair: Option<Pair<N>>,
}

/// Two states: A = mI + M with M² = δI.
#[derive(Debug, Clone, Copy)]
struct Pair<const N: usize> {
    determinant: f64,
    inverse: Square<N>,
    /// m.
    mean: f64,
    /// Half the difference of the diagonal.
    half: f64,
    /// δ, and √|δ|.
    square: f64,
    root: f64,
}

impl<const N: usize> System<N> {
    /// Of A.
    pub fn new(a: Square<N>) -> Self {
        let scale = balance(&a);
        let balanced: Square<N> = map(|i, j| a[i][j] * scale[j] / scale[i]);
        let norm = balanced.iter().map(|row| row.iter().map(|z| z.abs()).sum::<f64>()).fold(0.0, f64::max);
        Self { a, scale, balanced, norm, pair: Pair::of(&a) }
    }

    /// Whether it is that of `a`.
    pub fn is(&self, a: &Square<N>) -> bool {
        self.a == *a
    }

    /// The step over `h` seconds.
    #[inline]
    pub fn step(&self, h: f64) -> Step<N> {
        match &self.pair {
            // Both poles differ from 0 within a step, so that dividing by A keeps its digits.
            Some(pair) if pair.determinant.abs() * h >= CLOSED * self.norm && h > 0.0 => pair.step(&self.a, h),
            _ => by_series(self, h),
        }
    }
}

/// Least size of the smaller pole times h for the closed form of two states.
const CLOSED: f64 = 1e-2;

impl<const N: usize> Pair<N> {
    /// Of a regular matrix of two states.
    fn of(matrix: &Square<N>) -> Option<Self> {
        if N != 2 {
            return None;
        }
        let [[a, b], [c, d]] = [0, 1].map(|i| [0, 1].map(|j| matrix[i % N][j % N]));
        let determinant = a * d - b * c;
        let adjugate = [[d, -b], [-c, a]];
        let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
        let square = half * half + b * c;
        let inverse = map(|i, j| adjugate[i % 2][j % 2] / determinant);
        (determinant != 0.0).then(|| Self { determinant, inverse, mean, half, square, root: square.abs().sqrt() })
    }

    /// e^{hA} = e^{mh} (cosh(√δ h) I + sinh(√δ h)/√δ M).
    #[inline]
    fn step(&self, a: &Square<N>, h: f64) -> Step<N> {
        let Self { inverse, mean, half, square, root, .. } = *self;
        let (c, s) = if root * h < 1e-4 {
            let bent = square * h * h;
            let fade = (mean * h).exp();
            (fade * (1.0 + bent / 2.0), fade * h * (1.0 + bent / 6.0))
        } else if square < 0.0 {
            let ((sine, cosine), fade) = ((root * h).sin_cos(), (mean * h).exp());
            (fade * cosine, fade * sine / root)
        } else {
            let (slow, fast) = (((mean + root) * h).exp(), ((mean - root) * h).exp());
            (0.5 * (slow + fast), 0.5 * (slow - fast) / root)
        };
        let mut state = *a;
        state.iter_mut().flatten().for_each(|a| *a *= s);
        (state[0][0], state[N - 1][N - 1]) = (c + s * half, c - s * half);
        Step { state, forcing: Forcing::Followed { inverse, per_second: 1.0 / h } }
    }
}

fn by_series<const N: usize>(system: &System<N>, h: f64) -> Step<N> {
    let System { scale, balanced, .. } = system;
    let norm = h * system.norm;
    let z: Square<N> = map(|i, j| h * balanced[i][j]);
    let halvings = if norm > 0.5 && norm.is_finite() { (2.0 * norm).log2().ceil() as i32 } else { 0 };
    let mut z = z;
    let small = 0.5f64.powi(halvings);
    z.iter_mut().flatten().for_each(|z| *z *= small);
    let mut two = series(&z);
    let mut one = plus_one(product(&z, &two));
    let mut zero = plus_one(product(&z, &one));
    for _ in 0..halvings {
        let square = product(&one, &one);
        two = map(|i, j| 0.5 * two[i][j] + 0.25 * square[i][j]);
        let half: Square<N> = map(|i, j| 0.5 * one[i][j]);
        one = product(&half, &plus_one(zero));
        zero = product(&zero, &zero);
    }
    let back = |i: usize, j: usize| scale[i] / scale[j];
    Step {
        state: map(|i, j| zero[i][j] * back(i, j)),
        forcing: Forcing::Weights {
            before: map(|i, j| h * (one[i][j] - two[i][j]) * back(i, j)),
            now: map(|i, j| h * two[i][j] * back(i, j)),
        },
    }
}

fn map<const N: usize>(of: impl Fn(usize, usize) -> f64) -> Square<N> {
    std::array::from_fn(|i| std::array::from_fn(|j| of(i, j)))
}

fn product<const N: usize>(a: &Square<N>, b: &Square<N>) -> Square<N> {
    let mut all = [[0.0; N]; N];
    for i in 0..N {
        for k in 0..N {
            for j in 0..N {
                all[i][j] += a[i][k] * b[k][j];
            }
        }
    }
    all
}

fn plus_one<const N: usize>(mut a: Square<N>) -> Square<N> {
    (0..N).for_each(|i| a[i][i] += 1.0);
    a
}

/// φ2 of a small Z, in blocks of four powers.
fn series<const N: usize>(z: &Square<N>) -> Square<N> {
    let second = product(z, z);
    let third = product(&second, z);
    let fourth = product(&second, &second);
    let block = |k: usize| -> Square<N> {
        map(|i, j| {
            let one = if i == j { SERIES[k] } else { 0.0 };
            one + SERIES[k + 1] * z[i][j] + SERIES[k + 2] * second[i][j] + SERIES[k + 3] * third[i][j]
        })
    };
    let mut sum = block(12);
    for k in [8, 4, 0] {
        let (higher, own) = (product(&fourth, &sum), block(k));
        sum = map(|i, j| own[i][j] + higher[i][j]);
    }
    sum
}

/// Powers of two that make rows and columns of each state about as large. Osborne (1960), J. ACM 7(4).
fn balance<const N: usize>(a: &Square<N>) -> [f64; N] {
    let mut scale = [1.0; N];
    if N == 1 {
        return scale;
    }
    for _ in 0..3 {
        for i in 0..N {
            let size = |j: usize, k: usize| (a[j][k] * scale[k] / scale[j]).abs();
            let row: f64 = (0..N).filter(|&k| k != i).map(|k| size(i, k)).sum();
            let column: f64 = (0..N).filter(|&k| k != i).map(|k| size(k, i)).sum();
            let ratio = row / column;
            if ratio.is_finite() && ratio > 0.0 {
                let power = (0.5 * ratio.log2()).round().clamp(-200.0, 200.0);
                scale[i] *= 2f64.powi(power as i32);
            }
        }
    }
    scale
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step<const N: usize>(a: &Square<N>, h: f64) -> Step<N> {
        System::new(*a).step(h)
    }

    /// Weights of the forcing: what the step makes of each alone.
    fn weights<const N: usize>(step: &Step<N>) -> [Square<N>; 2] {
        let unit = |j: usize| std::array::from_fn(|i| if i == j { 1.0 } else { 0.0 });
        let zero = [0.0; N];
        let turned = |of: &dyn Fn(usize) -> [f64; N]| map(|i, j| of(j)[i]);
        let before = turned(&|j| step.advance(zero, unit(j), zero));
        [before, turned(&|j| step.advance(zero, zero, unit(j)))]
    }

    /// Oracle: the series and its doublings, over poles that swing, that are one, and that are far apart.
    #[test]
    fn the_closed_form_is_the_series() {
        for (w, damping) in [(15.7f64, 0.3f64), (3.0, 1.0), (40.0, 1.0 + 1e-9), (900.0, 0.05), (60.0, 2.5), (1e5, 0.7)]
        {
            let system = System::new([[-2.0 * damping * w, -w * w], [1.0, 0.0]]);
            let (found, expected) = (system.step(0.01), by_series(&system, 0.01));
            assert!(
                matches!(found.forcing, Forcing::Followed { .. })
                    && matches!(expected.forcing, Forcing::Weights { .. })
            );
            let ([before, now], [all_before, all_now]) = (weights(&found), weights(&expected));
            for (a, b) in [(found.state, expected.state), (before, all_before), (now, all_now)] {
                for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let size = w.powi(j as i32 - i as i32);
                    let off = (a[i][j] - b[i][j]).abs();
                    assert!(off < 1e-11 * size, "{w} {damping} {i} {j}: {off:.1e} of {size:.1e}");
                }
            }
        }
    }

    /// Oracle: closed forms of one state, by `exp_m1`, over all sizes.
    #[test]
    fn one_state() {
        for z in [-1e8, -300.0, -5.0, -0.4, -1e-3, -1e-9, 1e-6, 0.3, 4.0] {
            let found = step(&[[z]], 1.0);
            let one = f64::exp_m1(z) / z;
            // Where the difference would cancel, the first terms of the series.
            let two = if z.abs() > 0.1 { (one - 1.0) / z } else { 0.5 + z / 6.0 + z * z / 24.0 + z.powi(3) / 120.0 };
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-13 * b.abs().max(1e-12);
            assert!(close(found.state[0][0], z.exp()), "{z}: {}", found.state[0][0]);
            let [before, now] = weights(&found);
            assert!(close(now[0][0], two), "{z}: {} {two}", now[0][0]);
            assert!(close(before[0][0] + now[0][0], one), "{z}");
        }
    }

    /// Oracle: an oscillator's closed form, of very different frequencies, steps and dampings.
    #[test]
    fn an_oscillator() {
        for (w, h, damping) in [(1.0f64, 0.1f64, 0.05f64), (300.0, 0.01, 0.3), (1e4, 1e-5, 0.7), (0.01, 5.0, 0.2)] {
            let found = step(&[[0.0, 1.0], [-w * w, -2.0 * damping * w]], h);
            let s = w * (1.0 - damping * damping).sqrt();
            let fade = (-damping * w * h).exp();
            let (cosine, sine) = (fade * (s * h).cos(), fade * (s * h).sin() / s);
            let exact = [[cosine + damping * w * sine, sine], [-w * w * sine, cosine - damping * w * sine]];
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                // Positions and speeds differ by ω.
                let size = w.powi(i as i32 - j as i32);
                assert!((found.state[i][j] - exact[i][j]).abs() < 1e-13 * size, "{w} {h}: {i} {j}");
            }
        }
    }

    /// Oracle: nilpotent: a double integrator of a ramp goes as t³/6.
    #[test]
    fn a_double_integrator() {
        let found = step(&[[0.0, 1.0], [0.0, 0.0]], 0.5);
        assert_eq!(found.state, [[1.0, 0.5], [0.0, 1.0]]);
        // Forcing of the speed that goes from 0 to 1 in h: h²/6 of way, h/2 of speed.
        let [_, now] = weights(&found);
        assert!((now[0][1] - 0.25 / 6.0).abs() < 1e-16 && (now[1][1] - 0.25).abs() < 1e-16);
    }
}
