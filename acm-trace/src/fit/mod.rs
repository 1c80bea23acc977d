//! Fits of effects by variable projection: whatever the outputs are linear in is solved for at every point.
//!
//! ```text
//! y = b(θ) + X(θ) β + e,   β(θ) = (XᵀX + λ n D + P)⁻¹ (Xᵀ(y − b) + P β₀),   min over θ of ‖y − b − X β(θ)‖² + prior
//! ```
//!
//! | symbol | meaning                                                                         | shape |
//! | `b, X` | what the nominal form and the effects make of the inputs ([`design`])           | n × r, n × p |
//! | `β`    | coefficients of the nominal form, and the effects' linear parameters            | p × r |
//! | `θ`    | nonlinear parameters of the effects                                             | few   |
//! | `λ, D` | ridge, and which columns it shrinks                                             |       |
//! | `P, β₀` | precision and mean of a calibration                                            | p × p, p |
//!
//! Golub & Pereyra (2003), Inverse Problems 19(2).

pub mod blocks;
pub mod columns;
pub mod design;
pub mod form;
pub mod gram;
pub mod interval;

pub mod problem;
pub mod refine;
pub mod state;
