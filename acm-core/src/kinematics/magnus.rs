//! One step of the Magnus expansion in SE(3), of sixth order.
//!
//! ```text
//! g' = g · ξ̂(s) over one step of length h:   g(s + h) = g(s) · exp(Ω)
//! Ω  = α₁ + α₃/12 + 1/240 [α₂ + C₂, −20 α₁ − α₃ + C₁],   C₁ = [α₂, α₁],   C₂ = −1/60 [2 α₃ + C₁, α₁]
//! α₁ = h ξ_b,   α₂ = √15/3 h (ξ_c − ξ_a),   α₃ = 10/3 h (ξ_c − 2 ξ_b + ξ_a)     ξ at the three Gauss points a, b, c
//! ```
//!
//! | symbol | meaning                                                | shape | unit   |
//! | `α`    | strain, its slope and its curvature over the step       | 6     | rad, m |
//! | `Ω`    | twist of the whole step: rotation and translation       | 6     | rad, m |
//!
//! Twists come in two halves: bending about x and y with stretch along z is *odd*, twist about z with shear along x and y is
//! *even*. The commutator of two odd ones is even, of two even ones even, of one of each odd. Bending alone is odd, so for
//! an arm without torsion half of every commutator vanishes and isn't computed.
//!
//! Sixth order in h, exact where strain is constant. Blanes, Casas, Oteo, Ros (2009), Phys. Rep. 470, with the signs of a
//! field that multiplies from the right.

use std::ops::{Add, Mul};

use crate::kinematics::real::Real;
use crate::kinematics::triple::Triple;

/// Rotation (x, y, 0), translation (0, 0, z).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Odd<T> {
    pub x: T,
    pub y: T,
    pub z: T,
}

/// Rotation (0, 0, z), translation (x, y, 0).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Even<T> {
    pub z: T,
    pub x: T,
    pub y: T,
}

/// Both halves.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Twist<T> {
    pub odd: Odd<T>,
    pub even: Even<T>,
}

impl<T: Real> Twist<T> {
    /// Rotation vector.
    #[inline(always)]
    pub fn omega(&self) -> Triple<T> {
        Triple::new(self.odd.x, self.odd.y, self.even.z)
    }

    /// Translation part.
    #[inline(always)]
    pub fn v(&self) -> Triple<T> {
        Triple::new(self.even.x, self.even.y, self.odd.z)
    }

    /// Strain about x, y and z, with stretch `z` along the arm.
    #[inline(always)]
    pub fn of_strain(kappa: Triple<T>, z: T) -> Self {
        let zero = z.like(0.0);
        Self { odd: Odd { x: kappa.x, y: kappa.y, z }, even: Even { z: kappa.z, x: zero, y: zero } }
    }
}

/// Ω of one step and its change with α: formulas of different cost.
pub(crate) trait Expansion<T> {
    /// How many of α₁, α₂, α₃ are looked at.
    const ORDERS: usize;

    fn new(alpha: [Twist<T>; 3]) -> Self;

    /// Ω.
    fn omega(&self) -> Twist<T>;

    /// Change of Ω with a change of α: the product rule, commutator by commutator.
    fn slope(&self, change: [Twist<T>; 3]) -> Twist<T>;
}

/// Constant strain: Ω = α₁.
pub(crate) struct Constant<T>(Twist<T>);

impl<T: Real> Expansion<T> for Constant<T> {
    const ORDERS: usize = 1;

    #[inline(always)]
    fn new(alpha: [Twist<T>; 3]) -> Self {
        Self(alpha[0])
    }

    #[inline(always)]
    fn omega(&self) -> Twist<T> {
        self.0
    }

    #[inline(always)]
    fn slope(&self, change: [Twist<T>; 3]) -> Twist<T> {
        change[0]
    }
}

/// Bending that varies linearly along the step, without torsion: α₃ = 0 and all α odd.
pub(crate) struct Bending<T> {
    alpha: [Odd<T>; 2],
    c1: Even<T>,
    /// α₂ + C₂.
    w: Odd<T>,
}

impl<T: Real> Expansion<T> for Bending<T> {
    const ORDERS: usize = 2;

    #[inline(always)]
    fn new(alpha: [Twist<T>; 3]) -> Self {
        let alpha = [alpha[0].odd, alpha[1].odd];
        let c1 = odd_odd(alpha[1], alpha[0]);
        Self { alpha, c1, w: alpha[1] + odd_even(alpha[0], c1) * (1.0 / 60.0) }
    }

    #[inline(always)]
    fn omega(&self) -> Twist<T> {
        Twist {
            odd: self.alpha[0] + odd_even(self.w, self.c1) * (1.0 / 240.0),
            even: odd_odd(self.w, self.alpha[0]) * (-1.0 / 12.0),
        }
    }

    #[inline(always)]
    fn slope(&self, change: [Twist<T>; 3]) -> Twist<T> {
        let change = [change[0].odd, change[1].odd];
        let c1 = odd_odd(change[1], self.alpha[0]) + odd_odd(self.alpha[1], change[0]);
        let w = change[1] + (odd_even(self.alpha[0], c1) + odd_even(change[0], self.c1)) * (1.0 / 60.0);
        Twist {
            odd: change[0] + (odd_even(w, self.c1) + odd_even(self.w, c1)) * (1.0 / 240.0),
            even: (odd_odd(w, self.alpha[0]) + odd_odd(self.w, change[0])) * (-1.0 / 12.0),
        }
    }
}

/// Any step.
pub(crate) struct General<T> {
    alpha: [Twist<T>; 3],
    /// 2 α₃ + C₁.
    t: Twist<T>,
    /// α₂ + C₂.
    w: Twist<T>,
    /// −20 α₁ − α₃ + C₁.
    u: Twist<T>,
}

impl<T: Real> Expansion<T> for General<T> {
    const ORDERS: usize = 3;

    #[inline(always)]
    fn new(alpha: [Twist<T>; 3]) -> Self {
        let c1 = commutator(alpha[1], alpha[0]);
        let t = alpha[2] * 2.0 + c1;
        let w = alpha[1] + commutator(t, alpha[0]) * (-1.0 / 60.0);
        Self { alpha, t, w, u: alpha[0] * -20.0 + alpha[2] * -1.0 + c1 }
    }

    #[inline(always)]
    fn omega(&self) -> Twist<T> {
        self.alpha[0] + self.alpha[2] * (1.0 / 12.0) + commutator(self.w, self.u) * (1.0 / 240.0)
    }

    #[inline(always)]
    fn slope(&self, change: [Twist<T>; 3]) -> Twist<T> {
        let c1 = commutator(change[1], self.alpha[0]) + commutator(self.alpha[1], change[0]);
        let t = change[2] * 2.0 + c1;
        let w = change[1] + (commutator(t, self.alpha[0]) + commutator(self.t, change[0])) * (-1.0 / 60.0);
        let u = change[0] * -20.0 + change[2] * -1.0 + c1;
        let both = commutator(w, self.u) + commutator(self.w, u);
        change[0] + change[2] * (1.0 / 12.0) + both * (1.0 / 240.0)
    }
}

/// [a, b]; even.
#[inline(always)]
fn odd_odd<T: Real>(a: Odd<T>, b: Odd<T>) -> Even<T> {
    Even { z: a.x * b.y - a.y * b.x, x: a.y * b.z - a.z * b.y, y: a.z * b.x - a.x * b.z }
}

/// [a, b]; odd.
#[inline(always)]
fn odd_even<T: Real>(a: Odd<T>, b: Even<T>) -> Odd<T> {
    Odd { x: a.y * b.z, y: -(a.x * b.z), z: a.x * b.y - a.y * b.x }
}

/// [a, b]; even, with no rotation.
#[inline(always)]
fn even_even<T: Real>(a: Even<T>, b: Even<T>) -> Even<T> {
    Even { z: a.z.like(0.0), x: a.y * b.z - a.z * b.y, y: a.z * b.x - a.x * b.z }
}

#[inline(always)]
fn commutator<T: Real>(a: Twist<T>, b: Twist<T>) -> Twist<T> {
    Twist {
        odd: odd_even(a.odd, b.even) + odd_even(b.odd, a.even) * -1.0,
        even: odd_odd(a.odd, b.odd) + even_even(a.even, b.even),
    }
}

impl<T: Real> Add for Odd<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<T: Real> Mul<f64> for Odd<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<T: Real> Add for Even<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { z: self.z + other.z, x: self.x + other.x, y: self.y + other.y }
    }
}

impl<T: Real> Mul<f64> for Even<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self { z: self.z * factor, x: self.x * factor, y: self.y * factor }
    }
}

impl<T: Real> Add for Twist<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { odd: self.odd + other.odd, even: self.even + other.even }
    }
}

impl<T: Real> Mul<f64> for Twist<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self { odd: self.odd * factor, even: self.even * factor }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix4;

    use super::*;

    fn matrix(twist: &Twist<f64>) -> Matrix4<f64> {
        let (w, v) = (twist.omega(), twist.v());
        #[rustfmt::skip]
        let matrix = Matrix4::new(
            0.0, -w.z, w.y, v.x,
            w.z, 0.0, -w.x, v.y,
            -w.y, w.x, 0.0, v.z,
            0.0, 0.0, 0.0, 0.0,
        );
        matrix
    }

    fn twist(seed: f64) -> Twist<f64> {
        let value = |k: f64| (seed + 1.3 * k).sin();
        Twist {
            odd: Odd { x: value(0.0), y: value(1.0), z: value(2.0) },
            even: Even { z: value(3.0), x: value(4.0), y: value(5.0) },
        }
    }

    /// Oracle: XY − YX of 4 × 4 matrices.
    #[test]
    fn commutators_are_those_of_the_matrices() {
        let (a, b) = (twist(0.3), twist(2.1));
        let (x, y) = (matrix(&a), matrix(&b));
        assert!((matrix(&commutator(a, b)) - (x * y - y * x)).amax() < 1e-15);
    }

    /// Oracle: the general formula, where α₃ and torsion are zero.
    #[test]
    fn bending_is_the_general_step_without_torsion() {
        let zero = Even { z: 0.0, x: 0.0, y: 0.0 };
        let [a, b, da, db] = [0.2, 1.1, 3.0, 4.2].map(|seed| Twist { odd: twist(seed).odd, even: zero });
        let none = a * 0.0;
        let (special, general) = (Bending::new([a, b, none]), General::new([a, b, none]));
        assert!((matrix(&special.omega()) - matrix(&general.omega())).amax() < 1e-16);
        let (special, general) = (special.slope([da, db, none]), general.slope([da, db, none]));
        assert!((matrix(&special) - matrix(&general)).amax() < 1e-16);
    }
}
