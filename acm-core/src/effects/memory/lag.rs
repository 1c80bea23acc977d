//! First-order lag, exact for a signal that is straight between samples: τ ẏ = x − y, at rest at the first sample.
//!
//! ```text
//! y_k = x_k − m τ + (y_{k−1} − x_{k−1} + m τ) e^{−h/τ},   m = (x_k − x_{k−1})/h
//! ```

use super::{Point, State};

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct Lag {
    before: Option<Point>,
    y: f64,
}

impl State for Lag {}

impl Lag {
    /// The lagging signal at the next sample.
    #[inline]
    pub fn step(&mut self, time: f64, x: f64, tau: f64) -> f64 {
        let (h, past) = Point::since(self.before, time, x);
        if h > 0.0 && tau > 1e-9 {
            self.y = relax(self.y, past, x, h, tau);
        } else {
            self.y = x;
        }
        self.before = Some(Point { time, x });
        self.y
    }
}

/// Where the lag that was at `y` is after `h` seconds in which the signal goes from `past` to `x`.
#[inline]
pub(super) fn relax(y: f64, past: f64, x: f64, h: f64, tau: f64) -> f64 {
    let behind = (x - past) / h * tau;
    x - behind + (y - past + behind) * (-h / tau).exp()
}

/// The column form: `tau` gives τ at each sample.
pub fn lag(time: &[f64], x: &mut [f64], tau: impl Fn(usize) -> f64) {
    let mut lag = Lag::default();
    x.iter_mut().zip(time).enumerate().for_each(|(t, (x, time))| *x = lag.step(*time, *x, tau(t)));
}
