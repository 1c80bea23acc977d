//! What effects remember: operators on irregular time stamps, and where an effect keeps them between two pieces of a trial.
//!
//! Signals are straight between samples. Each operator is a small state that takes one sample after the other, and exact at
//! the samples: one more sample on a straight piece changes nothing at the others.

mod bouc_wen;
mod delay;
mod lag;
mod play;
mod rate_limit;
mod second_order_lag;
mod slopes;
#[cfg(test)]
mod tests;

use std::any::Any;

pub use bouc_wen::BoucWen;
pub use delay::DelayLine;
pub use lag::{Lag, lag};
pub use play::{Play, play};
pub use rate_limit::RateLimit;
pub use second_order_lag::SecondOrderLag;
pub use slopes::Slopes;

/// An operator, or whatever else an effect keeps: its default is rest, before any sample.
pub trait State: Default + Send + Sync + 'static {
    /// Back to rest; what has room keeps it.
    fn restart(&mut self) {
        *self = Self::default();
    }
}

impl<S: State, const N: usize> State for [S; N] where [S; N]: Default {}

impl State for Vec<f64> {
    fn restart(&mut self) {
        self.clear();
    }
}

/// What an effect keeps from one piece of a trial to the next; empty before the first.
///
/// What it holds depends on the effect, which asks for states of its own kind. After the first piece nothing is allocated.
#[derive(Debug, Default)]
pub struct Memory {
    states: Option<Box<dyn Any + Send + Sync>>,
    column: Vec<f64>,
    start: Option<f64>,
    restarted: bool,
}

impl Memory {
    /// Forgets the trial, so that another can begin.
    pub fn restart(&mut self) {
        self.start = None;
        self.restarted = true;
    }

    /// `count` states of one kind, at first all at rest.
    pub fn states<S: State>(&mut self, count: usize) -> &mut [S] {
        self.states_and_column(count).0
    }

    /// The same, and a column to work with, which holds anything.
    pub fn states_and_column<S: State>(&mut self, count: usize) -> (&mut [S], &mut Vec<f64>) {
        let states = self.states.get_or_insert_with(|| Box::new(Vec::<S>::new()));
        if !states.is::<Vec<S>>() {
            *states = Box::new(Vec::<S>::new());
        }
        let Some(states) = states.downcast_mut::<Vec<S>>() else { return (&mut [], &mut self.column) };
        states.resize_with(count, S::default);
        if std::mem::take(&mut self.restarted) {
            states.iter_mut().for_each(S::restart);
        }
        (states, &mut self.column)
    }

    /// A column to work with, filled with `values`.
    pub fn column(&mut self, values: impl Iterator<Item = f64>) -> &[f64] {
        self.column.clear();
        self.column.extend(values);
        &self.column
    }

    /// Time of the first sample of the trial, s, in whose next piece the time stamps are `time`.
    pub fn start(&mut self, time: &[f64]) -> f64 {
        let first = time.first().copied();
        *self.start.get_or_insert(first.unwrap_or(0.0))
    }
}

/// A sample of a signal.
#[derive(Debug, Clone, Copy)]
struct Point {
    time: f64,
    x: f64,
}

impl Point {
    /// Seconds since a point and the value there; none have passed where there is no point.
    #[inline]
    fn since(before: Option<Point>, time: f64, x: f64) -> (f64, f64) {
        before.map_or((0.0, x), |before| (time - before.time, before.x))
    }
}
