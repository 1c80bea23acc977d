//! Memory of effects: operators on irregular time stamps, and where an effect keeps them between two pieces of a trial.
//!
//! Signals are linear between samples. Each operator is a small state that takes one sample after the other. It is exact at
//! the samples: one more sample on a straight piece changes nothing at the others. Two nonlinear lags have no closed form
//! ([`StiffLag`], [`VaryingLag`]): their error is that of their order. Derivatives look ahead ([`Derivatives`], [`Slopes`]).

mod beside;
mod delay;
mod derivatives;
mod first_order;
mod hysteresis;
mod lag;
mod last;
mod rate_limit;
mod second_order_lag;
mod slopes;
mod stiff_lag;
mod substeps;
#[cfg(test)]
mod tests;

use std::{any::Any, fmt::Debug};

pub use beside::pass;
pub use delay::DelayLine;
pub use derivatives::{Derivative, Derivatives};
pub use first_order::{AsymmetricLag, Decays, StickLag, VaryingLag};
pub use hysteresis::{BoucWen, LuGre, Play, play};
pub use lag::{Decay, Lag, creep, lag};
pub use last::Last;
pub use rate_limit::RateLimit;
pub use second_order_lag::{SecondOrderLag, Swing};
pub use slopes::Slopes;
pub use stiff_lag::{Friction, Spring, StiffLag};

/// State of an operator or an effect. Its default is rest, before any sample.
///
/// Undoing a step copies states with `clone_from`, which allocates nothing where there is room.
pub trait State: Clone + Debug + Default + Send + Sync + 'static {
    /// Back to rest; capacity is kept.
    fn restart(&mut self) {
        *self = Self::default();
    }
}

impl<S: State, const N: usize> State for [S; N] where [S; N]: Default {}

/// No memory.
impl State for () {}

impl State for Vec<f64> {
    fn restart(&mut self) {
        self.clear();
    }
}

/// What an effect keeps from one piece of a trial to the next; empty before the first.
///
/// The effect chooses the type of its states. After the first piece nothing is allocated.
#[derive(Debug, Default)]
pub struct Memory {
    states: Option<Box<dyn States>>,
    column: Vec<f64>,
    start: Option<f64>,
    restarted: bool,
    is_whole: bool,
}

impl Memory {
    /// The memory of a trial that comes in one piece.
    pub fn of_whole_trial() -> Self {
        Self { is_whole: true, ..Self::default() }
    }

    /// Whether the trial comes in one piece, so that nothing needs to be kept.
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// Forgets the trial, so that another can begin.
    pub fn restart(&mut self) {
        self.start = None;
        self.restarted = true;
    }

    /// `count` states of one kind, at first all at rest.
    pub fn states<S: State>(&mut self, count: usize) -> &mut [S] {
        self.states_and_column(count).0
    }

    /// The same, and a work column of any content.
    pub fn states_and_column<S: State>(&mut self, count: usize) -> (&mut [S], &mut Vec<f64>) {
        let states = self.states.get_or_insert_with(|| Box::new(Vec::<S>::new()));
        if !(**states).as_any().is::<Vec<S>>() {
            *states = Box::new(Vec::<S>::new());
        }
        let Some(states) = (**states).as_any_mut().downcast_mut::<Vec<S>>() else { return (&mut [], &mut self.column) };
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

    /// Time of the trial's first sample, s; `time` are the time stamps of its next piece.
    pub fn start(&mut self, time: &[f64]) -> f64 {
        let first = time.first().copied();
        *self.start.get_or_insert(first.unwrap_or(0.0))
    }
}

impl Clone for Memory {
    fn clone(&self) -> Self {
        let states = self.states.as_ref().map(|states| (**states).copy());
        Self {
            states,
            column: self.column.clone(),
            start: self.start,
            restarted: self.restarted,
            is_whole: self.is_whole,
        }
    }

    /// Allocates nothing where both are of one effect. The work column is not copied.
    fn clone_from(&mut self, other: &Self) {
        let alike = match (&mut self.states, &other.states) {
            (Some(own), Some(others)) => own.take_from((**others).as_any()),
            (own, others) => own.is_none() && others.is_none(),
        };
        if !alike {
            self.states = other.states.as_ref().map(|states| (**states).copy());
        }
        (self.start, self.restarted, self.is_whole) = (other.start, other.restarted, other.is_whole);
    }
}

/// States of some kind.
trait States: Any + Debug + Send + Sync {
    fn as_any(&self) -> &dyn Any;
    fn as_any_mut(&mut self) -> &mut dyn Any;
    fn copy(&self) -> Box<dyn States>;
    /// Whether they are of the same kind, and these are now as the others.
    fn take_from(&mut self, others: &dyn Any) -> bool;
}

impl<S: State> States for Vec<S> {
    fn as_any(&self) -> &dyn Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }

    fn copy(&self) -> Box<dyn States> {
        Box::new(self.clone())
    }

    fn take_from(&mut self, others: &dyn Any) -> bool {
        let others = others.downcast_ref::<Self>();
        others.map(|others| self.clone_from(others)).is_some()
    }
}

/// Takes over values, and as much room as the others have.
fn take_room<T: Copy>(own: &mut Vec<T>, others: &Vec<T>) {
    own.clear();
    own.reserve(others.capacity());
    own.extend_from_slice(others);
}

/// A sample of a signal.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    time: f64,
    x: f64,
}

impl Point {
    /// Seconds since a point and the value there; 0 s without a point.
    #[inline]
    fn since(before: Option<Point>, time: f64, x: f64) -> (f64, f64) {
        before.map_or((0.0, x), |before| (interval(before.time, time), before.x))
    }
}

/// Bits that are dropped from an interval; its relative error is 1.2e-10 at most.
const DROPPED: u32 = 20;

/// Seconds from one time stamp to the next. Intervals of a regular clock, which differ by rounding, become equal bit for bit:
/// what depends on the interval alone is computed once.
#[inline]
fn interval(from: f64, to: f64) -> f64 {
    let half = 1u64 << (DROPPED - 1);
    f64::from_bits((to - from).to_bits().wrapping_add(half) >> DROPPED << DROPPED)
}
