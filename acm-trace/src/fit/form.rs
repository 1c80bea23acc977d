//! The nominal form: a given base, and a correction that is fitted with the effects.
//!
//! ```text
//! p(q) = s(q) + m(q),   m(q) = Σ_j c_j Π_a z_a^{n_ja},   z_a = (q_a − middle_a) / half_a
//! ```
//!
//! | symbol | meaning                                                                                        |
//! | `s`    | base: the calibrated strain model, or a prediction that comes with the data; else zero        |
//! | `m`    | correction; beside a base z stays within the recorded range, so that nothing is extrapolated   |
//!
//! Without a base the straight part goes on, and z of the powers from 2 on stays within [`BEYOND`] half ranges of the middle.

/// Half ranges from the middle up to which a polynomial is extrapolated. Beyond it goes on straight: an input that an effect throws far
/// out would be raised to the sixth power.
pub const BEYOND: f64 = 1.25;

/// Degree and ridge of the correction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Form {
    /// Highest total degree; none: no correction at all.
    pub degree: Option<usize>,
    /// Ridge parameter λ, relative to columns of unit mean square.
    pub ridge: f64,
}

impl Form {
    /// A straight line.
    pub const LINEAR: Self = Self { degree: Some(1), ridge: 1e-6 };

    /// The base as it is.
    pub const GIVEN: Self = Self { degree: None, ridge: 1e-6 };
}
