//! A term proportional to a context signal, such as a temperature or a supply pressure.
//!
//! ```text
//! ỹ_m = y_m + k_m (c − c_0)
//! ```
//!
//! | symbol | meaning                                                                              | unit                   |
//! | `k_m`  | sensitivity, one for each output                                                     | of the output per unit |
//! | `c`    | context signal                                                                       | its own                |
//! | `c_0`  | middle of its range: what the term means there, the nominal model has already | of the signal |
//!
//! Fraden (2016), Handbook of Modern Sensors, ch. 3: cross-sensitivity.

use super::super::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};

/// See the head of this file.
pub struct ContextTerm;

impl Effect for ContextTerm {
    fn name(&self) -> &'static str {
        "context_term"
    }

    fn meaning(&self) -> &'static str {
        "the outputs shift in proportion to a context signal"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Fraden (2016), Handbook of Modern Sensors, ch. 3"
    }

    fn traits(&self) -> Traits {
        Traits { is_static: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        carrying::moving_contexts(rig)
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, width) = carrying::range(rig, carrier);
        let mut specs = carrying::sizes(rig, "sensitivity", &unit, width, 40.0);
        specs.push(ParameterSpec::known("centre", unit, carrying::middle(rig, carrier)));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        vec![guesses::guess(&self.parameters(rig, carrier), 1.0)]
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        carrying::add_about_centre(carrier, values, record, memory, columns);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn it_is_silent_at_the_middle_of_the_range() {
        let record = Record::new(vec![0.0, 1.0], vec![], vec![vec![300.0, 310.0]], vec![]);
        let mut columns = vec![vec![1.0, 1.0], vec![0.0, 0.0]];
        ContextTerm.act(Carrier::Context(0), Values::constant(&[], &[0.2, -1.0, 300.0]), &record, &mut columns);
        assert_eq!(columns, [[1.0, 3.0], [0.0, -10.0]]);
    }
}
