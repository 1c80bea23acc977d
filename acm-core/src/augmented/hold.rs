//! Held actuators, sample by sample: the sample ahead of a jump that [`crate::held()`] adds.

use crate::effects::Record;
use crate::recorded::held::ahead;

/// The last sample, and what is held.
#[derive(Debug, Clone)]
pub struct Hold {
    actuators: Vec<usize>,
    /// One sample.
    before: Record,
    has_begun: bool,
    /// Room for the sample ahead of a jump.
    room: Record,
}

impl Hold {
    /// Nothing where no actuator is held; `sample` has as many signals as the rig.
    pub fn new(actuators: Vec<usize>, sample: &Record) -> Option<Self> {
        let of = || sample.clone();
        (!actuators.is_empty()).then(|| Self { actuators, before: of(), has_begun: false, room: of() })
    }

    /// The sample ahead of `now`; none where nothing jumps.
    pub fn ahead(&mut self, now: &Record) -> Option<&mut Record> {
        let before = &self.before;
        let jumps = self.has_begun && self.actuators.iter().any(|&a| now.actuators[a] != before.actuators[a]);
        if !jumps {
            return None;
        }
        let all = &mut self.room;
        all.time[0] = ahead(before.time[0], now.time[0]);
        straight(&mut all.actuators, &before.actuators, &now.actuators);
        self.actuators.iter().for_each(|&a| all.actuators[a][0] = before.actuators[a][0]);
        straight(&mut all.contexts, &before.contexts, &now.contexts);
        straight(&mut all.acceleration, &before.acceleration, &now.acceleration);
        copy(&mut all.actuator_rates, &now.actuator_rates);
        copy(&mut all.context_rates, &now.context_rates);
        Some(all)
    }

    /// Keeps the last sample.
    pub fn keep(&mut self, now: &Record) {
        self.before.time[0] = now.time[0];
        copy(&mut self.before.actuators, &now.actuators);
        copy(&mut self.before.contexts, &now.contexts);
        copy(&mut self.before.acceleration, &now.acceleration);
        self.has_begun = true;
    }

    /// Takes over the last sample of another of the same model.
    pub fn take(&mut self, other: &Self) {
        self.keep(&other.before);
        self.has_begun = other.has_begun;
    }

    /// Forgets the trial.
    pub fn restart(&mut self) {
        self.has_begun = false;
    }
}

fn straight(to: &mut [Vec<f64>], before: &[Vec<f64>], now: &[Vec<f64>]) {
    to.iter_mut().zip(before.iter().zip(now)).for_each(|(to, (before, now))| to[0] = ahead(before[0], now[0]));
}

fn copy(to: &mut [Vec<f64>], from: &[Vec<f64>]) {
    to.iter_mut().zip(from).for_each(|(to, from)| to[0] = from[0]);
}
