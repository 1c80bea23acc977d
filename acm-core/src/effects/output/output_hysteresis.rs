//! Hysteresis of the outputs over a signal, as an elastic part that yields beyond a travel: an elastic-plastic element.
//!
//! ```text
//! ỹ_m = y_m + h_m (s − P_r(s)),   P_r: play of radius r,   |s − P_r(s)| ≤ r
//! ```
//!
//! | symbol | meaning                                            | unit                    |
//! | `h_m`  | stiffness of the element, one for each output       | of the output per unit  |
//! | `s`    | the signal whose motion carries the hysteresis      | its own                 |
//! | `r`    | travel at which the element yields                 | of the signal           |
//!
//! A radius far below the signal's range makes it the dry friction of `coulomb_friction`, with f = h r.
//! Visintin (1994), Differential Models of Hysteresis, ch. III; Kuhnen (2003), European J. of Control 9(4).

use super::carrying;
use crate::effects::memory::Play;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};

/// See the head of this file.
pub struct OutputHysteresis;

/// Smallest, typical and largest radius as shares of the signal's range.
const RADII: [f64; 3] = [0.0005, 0.05, 0.5];

impl Effect for OutputHysteresis {
    fn name(&self) -> &'static str {
        "output_hysteresis"
    }

    fn meaning(&self) -> &'static str {
        "the outputs lag behind a signal by a loop, whatever its speed"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Visintin (1994), Differential Models of Hysteresis, ch. III; Kuhnen (2003), European J. of Control 9(4)"
    }

    fn traits(&self) -> Traits {
        Traits { follows_pressure: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        carrying::moving(rig)
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, width) = carrying::range(rig, carrier);
        let [smallest, typical, largest] = RADII.map(|share| share * width);
        let mut specs = carrying::sizes(rig, "stiffness", &unit, typical, 100.0);
        specs.push(ParameterSpec::shape("radius", unit, typical, typical).within(smallest, largest));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let (specs, width) = (self.parameters(rig, carrier), carrying::range(rig, carrier).1);
        let radius = |play: f64| guesses::guess_with(&specs, 1.0, specs.len() - 1, 0.5 * play * width);
        guesses::lengths().into_iter().map(radius).collect()
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        let Some(signal) = carrying::signal(record, carrier) else { return };
        let radius = columns.len();
        let (plays, strain) = memory.states_and_column::<Play>(1);
        let Some(play) = plays.first_mut() else { return };
        strain.clear();
        strain.extend(signal.iter().enumerate().map(|(t, s)| s - play.step(*s, values.at(radius, t))));
        carrying::add(columns, |m, t| values.at(m, t), strain);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand: the element follows for one radius, yields, and after a turn needs two radii to yield again.
    #[test]
    fn it_follows_yields_and_turns() {
        let record = Record::new((0..5).map(f64::from).collect(), vec![vec![0.0, 0.5, 3.0, 2.0, 0.0]], vec![], vec![]);
        let mut columns = vec![vec![0.0; 5]];
        OutputHysteresis.act(Carrier::Actuator(0), Values::constant(&[], &[2.0, 1.0]), &record, &mut columns);
        assert_eq!(columns[0], [0.0, 1.0, 2.0, 0.0, -2.0]);
    }
}
