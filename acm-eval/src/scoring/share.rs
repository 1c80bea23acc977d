//! Counts of cases, and quantiles.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Number of items for which something holds, and number of all.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Share {
    /// Number of items for which it holds.
    pub count: usize,
    /// Number of all items.
    pub of: usize,
}

impl Share {
    /// Counts the items for which it holds.
    pub fn of<T>(all: impl IntoIterator<Item = T>, holds: impl Fn(&T) -> bool) -> Self {
        all.into_iter().fold(Self::default(), |Self { count, of }, one| Self {
            count: count + usize::from(holds(&one)),
            of: of + 1,
        })
    }
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.of {
            0 => f.write_str("–"),
            of => write!(f, "{}/{of} = {:.1} %", self.count, 100.0 * self.count as f64 / of as f64),
        }
    }
}

/// Returns the arithmetic mean; none without values.
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Returns a quantile, linear between neighbours; none without values.
pub fn quantile(values: &[f64], share: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = share * sorted.len().checked_sub(1)? as f64;
    let (low, part) = (place.floor() as usize, place.fract());
    let high = sorted.get(low + 1).unwrap_or(&sorted[low]);
    // An infinite neighbour counts only where it has a part.
    Some(if part == 0.0 { sorted[low] } else { sorted[low] + part * (high - sorted[low]) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_and_quantiles_by_hand() {
        let share = Share::of([1, 2, 3, 4, 5, 6], |value| *value > 4);
        assert_eq!((share.count, share.of), (2, 6));
        assert_eq!((share.to_string().as_str(), Share::default().to_string().as_str()), ("2/6 = 33.3 %", "–"));
        assert_eq!((mean(&[1.0, 2.0, 6.0]), mean(&[])), (Some(3.0), None));
        assert_eq!(quantile(&[4.0, 1.0, 2.0, 3.0], 0.5), Some(2.5));
        assert_eq!(quantile(&[f64::INFINITY, 1.0, 2.0], 0.5), Some(2.0));
        assert_eq!((quantile(&[7.0], 0.9), quantile(&[], 0.5)), (Some(7.0), None));
    }
}
