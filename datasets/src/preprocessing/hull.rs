//! Convex hull of points in the plane, by Andrew's monotone chain (1979, Information Processing Letters 9(5)).

/// Corners in counter-clockwise order; fewer than three where all points are equal or on one line.
pub(crate) fn convex_hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut hull = half(points.iter());
    hull.pop();
    hull.extend(half(points.iter().rev()));
    hull.pop();
    hull
}

/// One side of the hull, from the first point to the last, turning left throughout.
fn half<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> Vec<[f64; 2]> {
    let mut chain: Vec<[f64; 2]> = Vec::new();
    for p in points {
        while chain.len() >= 2 && cross(chain[chain.len() - 2], chain[chain.len() - 1], *p) <= 0.0 {
            chain.pop();
        }
        chain.push(*p);
    }
    chain
}

/// Twice the area of the triangle a, b, p; positive where p lies to the left of a → b.
fn cross(a: [f64; 2], b: [f64; 2], p: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

/// Whether `p` lies in the hull or within `tolerance` of it.
pub(crate) fn contains(hull: &[[f64; 2]], p: [f64; 2], tolerance: f64) -> bool {
    let n = hull.len();
    let sides = || (0..n).map(|i| (hull[i], hull[(i + 1) % n]));
    (n >= 3 && sides().all(|(a, b)| cross(a, b, p) >= 0.0)) || sides().any(|(a, b)| distance(a, b, p) <= tolerance)
}

/// Distance of `p` from the straight piece a–b.
fn distance(a: [f64; 2], b: [f64; 2], p: [f64; 2]) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length = dx * dx + dy * dy;
    let along = if length > 0.0 { ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length } else { 0.0 };
    let along = along.clamp(0.0, 1.0);
    (a[0] + along * dx - p[0]).hypot(a[1] + along * dy - p[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Oracle: a point is in the hull of a set if and only if it lies in a triangle of three of its points.
    fn in_some_triangle(points: &[[f64; 2]], p: [f64; 2]) -> bool {
        let n = points.len();
        let inside = |a, b, c| {
            let turns = [cross(a, b, p), cross(b, c, p), cross(c, a, p)];
            turns.iter().all(|t| *t >= 0.0) || turns.iter().all(|t| *t <= 0.0)
        };
        (0..n).any(|i| {
            (0..i).any(|j| {
                (0..j).any(|k| {
                    let (a, b, c) = (points[i], points[j], points[k]);
                    cross(a, b, c) != 0.0 && inside(a, b, c)
                })
            })
        })
    }

    proptest! {
        /// Small integers make ties, doubled points and points on edges, where the arithmetic is exact.
        #[test]
        fn hull_agrees_with_brute_force(
            points in proptest::collection::vec([0..7i32, 0..7i32], 3..12),
            p in [-1..8i32, -1..8i32],
        ) {
            let float = |q: [i32; 2]| [f64::from(q[0]), f64::from(q[1])];
            let points: Vec<[f64; 2]> = points.into_iter().map(float).collect();
            let hull = convex_hull(points.clone());
            prop_assume!(hull.len() >= 3);
            prop_assert_eq!(contains(&hull, float(p), 0.0), in_some_triangle(&points, float(p)));
        }
    }

    #[test]
    fn a_line_and_a_point_are_hulls_too() {
        let line = convex_hull(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [1.0, 1.0]]);
        assert!(
            contains(&line, [0.5, 0.5], 1e-9)
                && !contains(&line, [0.5, 0.6], 1e-9)
                && !contains(&line, [2.1, 2.1], 1e-9)
        );
        let point = convex_hull(vec![[1.0, 2.0]; 4]);
        assert!(contains(&point, [1.0, 2.0], 1e-9) && !contains(&point, [1.0, 2.1], 1e-9));
        assert!(!contains(&convex_hull(Vec::new()), [0.0, 0.0], 1e-9));
    }
}
