//! Prandtl–Ishlinskii hysteresis as a sum of plays: after a reversal each play is taken up in turn.
//!
//! ```text
//! q̃ = q + Σ_i w_i (P_{r_i}[q] − q),   P_r the play of half-width r
//! ```
//!
//! | symbol | meaning                                                              | unit            |
//! | `w_i`  | weight of each play, all actuators                                   | 1               |
//! | `r_i`  | its half-width: 6, 14, 24, 36, 50, 65, 82 and 100 % of the largest   | of the actuator |
//! | `r`    | the largest half-width                                               | of the actuator |
//!
//! Where actuators have different units, `r` is a share of each one's own travel. Kuhnen (2003), European Journal of
//! Control 9(4).

use super::length::{self, Length};
use crate::effects::actuation::actuators;
use crate::effects::memory::Play;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};

/// See the head of this file.
pub struct PrandtlIshlinskii;

/// Half-widths as shares of the largest.
const SHARES: [f64; PLAYS] = [0.06, 0.14, 0.24, 0.36, 0.5, 0.65, 0.82, 1.0];
const PLAYS: usize = 8;

/// Weights to start from, as shares of a typical one.
const WEIGHTS: [f64; 3] = [0.1, 0.3, 1.0];

/// Largest half-widths to start from.
const RADII: usize = 5;

impl Effect for PrandtlIshlinskii {
    fn name(&self) -> &'static str {
        "prandtl_ishlinskii"
    }

    fn meaning(&self) -> &'static str {
        "an actuator loses motion at each reversal, more the further it turns back"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Kuhnen (2003), European Journal of Control 9(4)"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, is_generic: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let lengths = Length::of(rig);
        let weight = |i: usize| ParameterSpec::size(format!("weight_{}", i + 1), "1", 0.15).within(0.0, 1.0);
        let mut specs: Vec<ParameterSpec> = (0..PLAYS).map(weight).collect();
        specs.push(lengths.shape("radius", 0.2, 0.002, 0.5));
        specs.extend(lengths.known());
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        let radii = guesses::thinned(&Length::of(rig).grid(), RADII);
        let at = |share: f64| {
            let specs = &specs;
            radii.iter().map(move |radius| guesses::guess_with(specs, share, PLAYS, *radius))
        };
        WEIGHTS.into_iter().flat_map(at).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let plays = memory.states::<[Play; PLAYS]>(columns.len());
        for (j, (q, plays)) in columns.iter_mut().zip(plays).enumerate() {
            let radius = values.at(PLAYS, 0) * length::unit_of_length(values, PLAYS + 1, j);
            for (t, q) in q.iter_mut().enumerate() {
                let before = *q;
                for (i, play) in plays.iter_mut().enumerate() {
                    *q += values.at(i, t) * (play.step(before, radius * SHARES[i]) - before);
                }
            }
        }
    }
}
