//! Highest powers of the actuators in a polynomial.
//!
//! n values of an actuator determine its powers up to n − 1.

/// Highest power of each actuator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Powers(u64);

/// Bits of one power, and largest number of actuators.
const BITS: (u32, usize) = (4, 16);

/// A power that is not limited.
const UNLIMITED: u64 = 15;

impl Powers {
    /// Powers up to the degree of the polynomial.
    pub const ANY: Self = Self(u64::MAX);

    /// Returns these powers; there are limits up to 14, for the first 16 actuators.
    pub fn up_to(highest: &[usize]) -> Self {
        let set = |all: u64, (a, highest): (usize, &usize)| {
            let shift = BITS.0 * a as u32;
            all & !(UNLIMITED << shift) | (*highest as u64).min(UNLIMITED) << shift
        };
        Self(highest.iter().take(BITS.1).enumerate().fold(u64::MAX, set))
    }

    /// Returns the highest power of each of so many actuators in a polynomial of a degree.
    pub fn highest(self, actuators: usize, degree: usize) -> Vec<usize> {
        let of = |a: usize| if a < BITS.1 { self.0 >> (BITS.0 * a as u32) & UNLIMITED } else { UNLIMITED };
        let limit = |highest: u64| if highest == UNLIMITED { degree } else { degree.min(highest as usize) };
        (0..actuators).map(|a| limit(of(a))).collect()
    }

    /// Returns numbers that no other powers have.
    pub fn key(self) -> [f64; 2] {
        [32, 0].map(|shift| f64::from((self.0 >> shift) as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_limited_where_they_say_so() {
        let powers = Powers::up_to(&[usize::MAX, 2, 0]);
        assert_eq!(powers.highest(4, 6), [6, 2, 0, 6]);
        assert_eq!(powers.highest(4, 1), [1, 1, 0, 1]);
        assert_eq!(Powers::ANY.highest(18, 9), [9; 18]);
        assert_eq!(Powers::up_to(&[3; 18]).highest(18, 9)[15..], [3, 9, 9]);
        assert_ne!(powers.key(), Powers::ANY.key());
    }
}
