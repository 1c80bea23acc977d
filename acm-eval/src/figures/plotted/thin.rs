//! Thinning of a line that keeps its outline: largest triangle, three buckets.
//!
//! The first and the last point stay. The points between are put into `wanted − 2` buckets of equal count, and of each
//! bucket that point stays which spans the largest triangle with the point kept before it and the mean of the bucket
//! behind it. Lines over the same abscissae are thinned together, by the sum of their triangles, so that at each place that
//! is left all of them can be read. Points are chosen, never made up: they can be looked up in the table that they are from.
//!
//! Steinarsson, S. (2013), "Downsampling Time Series for Visual Representation", University of Iceland.

use std::ops::Range;

/// A line as it is to be thinned.
type Line<'a> = &'a [(f64, f64)];

/// Returns the indices of the points to keep of `lines`, which have the same abscissae, in order; all of them where
/// there are no more than `wanted`.
pub fn thinned(lines: &[Line], wanted: usize) -> Vec<usize> {
    let n = lines.iter().map(|line| line.len()).min().unwrap_or(0);
    if n <= wanted.max(2) {
        return (0..n).collect();
    }
    let buckets = wanted.max(2) - 2;
    let mut kept = vec![0];
    for bucket in 0..buckets {
        let behind = if bucket + 1 < buckets { within(bucket + 1, buckets, n) } else { n - 1..n };
        let next: Vec<(f64, f64)> = lines.iter().map(|line| mean(&line[behind.clone()])).collect();
        let before = kept[bucket];
        let spanned =
            |k: usize| -> f64 { lines.iter().zip(&next).map(|(line, next)| area(line[before], line[k], *next)).sum() };
        kept.extend(within(bucket, buckets, n).max_by(|a, b| spanned(*a).total_cmp(&spanned(*b))));
    }
    kept.push(n - 1);
    kept
}

/// Returns the points of a bucket, without the first and the last of all.
fn within(bucket: usize, buckets: usize, n: usize) -> Range<usize> {
    let edge = |k: usize| 1 + k * (n - 2) / buckets;
    edge(bucket)..edge(bucket + 1)
}

fn mean(points: &[(f64, f64)]) -> (f64, f64) {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0, y + point.1));
    (x / n, y / n)
}

/// Returns twice the area of a triangle.
fn area(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> f64 {
    ((a.0 - c.0) * (b.1 - a.1) - (a.0 - b.0) * (c.1 - a.1)).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_stays_and_so_do_both_ends() {
        let points: Vec<(f64, f64)> = (0..1000).map(|k| (f64::from(k), if k == 637 { 9.0 } else { 0.0 })).collect();
        let kept = thinned(&[&points], 50);
        assert_eq!((kept.len(), kept[0], kept[49]), (50, 0, 999));
        assert!(kept.contains(&637) && kept.is_sorted_by(|a, b| a < b), "{kept:?}");
    }

    /// Oracle: by hand. Three points between the ends make one bucket; the one farthest from the chord stays.
    #[test]
    fn the_largest_triangle_stays() {
        let points = [(0.0, 0.0), (1.0, 1.0), (2.0, -3.0), (3.0, 2.0), (4.0, 0.0)];
        assert_eq!(thinned(&[&points], 3), [0, 2, 4]);
        assert_eq!(thinned(&[&points], 5), [0, 1, 2, 3, 4]);
        assert_eq!(thinned(&[&points[..1]], 3), [0]);
        // A second line, whose point at 3 is farther from its chord than all others together.
        let other = points.map(|(x, _)| (x, if x == 3.0 { 20.0 } else { 0.0 }));
        assert_eq!(thinned(&[&points, &other], 3), [0, 3, 4]);
    }
}
