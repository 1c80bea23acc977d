//! Exact steps of a linear system whose forcing is straight between samples.
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

/// φ0, h(φ1 − φ2) and hφ2 of a step h.
#[derive(Debug, Clone, Copy)]
pub struct Step<const N: usize> {
    /// Of the state.
    pub state: Square<N>,
    /// Of the forcing before.
    pub before: Square<N>,
    /// Of the forcing now.
    pub now: Square<N>,
}

/// A matrix with what every step of it needs.
#[derive(Debug, Clone, Copy)]
pub struct System<const N: usize> {
    a: Square<N>,
    scale: [f64; N],
    balanced: Square<N>,
    norm: f64,
}

impl<const N: usize> System<N> {
    /// Of A.
    pub fn new(a: Square<N>) -> Self {
        let scale = balance(&a);
        let balanced: Square<N> = map(|i, j| a[i][j] * scale[j] / scale[i]);
        let norm = balanced.iter().map(|row| row.iter().map(|z| z.abs()).sum::<f64>()).fold(0.0, f64::max);
        Self { a, scale, balanced, norm }
    }

    /// Whether it is that of `a`.
    pub fn is(&self, a: &Square<N>) -> bool {
        self.a == *a
    }

    /// The step over `h` seconds.
    pub fn step(&self, h: f64) -> Step<N> {
        if N == 2 {
            let [[a, b], [c, d]] = [0, 1].map(|i| [0, 1].map(|j| self.a[i % N][j % N]));
            let determinant = a * d - b * c;
            // Both poles are told from 0 in a step, so that what is divided by A keeps its digits.
            if determinant.abs() * h >= CLOSED * self.norm && h > 0.0 {
                let [state, before, now] = closed([[a, b], [c, d]], determinant, h);
                let fill = |m: Square<2>| map(|i, j| m[i % 2][j % 2]);
                return Step { state: fill(state), before: fill(before), now: fill(now) };
            }
        }
        by_series(self, h)
    }
}

/// Least size of the smaller pole times h for the closed form of two states.
const CLOSED: f64 = 1e-2;

/// Two states: A = mI + M with M² = δI, so that e^{hA} = e^{mh} (cosh(√δ h) I + sinh(√δ h)/√δ M); φ1 and φ2 by A⁻¹.
fn closed(a: Square<2>, determinant: f64, h: f64) -> [Square<2>; 3] {
    let m = 0.5 * (a[0][0] + a[1][1]);
    let half = 0.5 * (a[0][0] - a[1][1]);
    let square = half * half + a[0][1] * a[1][0];
    let root = square.abs().sqrt();
    let (c, s) = if root * h < 1e-4 {
        let bent = square * h * h;
        let fade = (m * h).exp();
        (fade * (1.0 + bent / 2.0), fade * h * (1.0 + bent / 6.0))
    } else if square < 0.0 {
        let ((sine, cosine), fade) = ((root * h).sin_cos(), (m * h).exp());
        (fade * cosine, fade * sine / root)
    } else {
        let (slow, fast) = (((m + root) * h).exp(), ((m - root) * h).exp());
        (0.5 * (slow + fast), 0.5 * (slow - fast) / root)
    };
    let state = [[c + s * half, s * a[0][1]], [s * a[1][0], c - s * half]];
    let over = 1.0 / determinant;
    // A⁻¹ (X − I).
    let divided = |x: Square<2>| -> Square<2> {
        let [p, q, r, t] = [x[0][0] - 1.0, x[0][1], x[1][0], x[1][1] - 1.0];
        [
            [(a[1][1] * p - a[0][1] * r) * over, (a[1][1] * q - a[0][1] * t) * over],
            [(a[0][0] * r - a[1][0] * p) * over, (a[0][0] * t - a[1][0] * q) * over],
        ]
    };
    let one = divided(state);
    let inverse = 1.0 / h;
    let now = divided([[one[0][0] * inverse, one[0][1] * inverse], [one[1][0] * inverse, one[1][1] * inverse]]);
    let before = [[one[0][0] - now[0][0], one[0][1] - now[0][1]], [one[1][0] - now[1][0], one[1][1] - now[1][1]]];
    [state, before, now]
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
        before: map(|i, j| h * (one[i][j] - two[i][j]) * back(i, j)),
        now: map(|i, j| h * two[i][j] * back(i, j)),
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

    /// Oracle: the series and its doublings, over poles that swing, that are one, and that are far apart.
    #[test]
    fn the_closed_form_is_the_series() {
        for (w, damping) in [(15.7f64, 0.3f64), (3.0, 1.0), (40.0, 1.0 + 1e-9), (900.0, 0.05), (60.0, 2.5), (1e5, 0.7)]
        {
            let system = System::new([[-2.0 * damping * w, -w * w], [1.0, 0.0]]);
            let (found, expected) = (system.step(0.01), by_series(&system, 0.01));
            for (a, b) in [(found.state, expected.state), (found.before, expected.before), (found.now, expected.now)] {
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
            assert!(close(found.now[0][0], two), "{z}: {} {two}", found.now[0][0]);
            assert!(close(found.before[0][0] + found.now[0][0], one), "{z}");
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
        assert!((found.now[0][1] - 0.25 / 6.0).abs() < 1e-16 && (found.now[1][1] - 0.25).abs() < 1e-16);
    }
}
