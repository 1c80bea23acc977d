//! Dead time: the model sees each actuator as it was a moment ago.
//!
//! ```text
//! q̃(t) = q(t − Δ)
//! ```
//!
//! | symbol | meaning                                                             | unit |
//! | `Δ`    | dead time; negative where the actuators' clock is late, not the tip | s    |
//!
//! Normey-Rico & Camacho (2007), Control of Dead-time Processes, ch. 1.

use super::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, actuators, memory::DelayLine};

/// See the head of this file.
pub struct DeadTime;

impl Effect for DeadTime {
    fn name(&self) -> &'static str {
        "dead_time"
    }

    fn meaning(&self) -> &'static str {
        "the tip follows the actuators after a fixed delay"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Normey-Rico & Camacho (2007), Control of Dead-time Processes, ch. 1"
    }

    fn traits(&self) -> Traits {
        Traits { shows_against_rate: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let longest = (0.1 * actuators::trial(rig)).min(2.0);
        vec![ParameterSpec::size("delay", "s", longest.min(0.2)).within(-0.5 * longest, longest)]
    }

    fn starts(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let spec = &self.parameters(rig, carrier)[0];
        let late = actuators::times(&[0.05, 0.2, 0.6], 0.0, spec.upper);
        late.into_iter().chain([(-0.1f64).max(0.5 * spec.lower)]).map(|delay| vec![delay]).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let (lines, longest) = (memory.states::<DelayLine>(columns.len()), values.largest(0));
        for (q, line) in columns.iter_mut().zip(lines) {
            line.run(&record.time, q, |t| values.at(0, t), longest);
        }
    }
}
