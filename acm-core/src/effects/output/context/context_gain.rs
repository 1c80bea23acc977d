//! A gain that depends on a context signal, such as that of a bridge sensor on its supply voltage.
//!
//! ```text
//! ỹ_m = y_m (1 + k (c − c_0))
//! ```
//!
//! | symbol | meaning                                                                          | unit                  |
//! | `k`    | relative change of every output for a unit of the signal                          | 1 per unit of `c`     |
//! | `c`    | context signal                                                                    | its own               |
//! | `c_0`  | middle of its range: what the gain is there, the nominal model has already | of the signal |
//!
//! Linear in the outputs, so that it acts on each column of a model alike. JCGM 200:2012, International vocabulary of metrology, 4.12
//! and 2.52 (sensitivity, influence quantity).

use super::super::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values};

/// See the head of this file.
pub struct ContextGain;

/// Changes of the gain from the middle of the signal's range to its end, to start from; a typical one, and the largest.
const SHARES: [f64; 4] = [-0.5, -0.1, 0.1, 0.5];
const TYPICAL: f64 = 0.2;
const LARGEST: f64 = 1.0;

impl Effect for ContextGain {
    fn name(&self) -> &'static str {
        "context_gain"
    }

    fn meaning(&self) -> &'static str {
        "the outputs grow by a share that is proportional to a context signal"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "JCGM 200:2012, International vocabulary of metrology"
    }

    fn traits(&self) -> Traits {
        Traits { is_output_filter: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        // For an arm this is a scale of its frame.
        if rig.arm.is_some() { vec![] } else { carrying::moving_contexts(rig) }
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, width) = carrying::range(rig, carrier);
        let half = 0.5 * width;
        let gain = ParameterSpec::size("gain", carrying::per("1", &unit), TYPICAL / half)
            .within(-LARGEST / half, LARGEST / half);
        vec![gain, ParameterSpec::known("centre", unit, carrying::middle(rig, carrier))]
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let half = 0.5 * carrying::range(rig, carrier).1;
        SHARES.iter().map(|share| vec![share / half, carrying::middle(rig, carrier)]).collect()
    }

    fn proceed(&self, carrier: Carrier, values: Values, record: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        multiply(carrier, values, record, columns);
    }
}

/// Multiplies every column by 1 + k (c − c_0).
pub fn multiply(carrier: Carrier, values: Values, record: &Record, columns: &mut [Vec<f64>]) {
    let Some(signal) = carrying::signal(record, carrier) else { return };
    for column in columns {
        for (t, (y, c)) in column.iter_mut().zip(signal).enumerate() {
            *y += *y * values.at(0, t) * (c - values.at(1, t));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. A bridge of 2 mV/V has 10 mV at 5 V, where its model is right, and 11 mV at 5.5 V.
    #[test]
    fn a_bridge_follows_its_supply() {
        let record = Record::new(vec![0.0, 1.0], vec![], vec![vec![5.0, 5.5]], vec![]);
        let mut columns = vec![vec![0.010, 0.010], vec![0.0, -0.020]];
        ContextGain.act(Carrier::Context(0), Values::constant(&[], &[0.2, 5.0]), &record, &mut columns);
        let truth = [[0.010, 0.011], [0.0, -0.022]];
        columns.iter().flatten().zip(truth.iter().flatten()).for_each(|(y, truth)| assert!((y - truth).abs() < 1e-15));
    }
}
