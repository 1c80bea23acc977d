//! Fits of effects by variable projection: linear parameters are solved for at every evaluation.
//!
//! ```text
//! y = b(θ) + X(θ) β + e,   β(θ) = (XᵀX + λ n D)⁻¹ Xᵀ(y − b),   min over θ of ‖y − b − X β(θ)‖²
//! ```
//!
//! | symbol | meaning                                                                        | shape |
//! | `b, X` | base and columns of the nominal form and the effects ([`design`])              | N × M, N × p |
//! | `β`    | coefficients of the correction, and the effects' linear parameters             | p × M |
//! | `θ`    | nonlinear parameters of the effects                                            | few   |
//! | `λ, D` | ridge, and which columns it shrinks                                            |       |
//!
//! Golub & Pereyra (2003), Inverse Problems 19(2).

#[cfg(test)]
pub(crate) mod bench;
pub mod blocks;
pub mod columns;
pub mod design;
pub mod form;
pub mod gram;
pub mod interval;
pub mod moved;
pub mod offsets;
pub mod problem;
pub mod projected;
pub mod refine;
pub mod state;
pub mod unrecorded;
