//! Delayed signal, held at its first value before the trial and at its last value after it.
//!
//! A negative delay reads ahead as far as there are samples; in a stream it changes nothing.

use super::{State, take_room};

/// Samples per second that memory is reserved for.
const FASTEST: f64 = 1000.0;

/// See the head of this file.
#[derive(Debug, Default)]
pub struct DelayLine {
    time: Vec<f64>,
    x: Vec<f64>,
    /// The sample before the last requested time.
    near: usize,
    /// Samples that no delay reaches any more.
    stale: usize,
}

impl Clone for DelayLine {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, other: &Self) {
        take_room(&mut self.time, &other.time);
        take_room(&mut self.x, &other.x);
        (self.near, self.stale) = (other.near, other.stale);
    }
}

impl State for DelayLine {
    fn restart(&mut self) {
        self.time.clear();
        self.x.clear();
        (self.near, self.stale) = (0, 0);
    }
}

impl DelayLine {
    /// Replaces the next samples by those `delay` seconds earlier; `delay` is at most `longest`.
    pub fn run(&mut self, time: &[f64], x: &mut [f64], delay: impl Fn(usize) -> f64, longest: f64) {
        self.time.extend_from_slice(time);
        self.x.extend_from_slice(x);
        x.iter_mut().zip(time).enumerate().for_each(|(t, (x, time))| *x = self.at(time - delay(t)));
        self.forget(longest);
    }

    fn at(&mut self, then: f64) -> f64 {
        let (time, x, last) = (&self.time, &self.x, self.time.len() - 1);
        let mut k = self.near;
        while k > 0 && time[k] > then {
            k -= 1;
        }
        while k + 2 < time.len() && time[k + 1] <= then {
            k += 1;
        }
        self.near = k;
        if then <= time[0] || last == 0 {
            x[0]
        } else if then >= time[last] {
            x[last]
        } else {
            let share = (then - time[k]) / (time[k + 1] - time[k]);
            x[k] + share * (x[k + 1] - x[k])
        }
    }

    /// Drops samples more than `longest` before the last one, once they are half of all.
    fn forget(&mut self, longest: f64) {
        let Some(last) = self.time.last() else { return };
        let oldest = last - longest.max(0.0);
        while self.stale + 1 < self.time.len() && self.time[self.stale + 1] <= oldest {
            self.stale += 1;
        }
        if 2 * self.stale > self.time.len() {
            self.time.drain(..self.stale);
            self.x.drain(..self.stale);
            self.near = self.near.saturating_sub(self.stale);
            self.stale = 0;
        }
        let room = 8 + (2.0 * FASTEST * longest.clamp(0.0, 60.0)) as usize;
        self.time.reserve(room.saturating_sub(self.time.len()));
        self.x.reserve(room.saturating_sub(self.x.len()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a line that is shown the whole signal so far. It keeps little, and does not grow.
    #[test]
    fn it_forgets_what_no_delay_reaches() {
        let (mut line, mut x) = (DelayLine::default(), 0.0);
        let (mut time, mut signal) = (vec![], vec![]);
        for k in 0..1000 {
            let now = 0.01 * f64::from(k) + if k % 3 == 1 { 0.004 } else { 0.0 };
            x += (0.7 * now).sin();
            time.push(now);
            signal.push(x);
            let delay = |now: f64| 0.03 + 0.02 * (3.0 * now).sin();
            let (mut one, mut all) = ([x], signal.clone());
            line.run(&[now], &mut one, |_| delay(now), 0.05);
            DelayLine::default().run(&time, &mut all, |t| delay(time[t]), f64::INFINITY);
            assert_eq!(one[0], all[time.len() - 1], "sample {k}");
            assert!(line.time.len() < 20 && line.time.capacity() < 200, "{} samples are kept", line.time.len());
        }
        line.restart();
        let mut after = [7.0];
        line.run(&[0.0], &mut after, |_| 0.02, 0.05);
        assert_eq!(after, [7.0], "rest before the first sample");
    }
}
