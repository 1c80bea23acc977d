//! Vectors in space over [`Real`]: one, or several side by side.

use std::ops::{Add, Mul};

use crate::kinematics::real::Real;

/// x, y, z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Triple<T> {
    pub x: T,
    pub y: T,
    pub z: T,
}

impl<T: Real> Triple<T> {
    #[inline(always)]
    pub fn new(x: T, y: T, z: T) -> Self {
        Self { x, y, z }
    }

    /// Zero; `like` says how many stand side by side.
    #[inline(always)]
    pub fn zero(like: T) -> Self {
        let zero = like.like(0.0);
        Self::new(zero, zero, zero)
    }

    #[inline(always)]
    pub fn dot(self, other: Self) -> T {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
}

impl<T: Real> Add for Triple<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<T: Real> Mul<T> for Triple<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}
