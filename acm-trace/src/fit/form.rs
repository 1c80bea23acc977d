//! The nominal form: a given base, and a correction that is fitted with the effects.
//!
//! ```text
//! p(q) = s(q) + m(q),   m(q) = Σ_j c_j Π_a z_a^{n_ja} + Σ_a Σ_k s_ak max(0, z_a − κ_k),   z_a = (q_a − middle_a) / half_a
//! κ_k = 2 k / (K + 1) − 1,   k = 1 … K
//! ```
//!
//! | symbol | meaning                                                                                        |
//! | `s`    | base: the calibrated strain model, or a prediction that comes with the data; else zero        |
//! | `κ`, K | kinks of each actuator, evenly spaced over its range; most forms have none |
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
    /// Number K of kinks of each actuator.
    pub kinks: usize,
    /// Ridge parameter λ, relative to columns of unit mean square.
    pub ridge: f64,
}

impl Form {
    /// A straight line.
    pub const LINEAR: Self = Self { degree: Some(1), kinks: 0, ridge: 1e-6 };

    /// The base as it is.
    pub const GIVEN: Self = Self { degree: None, kinks: 0, ridge: 1e-6 };

    /// Returns the places of the kinks, in half ranges from the middle.
    pub fn places(&self) -> impl Iterator<Item = f64> + use<> {
        let count = self.kinks;
        (1..=count).map(move |k| 2.0 * k as f64 / (count + 1) as f64 - 1.0)
    }
}
