//! Play: the output rests while the input moves within ±`width` of it, at first centred.

use crate::effects::memory::State;

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct Play {
    rest: Option<f64>,
}

impl State for Play {}

impl Play {
    /// Puts the output at `rest` before the first sample; no effect later.
    #[inline]
    pub fn begin(&mut self, rest: f64) {
        self.rest.get_or_insert(rest);
    }

    /// The output at the next sample.
    #[inline]
    pub fn step(&mut self, x: f64, width: f64) -> f64 {
        let y = self.rest.unwrap_or(x).max(x - width).min(x + width);
        self.rest = Some(y);
        y
    }
}

/// The column form: `width` gives the half-width at each sample.
pub fn play(x: &mut [f64], width: impl Fn(usize) -> f64) {
    let mut play = Play::default();
    x.iter_mut().enumerate().for_each(|(t, x)| *x = play.step(*x, width(t)));
}
