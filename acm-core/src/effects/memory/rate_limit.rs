//! Rate limit: follows the signal at no more than the speed 1/`slowness`; a slowness of 0 is no limit.

use super::{Point, State};

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct RateLimit {
    before: Option<Point>,
    y: f64,
}

impl State for RateLimit {}

impl RateLimit {
    /// The output at the next sample.
    #[inline]
    pub fn step(&mut self, time: f64, x: f64, slowness: f64) -> f64 {
        let (h, past) = Point::since(self.before, time, x);
        self.y = if h > 0.0 && slowness > 0.0 { chase(self.y, past, x, h, 1.0 / slowness) } else { x };
        self.before = Some(Point { time, x });
        self.y
    }
}

/// The output after `h` seconds, at most at `speed`, for an input that goes linearly from `from` to `to`.
fn chase(y: f64, from: f64, to: f64, h: f64, speed: f64) -> f64 {
    let ahead = from - y;
    let run = if ahead == 0.0 { 0.0 } else { ahead.signum() * speed };
    let closing = (run - (to - from) / h) * ahead.signum();
    let meets = if ahead == 0.0 { 0.0 } else { ahead.abs() / closing };
    if ahead != 0.0 && (closing <= 0.0 || meets >= h) {
        return y + run * h;
    }
    let reach = speed * (h - meets);
    to.max(y + run * meets - reach).min(y + run * meets + reach)
}
