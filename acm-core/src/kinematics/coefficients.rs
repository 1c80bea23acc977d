//! Coefficients of the exponential of a rotation, in x = θ².
//!
//! ```text
//! A = sin θ / θ,   B = (1 − cos θ) / θ²,   C = (θ − sin θ) / θ³,   D = (1/2 − B) / x,   E = (1/6 − C) / x
//! A = 1 − x C,     B = 1/2 − x D,          C = 1/6 − x E
//! dA/dx = (C − B)/2,   dB/dx = D − C/2,    dC/dx = (3 E − D)/2
//! ```
//!
//! Below two radians D = Σ (−x)ᵏ/(2k+4)! and E = Σ (−x)ᵏ/(2k+5)! are the only series: all others follow from them, slopes
//! included, and nothing is lost at θ → 0. Beyond, A, B and C come from sine and cosine, and D and E from them.

use crate::kinematics::real::Real;

/// Terms of the series; at two radians the first one left out is below 1e-17.
const TERMS: usize = 10;

/// θ² up to which the series are used.
const SERIES: f64 = 4.0;

const D: [f64; TERMS] = alternating_factorials(4);
const E: [f64; TERMS] = alternating_factorials(5);

/// The five functions of the header at one angle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coefficients<T> {
    pub a: T,
    pub b: T,
    pub c: T,
    d: T,
    e: T,
}

impl<T: Real> Coefficients<T> {
    /// At x = θ².
    #[inline(always)]
    pub fn at(square: T) -> Self {
        let [a, b, c, d, e] = if square.largest() < SERIES { series(square) } else { square.each(alone) };
        Self { a, b, c, d, e }
    }

    /// dA/dx, dB/dx, dC/dx.
    #[inline(always)]
    pub fn slopes(&self) -> [T; 3] {
        [(self.c - self.b) * 0.5, self.d - self.c * 0.5, (self.e * 3.0 - self.d) * 0.5]
    }
}

/// A to E of one angle of any size.
fn alone(square: f64) -> [f64; 5] {
    if square < SERIES {
        return series(square);
    }
    let angle = square.sqrt();
    let (sin, cos) = angle.sin_cos();
    let (b, c) = ((1.0 - cos) / square, (angle - sin) / (square * angle));
    [sin / angle, b, c, (0.5 - b) / square, (1.0 / 6.0 - c) / square]
}

#[inline(always)]
fn series<T: Real>(x: T) -> [T; 5] {
    let square = x * x;
    let (d, e) = (sum(&D, x, square), sum(&E, x, square));
    let c = -(x * e) + 1.0 / 6.0;
    [-(x * c) + 1.0, -(x * d) + 0.5, c, d, e]
}

/// Σ terms[k] xᵏ: even and odd powers apart, so that neither waits for the other.
#[inline(always)]
fn sum<T: Real>(terms: &[f64; TERMS], x: T, square: T) -> T {
    let (mut even, mut odd) = (x.like(terms[TERMS - 2]), x.like(terms[TERMS - 1]));
    for k in (0..TERMS / 2 - 1).rev() {
        even = even * square + terms[2 * k];
        odd = odd * square + terms[2 * k + 1];
    }
    even + odd * x
}

/// Coefficients `(−1)ᵏ / (2k + first)!`.
const fn alternating_factorials(first: usize) -> [f64; TERMS] {
    let mut terms = [0.0; TERMS];
    let mut k = 0;
    while k < TERMS {
        let mut term = if k % 2 == 0 { 1.0 } else { -1.0 };
        let mut factor = 2;
        while factor <= 2 * k + first {
            term /= factor as f64;
            factor += 1;
        }
        terms[k] = term;
        k += 1;
    }
    terms
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the closed forms with sine and cosine, where they don't cancel, on both sides of the switch.
    #[test]
    fn both_branches_are_the_closed_forms() {
        for angle in [1.5, 1.999_999, 2.000_001, 3.0, 20.0f64] {
            let x = angle * angle;
            let found = Coefficients::at(x);
            let (sin, cos) = angle.sin_cos();
            assert!((found.a - sin / angle).abs() < 1e-15, "{angle}");
            assert!((found.b - (1.0 - cos) / x).abs() < 1e-15, "{angle}");
            assert!((found.c - (angle - sin) / (x * angle)).abs() < 1e-15, "{angle}");
        }
    }

    /// Oracle: central differences in x.
    #[test]
    fn slopes_are_the_derivatives() {
        for x in [1e-6, 0.3, 2.0, 3.9, 5.0, 40.0] {
            let h = 1e-5 * (1.0 + x);
            let (after, before) = (Coefficients::at(x + h), Coefficients::at(x - h));
            let differences = [after.a - before.a, after.b - before.b, after.c - before.c];
            for (slope, difference) in Coefficients::at(x).slopes().iter().zip(differences) {
                assert!((slope - difference / (2.0 * h)).abs() < 1e-10, "{x}: {slope}");
            }
        }
    }
}
