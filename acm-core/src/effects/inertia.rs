//! Inertia: the outputs are shifted in proportion to the acceleration of a signal, as a force is by a moving mass.
//!
//! ```text
//! ỹ_m = y_m + μ_m s̈
//! ```
//!
//! | symbol | meaning                                                               | unit                               |
//! | `μ_m`  | mass, one for each output                                             | of the output per unit and second² |
//! | `s̈`    | rate of the signal's rate ([`super::memory::Slopes`] of it)            | per s²                             |
//!
//! Newton's second law; Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7), for its place beside friction.

use super::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Values, carrying, guesses, memory::Slopes};

/// See the head of this file.
pub struct Inertia;

impl Effect for Inertia {
    fn name(&self) -> &'static str {
        "inertia"
    }

    fn meaning(&self) -> &'static str {
        "a mass that is accelerated shifts the outputs"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Newton's second law; Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7)"
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        carrying::moving(rig)
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, width) = carrying::range(rig, carrier);
        let acceleration = width / carrying::typical_time(rig).powi(2);
        carrying::sizes(rig, "mass", &carrying::per(&unit, "s^2"), acceleration, 1e4)
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
        let Some(rate) = carrying::rate(record, carrier) else { return };
        let Some(slopes) = memory.states::<Slopes>(1).first_mut() else { return };
        carrying::add(columns, |m, t| values.at(m, t), slopes.of(&record.time, rate));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: s = 3 t² is accelerated with 6 wherever a slope sees as many samples on either side.
    #[test]
    fn a_parabola_has_one_acceleration() {
        let time: Vec<f64> = (0..20).map(|k| 0.1 * f64::from(k)).collect();
        let signal = time.iter().map(|t| 3.0 * t * t).collect();
        let record = Record::new(time, vec![], vec![signal], vec![]);
        let mut columns = vec![vec![1.0; 20]];
        Inertia.act(Carrier::Context(0), Values::constant(&[], &[0.5]), &record, &mut columns);
        assert!(columns[0][4..16].iter().all(|y| (y - 4.0).abs() < 1e-9), "{columns:?}");
    }
}
