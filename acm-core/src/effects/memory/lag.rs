//! First-order lag, exact for a signal that is linear between samples: τ ẏ = x − y, at rest at the first sample.
//!
//! ```text
//! y_k = x_k − m τ + (y_{k−1} − x_{k−1} + m τ) e^{−h/τ},   m = (x_k − x_{k−1})/h
//! ```

use super::beside::Beside;
use super::{Last, Memory, Point, State};

/// The step of the last h and τ: e^{−h/τ}, and τ/h.
pub type Decay = Last<(f64, f64), (f64, f64)>;

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
        let stride = decay.of((h, tau), || Self::stride(h, tau));
        self.before = Some(Point { time, x });
        self.go(&stride, past, x)
    }
}

impl Beside for Lag {
    type Shape = f64;
    type Stride = (f64, f64);

    fn stride(h: f64, tau: f64) -> (f64, f64) {
        if h > 0.0 && tau > 1e-9 { ((-h / tau).exp(), tau / h) } else { (0.0, 0.0) }
    }

    #[inline]
    fn go(&mut self, (decay, lasting): &(f64, f64), past: f64, x: f64) -> f64 {
        self.y = relax((self.y, past, x), (x - past) * lasting, *decay);
        self.y
    }

    fn before(&mut self) -> &mut Option<Point> {
        &mut self.before
    }
}

/// The output after a step from `y`, in which the signal goes from `past` to `x`; `behind` is m τ.
#[inline]
pub(super) fn relax((y, past, x): (f64, f64, f64), behind: f64, decay: f64) -> f64 {
    x - behind + (y - past + behind) * decay
}

/// The column form: `tau` gives τ at each sample.
pub fn lag(time: &[f64], x: &mut [f64], tau: impl Fn(usize) -> f64) {
    let (mut lag, mut decay) = (Lag::default(), Decay::default());
    x.iter_mut().zip(time).enumerate().for_each(|(t, (x, time))| *x = lag.step(*time, *x, tau(t), &mut decay));
}

/// Passes columns through a creep: `values` gives the late share and τ at each sample.
pub fn creep(memory: &mut Memory, time: &[f64], values: impl Fn(usize) -> [f64; 2], columns: &mut [Vec<f64>]) {
    let (lags, mut decay) = (memory.states::<Lag>(columns.len()), Decay::default());
    for (t, time) in time.iter().enumerate() {
        let [share, tau] = values(t);
        for (x, lag) in columns.iter_mut().zip(lags.iter_mut()) {
            let late = lag.step(*time, x[t], tau, &mut decay);
            x[t] += share * (late - x[t]);
        }
    }
}
