//! Nonlinear stiffness: the arm follows its actuators as a mass on a spring that hardens, or softens, as it goes out.
//!
//! ```text
//! z'' + 2ζω z' + ω² (z + k z (z² − c²)) = ω² x,   x = (q − m)/h,   q̃ = m + h z,   ω = 2π/P,   z(t_0) = x(t_0)
//! ```
//!
//! | symbol       | meaning                                                                      | unit            |
//! | `P`          | natural period of the linear spring, all actuators; at 0 there is no effect  | s               |
//! | `ζ`          | damping                                                                      | 1               |
//! | `k`          | hardening above 0, softening below                                           | 1               |
//! | `c`          | where in −1 … 1 the linear spring is right                                   | 1               |
//! | `m_j`, `h_j` | middle of the recorded range of each actuator, half its width                | of the actuator |
//!
//! Second order in the time between samples ([`memory::StiffLag`]); no state goes farther than three half ranges from its
//! actuator. Duffing (1918), Erzwungene Schwingungen bei veränderlicher Eigenfrequenz; Kovacic & Brennan (2011), The Duffing
//! Equation, ch. 1.

use std::f64::consts::TAU;

use super::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, actuators, guesses};
use super::{memory, oscillators, times};

/// See the head of this file.
pub struct NonlinearStiffness;

/// Parameters before the ends of the ranges.
const OWN: usize = 4;

/// Periods, and for each of them damping ratios and hardnesses, to start from.
const PERIODS: usize = 10;
const DAMPINGS: [f64; 3] = [0.06, 0.25, 0.7];
const HARDNESSES: [f64; 2] = [0.3, -0.25];

/// Where the linear spring is right at first: a sine has half its time beyond 0.7 of its amplitude.
const CROSSING: f64 = 0.6;

impl Effect for NonlinearStiffness {
    fn name(&self) -> &'static str {
        "nonlinear_stiffness"
    }

    fn meaning(&self) -> &'static str {
        "the arm follows its actuators as a mass on a spring that hardens or softens"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Duffing (1918), Erzwungene Schwingungen bei veränderlicher Eigenfrequenz; Kovacic & Brennan (2011), The Duffing Equation, ch. 1"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, is_generic: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let mut specs = oscillators::parameters(rig);
        specs.push(ParameterSpec::size("hardness", "1", 0.2).within(-0.5, 2.0));
        specs.push(ParameterSpec::shape("crossing", "1", CROSSING, 0.2).within(0.0, 1.0));
        specs.extend(actuators::ends(rig));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        let at = |values: [f64; OWN]| -> Vec<f64> {
            specs.iter().enumerate().map(|(j, spec)| values.get(j).map_or(spec.neutral, |v| spec.inside(*v))).collect()
        };
        let springs = |period: f64| {
            let damped = DAMPINGS.into_iter().flat_map(|damping| HARDNESSES.map(|hardness| (damping, hardness)));
            damped.map(move |(damping, hardness)| [period, damping, hardness, CROSSING])
        };
        guesses::thinned(&times::periods(rig), PERIODS).into_iter().flat_map(springs).map(at).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let count = columns.len();
        let lags = memory.states::<memory::StiffLag>(count);
        for (j, (q, lag)) in columns.iter_mut().zip(lags).enumerate() {
            let (middle, half) = actuators::middle_and_half(values, OWN, count, j);
            if !actuators::is_range(middle, half) {
                continue;
            }
            for (t, (q, time)) in q.iter_mut().zip(&record.time).enumerate() {
                let spring = memory::Spring { hardness: values.at(2, t), crossing: values.at(3, t) };
                let x = (*q - middle) / half;
                *q += half * (lag.step(*time, x, values.at(0, t) / TAU, values.at(1, t), spring) - x);
            }
        }
    }

    fn memory(&self, values: Values) -> Option<f64> {
        Some(oscillators::fading(values.at(0, 0), values.at(1, 0)))
    }
}
