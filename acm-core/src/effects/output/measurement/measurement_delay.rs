//! Delay of the measurement: the outputs are recorded with a fixed delay.
//!
//! ```text
//! ỹ_m(t) = y_m(t − Δ)
//! ```
//!
//! | symbol | meaning              | unit |
//! | `Δ`    | delay ≥ 0, all outputs | s    |
//!
//! Before the first sample the outputs rest. Normey-Rico & Camacho (2007), Control of Dead-time Processes, ch. 1.

use crate::effects::memory::DelayLine;
use crate::effects::output::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, times};

/// See the head of this file.
pub struct MeasurementDelay;

impl Effect for MeasurementDelay {
    fn name(&self) -> &'static str {
        "measurement_delay"
    }

    fn meaning(&self) -> &'static str {
        "the outputs are measured after a fixed delay"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Normey-Rico & Camacho (2007), Control of Dead-time Processes, ch. 1"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, is_output_filter: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        if rig.duration > 0.0 { carrying::any(rig) } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![times::size(rig, "delay")]
    }

    fn initial_guesses(&self, rig: &Rig, _: Carrier) -> Vec<Vec<f64>> {
        times::grid(rig).into_iter().map(|time| vec![time]).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let (lines, longest) = (memory.states::<DelayLine>(columns.len()), values.largest(0));
        for (y, line) in columns.iter_mut().zip(lines) {
            line.run(&record.time, y, |t| values.at(0, t), longest);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a ramp of 2/s that is seen 0.6 s late, by hand; the second output is delayed alike.
    #[test]
    fn a_ramp_is_seen_late() {
        let time: Vec<f64> = [0.0, 0.5, 0.7, 1.6, 2.0].into();
        let mut columns = vec![time.iter().map(|t| 2.0 * t).collect(), time.iter().map(|t| 5.0 - t).collect()];
        let record = Record::new(time, vec![], vec![], vec![]);
        MeasurementDelay.act(Carrier::Rig, Values::constant(&[], &[0.6]), &record, &mut columns);
        for (t, late) in [0.0, 0.0, 0.1, 1.0, 1.4].into_iter().enumerate() {
            assert!((columns[0][t] - 2.0 * late).abs() < 1e-12 && (columns[1][t] - 5.0 + late).abs() < 1e-12);
        }
    }
}
