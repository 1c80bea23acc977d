//! Inter-sample behaviour in a stream: the sample that [`InterSample::of`] adds.

use crate::effects::Record;
use crate::recorded::inter_sample::{InterSample, QUARTIC, halfway, straight};

/// The last samples, and room for the one that is added behind them.
#[derive(Debug, Clone)]
pub struct Between {
    inter_sample: InterSample,
    /// The last sample.
    before: Record,
    /// Times of the last samples, the latest at the end, with room for the next.
    times: [f64; QUARTIC],
    /// Values of each actuator at these.
    values: Vec<[f64; QUARTIC]>,
    /// Number of the last samples, at most one less than a quartic needs.
    count: usize,
    /// Room for the sample that is added.
    room: Record,
}

impl Between {
    /// None if all are interpolated linearly; `sample` has as many signals as the rig.
    pub fn new(inter_sample: InterSample, sample: &Record) -> Option<Self> {
        let values = vec![[0.0; QUARTIC]; sample.actuators.len()];
        let of = || sample.clone();
        (inter_sample != InterSample::Straight).then(|| Self {
            inter_sample,
            before: of(),
            times: [0.0; QUARTIC],
            values,
            count: 0,
            room: of(),
        })
    }

    /// The sample to insert before `now`, if any.
    pub fn added(&mut self, now: &Record) -> Option<&mut Record> {
        let (before, all) = (&self.before, &mut self.room);
        let jumps = |&a: &usize| now.actuators[a] != before.actuators[a];
        let is_added = match &self.inter_sample {
            InterSample::Straight => false,
            InterSample::Held(actuators) => actuators.iter().any(jumps),
            InterSample::Quartic(_) => true,
        };
        if self.count == 0 || !is_added {
            return None;
        }
        let share = self.inter_sample.ahead();
        all.time[0] = straight(before.time[0], now.time[0], share);
        between(&mut all.actuators, &before.actuators, &now.actuators, share);
        between(&mut all.contexts, &before.contexts, &now.contexts, share);
        between(&mut all.acceleration, &before.acceleration, &now.acceleration, share);
        copy(&mut all.actuator_rates, &now.actuator_rates);
        copy(&mut all.context_rates, &now.context_rates);
        match &self.inter_sample {
            InterSample::Straight => {}
            InterSample::Held(actuators) => {
                actuators.iter().for_each(|&a| all.actuators[a][0] = before.actuators[a][0]);
            }
            InterSample::Quartic(actuators) => {
                between(&mut all.actuator_rates, &before.actuator_rates, &now.actuator_rates, share);
                between(&mut all.context_rates, &before.context_rates, &now.context_rates, share);
                let first = QUARTIC - 1 - self.count;
                self.times[QUARTIC - 1] = now.time[0];
                for &a in actuators {
                    self.values[a][QUARTIC - 1] = now.actuators[a][0];
                    all.actuators[a][0] = halfway(&self.times[first..], &self.values[a][first..]);
                }
            }
        }
        Some(all)
    }

    /// Keeps the last sample.
    pub fn keep(&mut self, now: &Record) {
        self.note(now);
        let earlier = 1..QUARTIC - 1;
        self.times.copy_within(earlier.clone(), 0);
        self.times[QUARTIC - 2] = now.time[0];
        for (values, actuator) in self.values.iter_mut().zip(&now.actuators) {
            values.copy_within(earlier.clone(), 0);
            values[QUARTIC - 2] = actuator[0];
        }
        self.count = (self.count + 1).min(QUARTIC - 1);
    }

    /// Takes over the last samples of another of the same model.
    pub fn take(&mut self, other: &Self) {
        self.note(&other.before);
        (self.times, self.count) = (other.times, other.count);
        self.values.copy_from_slice(&other.values);
    }

    fn note(&mut self, now: &Record) {
        self.before.time[0] = now.time[0];
        copy(&mut self.before.actuators, &now.actuators);
        copy(&mut self.before.contexts, &now.contexts);
        copy(&mut self.before.acceleration, &now.acceleration);
        copy(&mut self.before.actuator_rates, &now.actuator_rates);
        copy(&mut self.before.context_rates, &now.context_rates);
    }

    /// Forgets the trial.
    pub fn restart(&mut self) {
        self.count = 0;
    }
}

fn between(to: &mut [Vec<f64>], before: &[Vec<f64>], now: &[Vec<f64>], ahead: f64) {
    to.iter_mut()
        .zip(before.iter().zip(now))
        .for_each(|(to, (before, now))| to[0] = straight(before[0], now[0], ahead));
}

fn copy(to: &mut [Vec<f64>], from: &[Vec<f64>]) {
    to.iter_mut().zip(from).for_each(|(to, from)| to[0] = from[0]);
}
