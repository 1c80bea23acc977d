//! Parts of the interval between two samples, for equations that have no closed solution over it.

use super::{Point, interval};

/// Most parts of an interval.
const MOST: usize = 4;

/// Longest part that counts as short, in time constants. A second-order method then errs by 1/12 of its square, 8e-4 of the
/// nonlinear term.
const SHORT: f64 = 0.1;

/// Signal at the ends of each part of the interval up to the sample `(time, x)`; the length of a part, s, before them. There are 1, 2 or
/// [`MOST`] parts, the fewest that are short beside a `constant` in s.
pub fn parts(before: Point, time: f64, x: f64, constant: f64) -> (f64, impl Iterator<Item = f64>) {
    let h = interval(before.time, time);
    let is_short = |count: &usize| h <= SHORT * constant * *count as f64;
    let count = [1, 2].into_iter().find(is_short).unwrap_or(MOST);
    let at = move |k: usize| if k == count { x } else { before.x + (x - before.x) * k as f64 / count as f64 };
    (h / count as f64, (1..=count).map(at))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn parts_are_as_few_as_are_short() {
        let ends = |constant: f64| {
            let (h, ends) = parts(Point { time: 1.0, x: 2.0 }, 1.5, 4.0, constant);
            (h, ends.collect::<Vec<f64>>())
        };
        assert_eq!(ends(6.0), (0.5, vec![4.0]));
        assert_eq!(ends(3.0), (0.25, vec![3.0, 4.0]));
        assert_eq!(ends(2.0), (0.125, vec![2.5, 3.0, 3.5, 4.0]));
        assert_eq!(ends(f64::NAN).1.len(), 4);
    }
}
