//! A harmonic of sums of angles, as in the kinematics and gravity of revolute joints.
//!
//! ```text
//! h_o(q) = a_o cos(n·q) + b_o sin(n·q),   n_j = −1, 0, 1
//! ```
//!
//! Every product of the sines and cosines of distinct angles is a sum of such terms. Siciliano et al. (2009), Robotics, ch. 2 and 7.

use serde::{Deserialize, Serialize};

/// See the head of this file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Harmonic {
    /// Multiple n of each actuator, an angle in rad, A.
    pub multiples: Vec<i8>,
    /// Size a of the cosine for each output, M.
    pub cosine: Vec<f64>,
    /// Size b of the sine for each output, M.
    pub sine: Vec<f64>,
}

impl Harmonic {
    /// Returns the angle n·q.
    pub fn angle(multiples: &[i8], q: &[f64]) -> f64 {
        multiples.iter().zip(q).map(|(n, q)| f64::from(*n) * q).sum()
    }

    /// Adds h(q) to `out` `[M]`.
    pub fn add(&self, q: &[f64], out: &mut [f64]) {
        let (sine, cosine) = Self::angle(&self.multiples, q).sin_cos();
        let sizes = self.cosine.iter().zip(&self.sine);
        out.iter_mut().zip(sizes).for_each(|(out, (a, b))| *out += a * cosine + b * sine);
    }

    /// Adds ∂h/∂q to `slopes` [M×A].
    pub fn add_slopes(&self, q: &[f64], slopes: &mut [f64]) {
        let (sine, cosine) = Self::angle(&self.multiples, q).sin_cos();
        for (slopes, (a, b)) in slopes.chunks_exact_mut(q.len()).zip(self.cosine.iter().zip(&self.sine)) {
            let slope = b * cosine - a * sine;
            slopes.iter_mut().zip(&self.multiples).for_each(|(out, n)| *out += f64::from(*n) * slope);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: 2 cos q₁ cos q₂ = cos(q₁ + q₂) + cos(q₁ − q₂), and its derivatives by the product rule.
    #[test]
    fn sums_of_angles_make_products() {
        let of = |n: i8| Harmonic { multiples: vec![1, n], cosine: vec![1.0, 0.0], sine: vec![0.0, 1.0] };
        let q = [0.4, -1.1];
        let (mut out, mut slopes) = ([0.0; 2], [0.0; 4]);
        [of(1), of(-1)].iter().for_each(|term| {
            term.add(&q, &mut out);
            term.add_slopes(&q, &mut slopes);
        });
        let [(s1, c1), (s2, c2)] = q.map(f64::sin_cos);
        let expected = [2.0 * c1 * c2, 2.0 * s1 * c2];
        out.iter().zip(expected).for_each(|(out, expected)| assert!((out - expected).abs() < 1e-14));
        let expected = [-2.0 * s1 * c2, -2.0 * c1 * s2, 2.0 * c1 * c2, -2.0 * s1 * s2];
        slopes.iter().zip(expected).for_each(|(out, expected)| assert!((out - expected).abs() < 1e-14));
    }
}
