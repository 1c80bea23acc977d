//! Parts of the interval between two samples, for equations that have no closed solution over it.

use super::Point;

/// Parts of an interval: their number depends on no parameter, so that the result is smooth in all of them.
pub const PARTS: usize = 4;

/// Signal at the ends of each part of the interval up to the sample `(time, x)`; the length of a part, s, with them.
pub fn parts(before: Point, time: f64, x: f64) -> (f64, [f64; PARTS]) {
    let at = |k: usize| if k + 1 == PARTS { x } else { before.x + (x - before.x) * (k + 1) as f64 / PARTS as f64 };
    ((time - before.time) / PARTS as f64, std::array::from_fn(at))
}
