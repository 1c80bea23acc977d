//! Inertia: the outputs are shifted in proportion to the acceleration of a signal, as a force is by a moving mass.
//!
//! ```text
//! ỹ_m = y_m + μ_m s̈
//! ```
//!
//! | symbol | meaning                                                               | unit                               |
//! | `μ_m`  | mass, one for each output                                             | of the output per unit and second² |
//! | `s̈`    | second derivative of the signal, by a quartic through a window ([`crate::effects::memory::Derivatives`]) | per s² |
//! | `h`    | half that window                                                      | s                                  |
//!
//! Newton's second law; Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7), for its place beside friction.

use super::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Values, guesses, times};

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
        carrying::motions(rig)
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let unit = carrying::per(&carrying::range(rig, carrier).0, "s^2");
        let acceleration = carrying::typical_speed(rig, carrier) / carrying::typical_time(rig);
        let mut specs = carrying::sizes(rig, "mass", &unit, acceleration, 1e4);
        specs.push(times::window(rig));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        let window = |window| guesses::guess_with(&specs, 1.0, specs.len() - 1, window);
        times::windows(rig).into_iter().map(window).collect()
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        let window = values.at(columns.len(), 0);
        let Some(bend) = carrying::derivative(record, carrier, window, memory, |d| d.acceleration) else { return };
        carrying::add(columns, |m, t| values.at(m, t), bend);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: s = 3 t² is accelerated with 6, whatever the window.
    #[test]
    fn a_parabola_has_one_acceleration() {
        let time: Vec<f64> = (0..40).map(|k| 0.1 * f64::from(k)).collect();
        let signal = time.iter().map(|t| 3.0 * t * t).collect();
        let record = Record::new(time, vec![], vec![signal], vec![]);
        for window in [0.0, 0.35, 1.2] {
            let mut columns = vec![vec![1.0; 40]];
            Inertia.act(Carrier::Context(0), Values::constant(&[], &[0.5, window]), &record, &mut columns);
            assert!(columns[0].iter().all(|y| (y - 4.0).abs() < 1e-8), "{window}: {columns:?}");
        }
    }
}
