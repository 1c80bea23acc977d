//! The nominal form: a given base, and a correction that is fitted with the effects.
//!
//! ```text
//! p(q) = s(q) + m(q),   m(q) = Σ_j c_j Π_a z_a^{n_ja} + Σ_a Σ_k s_ak max(0, z_a − κ_k) + Σ_n a_n cos(n·q) + b_n sin(n·q)
//! z_a = (q_a − middle_a) / half_a
//! κ_k = k / 64 − 1,   k of a set of 1 … 127
//! ```
//!
//! | symbol | meaning                                                                                        |
//! | `s`    | base: the calibrated strain model, or a prediction that comes with the data; else zero        |
//! | `κ`    | places of the kinks, the same for each actuator; most forms have none                         |
//! | `n`    | sums of angles ([`angles`]); most forms have none                               |
//! | `m`    | correction; beside a base z stays within the recorded range, so that nothing is extrapolated   |
//!
//! Without a base the linear part is extrapolated, and z in higher powers stays within [`BEYOND`] half ranges of the middle.

pub mod angles;
mod powers;

use acm_core::actuation::{Monomials, monomial_count_within, monomials_within};
use angles::Sums;
pub use powers::Powers;

/// Half ranges from the middle up to which a polynomial is extrapolated. Beyond, only its linear part grows: an input far outside would be
/// raised to the eighth power.
pub const BEYOND: f64 = 1.25;

/// Largest number of columns up to degree 3 and with kinks, and from degree 4 on.
const COLUMNS: (usize, usize) = (90, 34);

/// Returns the largest number of kinks per actuator.
pub fn most_kinks(actuators: usize) -> usize {
    ((COLUMNS.0 - 1) / actuators.max(1)).saturating_sub(1)
}

/// Returns whether a straight line and terms of so many sums of angles have few enough columns.
pub fn fits_sums(actuators: usize, sums: usize) -> bool {
    1 + actuators + 2 * sums <= COLUMNS.0
}

/// Degree and ridge of the correction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Form {
    /// Highest total degree; none: no correction at all.
    pub degree: Option<usize>,
    /// Highest power of each actuator.
    pub powers: Powers,
    /// Places of the kinks.
    pub kinks: Kinks,
    /// Sums of angles that the correction has a sine and a cosine of.
    pub sums: Sums,
    /// Ridge parameter λ, relative to columns of unit mean square.
    pub ridge: f64,
}

impl Form {
    /// A straight line.
    pub const LINEAR: Self =
        Self { degree: Some(1), powers: Powers::ANY, kinks: Kinks::NONE, sums: Sums::None, ridge: 1e-6 };

    /// The base as it is.
    pub const GIVEN: Self =
        Self { degree: None, powers: Powers::ANY, kinks: Kinks::NONE, sums: Sums::None, ridge: 1e-6 };

    /// Returns the monomials of so many actuators; none without a correction.
    pub fn monomials(&self, actuators: usize) -> Option<Monomials> {
        self.degree.map(|degree| monomials_within(&self.powers.highest(actuators, degree), degree))
    }

    /// Returns the number of these monomials.
    pub fn monomial_count(&self, actuators: usize) -> usize {
        self.degree.map_or(0, |degree| monomial_count_within(&self.powers.highest(actuators, degree), degree))
    }

    /// Returns whether the polynomial of so many actuators has few enough columns.
    pub fn fits(&self, actuators: usize) -> bool {
        self.monomial_count(actuators) <= if self.degree.unwrap_or(0) < 4 { COLUMNS.0 } else { COLUMNS.1 }
    }
}

/// Number of places that kinks may have.
const PLACES: u32 = 127;

/// A set of places, of which bit k − 1 is that of κ_k.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kinks(u128);

impl Kinks {
    /// No place.
    pub const NONE: Self = Self(0);

    /// Returns as many places as possible with a distance of `step` between two.
    pub fn spaced(step: u32) -> Self {
        (step..=PLACES).step_by(step as usize).fold(Self::NONE, |set, k| Self(set.0 | 1 << (k - 1)))
    }

    /// Returns the sets with one place more, of those with a distance of `step` between two.
    pub fn larger(self, step: u32) -> impl Iterator<Item = Self> {
        let places = (step..=PLACES).step_by(step as usize).map(|k| k - 1);
        places.filter(move |k| !self.has(*k)).map(move |k| Self(self.0 | 1 << k))
    }

    /// Returns the sets with one place moved to the next, or to the one before.
    pub fn moved(self) -> impl Iterator<Item = Self> {
        let beside = move |k: u32| [k.checked_sub(1), Some(k + 1).filter(|k| *k < PLACES)].into_iter().flatten();
        let all = (0..PLACES).filter(move |k| self.has(*k)).flat_map(move |k| beside(k).map(move |to| (k, to)));
        all.filter(move |(_, to)| !self.has(*to)).map(move |(k, to)| Self(self.0 & !(1 << k) | 1 << to))
    }

    fn has(self, k: u32) -> bool {
        self.0 & (1 << k) != 0
    }

    /// Returns the number of places.
    pub fn count(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Returns whether there is no place.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns numbers that no other set has.
    pub fn key(self) -> [f64; 4] {
        [96, 64, 32, 0].map(|shift| f64::from((self.0 >> shift) as u32))
    }

    /// Returns the places, in half ranges from the middle.
    pub fn places(self) -> impl Iterator<Item = f64> {
        (0..PLACES).filter(move |k| self.has(*k)).map(|k| f64::from(k + 1) / 64.0 - 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_spread_over_the_range() {
        let places: Vec<f64> = Kinks::spaced(32).places().collect();
        assert_eq!(places, [-0.5, 0.0, 0.5]);
        assert_eq!([Kinks::spaced(16), Kinks::spaced(8), Kinks::NONE].map(Kinks::count), [7, 15, 0]);
        let one: Vec<Kinks> = Kinks::NONE.larger(2).collect();
        assert_eq!((one.len(), one[31].places().next()), (63, Some(0.0)));
        assert_eq!((one[31].larger(2).count(), one[31].larger(1).count()), (62, 126));
        let moved: Vec<f64> = one[31].moved().flat_map(Kinks::places).collect();
        assert_eq!(moved, [-1.0 / 64.0, 1.0 / 64.0]);
        assert_eq!(Kinks::spaced(1).moved().count(), 0);
        assert_ne!(Kinks::spaced(64).key(), Kinks::NONE.key());
    }
}
