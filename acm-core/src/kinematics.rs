//! Kinematics: rigid motions, strain along the arm, its shape, and the numbers that they are written over.

pub mod axis;
pub mod coefficients;
pub mod fold;
pub mod grid;
pub mod lanes;
pub mod magnus;
pub mod real;
pub mod se3;
pub mod shape;
pub mod strain;
pub mod triple;
