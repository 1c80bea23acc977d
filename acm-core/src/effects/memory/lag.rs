//! First-order lag, exact for a signal that is straight between samples: τ ẏ = x − y, at rest at the first sample.
//!
//! ```text
//! y_k = x_k − m τ + (y_{k−1} − x_{k−1} + m τ) e^{−h/τ},   m = (x_k − x_{k−1})/h
//! ```

use super::{Last, Point, State};

/// e^{−h/τ} of the last h and τ.
pub type Decay = Last<(f64, f64), f64>;

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct Lag {
    before: Option<Point>,
    y: f64,
}

impl State for Lag {}

impl Lag {
    /// The lagging signal at the next sample. Signals with the same time stamps share `decay`.
    #[inline]
    pub fn step(&mut self, time: f64, x: f64, tau: f64, decay: &mut Decay) -> f64 {
        let (h, past) = Point::since(self.before, time, x);
        if h > 0.0 && tau > 1e-9 {
            let decay = decay.of((h, tau), || (-h / tau).exp());
            self.y = relax((self.y, past, x), (x - past) / h * tau, decay);
        } else {
            self.y = x;
        }
        self.before = Some(Point { time, x });
        self.y
    }
}

/// Where the lag that was at `y` is after a time in which the signal goes from `past` to `x`; `behind` is m τ.
#[inline]
pub(super) fn relax((y, past, x): (f64, f64, f64), behind: f64, decay: f64) -> f64 {
    x - behind + (y - past + behind) * decay
}

/// The column form: `tau` gives τ at each sample.
pub fn lag(time: &[f64], x: &mut [f64], tau: impl Fn(usize) -> f64) {
    let (mut lag, mut decay) = (Lag::default(), Decay::default());
    x.iter_mut().zip(time).enumerate().for_each(|(t, (x, time))| *x = lag.step(*time, *x, tau(t), &mut decay));
}
