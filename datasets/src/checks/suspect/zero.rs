//! Markers that are written as 0 where they were lost: all coordinates exactly 0, and far from there before and after.
//!
//! Far is five times the step from sample to sample that one in a hundred passes. An arm that starts at its origin leaves it
//! step by step.

/// Samples that are all 0.
#[derive(Debug, Default, PartialEq)]
pub struct Zeros {
    pub samples: Vec<usize>,
    /// Distance from 0 to the nearest neighbouring sample.
    pub distance: f64,
}

/// The samples of a marker, given by its columns, in which it is written as 0.
pub fn find(columns: &[&[f64]]) -> Zeros {
    let count = columns.first().map_or(0, |column| column.len());
    let zero = |i: usize| columns.iter().all(|column| column[i] == 0.0);
    let samples: Vec<usize> = (0..count).filter(|i| zero(*i)).collect();
    if columns.len() < 2 || samples.is_empty() {
        return Zeros::default();
    }
    let norm = |i: usize, j: Option<usize>| {
        columns.iter().map(|column| (column[i] - j.map_or(0.0, |j| column[j])).powi(2)).sum::<f64>().sqrt()
    };
    let whole = (1..count).filter(|i| !zero(*i) && !zero(i - 1));
    let mut steps: Vec<f64> = whole.map(|i| norm(i, Some(i - 1))).collect();
    let few = (steps.len() / 100).max(3);
    if steps.len() <= few {
        return Zeros::default();
    }
    let usual = *steps.select_nth_unstable_by(few, |a, b| b.total_cmp(a)).1;
    let beside = (1..count).filter(|i| zero(*i) != zero(i - 1));
    let distance = beside.map(|i| norm(i, None) + norm(i - 1, None)).fold(f64::INFINITY, f64::min);
    match distance.is_finite() && distance > 5.0 * usual {
        true => Zeros { samples, distance },
        false => Zeros::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marker(at: impl Fn(f64) -> [f64; 3]) -> [Vec<f64>; 3] {
        [0, 1, 2].map(|axis| (0..200).map(|i| at(f64::from(i))[axis]).collect())
    }

    fn zeros(columns: &[Vec<f64>]) -> Zeros {
        find(&columns.iter().map(Vec::as_slice).collect::<Vec<_>>())
    }

    #[test]
    fn a_lost_marker_is_found_and_an_origin_is_not() {
        let circle = |i: f64| [0.1 * (0.1 * i).cos(), 0.1 * (0.1 * i).sin(), -0.4];
        let mut lost = marker(circle);
        lost.iter_mut().for_each(|axis| axis[50..53].fill(0.0));
        lost.iter_mut().for_each(|axis| axis[199] = 0.0);
        let found = zeros(&lost);
        assert_eq!(found.samples, [50, 51, 52, 199]);
        assert!((found.distance - 0.17f64.sqrt()).abs() < 1e-12, "{found:?}");
        assert_eq!(zeros(&marker(circle)), Zeros::default());
        let through = marker(|i| [0.01 * (i - 100.0), 0.0, 0.0]);
        assert_eq!(zeros(&through), Zeros::default(), "a line through the origin");
        let starts = marker(|i| {
            if i < 50.0 {
                [0.0; 3]
            } else {
                [0.1 - 0.1 * (0.05 * (i - 49.0)).cos(), 0.0, 0.1 * (0.05 * (i - 49.0)).sin()]
            }
        });
        assert_eq!(zeros(&starts), Zeros::default(), "an arm that starts at its origin");
        assert_eq!(zeros(&marker(|_| [0.0; 3])), Zeros::default());
        assert_eq!(zeros(&lost[..1]), Zeros::default(), "a force may be 0");
    }
}
