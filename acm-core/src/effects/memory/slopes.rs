//! Rate of change of a signal that comes piece by piece: the slope of a line through each sample and its neighbours.
//!
//! For a whole trial it is [`crate::slope::slope`], with two neighbours on either side. In a stream no later samples are
//! known, and the line goes through the sample and the two before it: with even spacing this is the slope one sample ago.

use super::{State, take_room};
use crate::slope::{REACH, slope_at};

/// See the head of this file.
#[derive(Debug, Default)]
pub struct Slopes {
    time: Vec<f64>,
    x: Vec<f64>,
    slopes: Vec<f64>,
}

impl Clone for Slopes {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, other: &Self) {
        take_room(&mut self.time, &other.time);
        take_room(&mut self.x, &other.x);
        take_room(&mut self.slopes, &other.slopes);
    }
}

impl State for Slopes {
    fn restart(&mut self) {
        self.time.clear();
        self.x.clear();
    }
}

impl Slopes {
    /// Slopes at the next samples, per second.
    pub fn of(&mut self, time: &[f64], x: &[f64]) -> &[f64] {
        let passed = self.time.len().saturating_sub(REACH);
        self.time.drain(..passed);
        self.x.drain(..passed);
        let first = self.time.len();
        self.time.extend_from_slice(time);
        self.x.extend_from_slice(x);
        self.slopes.clear();
        self.slopes.extend((first..self.time.len()).map(|t| slope_at(&self.time, &self.x, t)));
        &self.slopes
    }
}
