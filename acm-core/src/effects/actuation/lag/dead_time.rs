//! Dead time: the model sees each actuator with a fixed delay.
//!
//! ```text
//! q̃(t) = q(t − Δ)
//! ```
//!
//! | symbol | meaning       | unit |
//! | `Δ`    | dead time ≥ 0 | s    |
//!
//! A tip ahead of its actuators is no dead time: their clock is late.
//! Normey-Rico & Camacho (2007), Control of Dead-time Processes, ch. 1.

use crate::effects::actuation::actuators;
use crate::effects::memory::DelayLine;
use crate::effects::{Carrier, Commutes, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, times};

/// See the head of this file.
pub struct DeadTime;

impl Effect for DeadTime {
    fn name(&self) -> &'static str {
        "dead_time"
    }

    fn meaning(&self) -> &'static str {
        "the outputs follow the actuators after a fixed delay"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Normey-Rico & Camacho (2007), Control of Dead-time Processes, ch. 1"
    }

    fn traits(&self) -> Traits {
        Traits { shows_against_rate: true, commutes: Commutes::WithAll, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![times::size(rig, "delay")]
    }

    fn initial_guesses(&self, rig: &Rig, _: Carrier) -> Vec<Vec<f64>> {
        times::grid(rig).into_iter().map(|time| vec![time]).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let (lines, longest) = (memory.states::<DelayLine>(columns.len()), values.largest(0));
        for (q, line) in columns.iter_mut().zip(lines) {
            line.run(&record.time, q, |t| values.at(0, t), longest);
        }
    }
}
