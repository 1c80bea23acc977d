//! Nonlinear stiffness: the outputs follow the actuators as a mass on a spring that hardens or softens with deflection.
//!
//! ```text
//! z'' + 2ζω z' + ω² s(z) = ω² x,   x = (q − m)/h,   q̃ = m + h z,   ω = 2π/P,   at rest at t_0
//! s = z + k (z − c)³ for k ≥ 0,   s = c + sin(κ (z − c))/κ with κ = √(−6k) for k < 0
//! ```
//!
//! | symbol       | meaning                                                                      | unit            |
//! | `P`          | natural period of the linear spring, all actuators; at 0 there is no effect  | s               |
//! | `ζ`          | damping                                                                      | 1               |
//! | `k`          | hardening above 0, softening below as of a pendulum                          | 1               |
//! | `c`          | where in −1 … 1 the spring is as soft, or as hard, as a linear one           | 1               |
//! | `m_j`, `h_j` | middle of the recorded range of each actuator, half its width                | of the actuator |
//!
//! sin(κz)/κ = z + k z³ + … is gravity on a pendulum. Second order in the sampling interval ([`StiffLag`]); states stay within 30
//! half ranges of their actuator. Duffing (1918), Erzwungene Schwingungen bei veränderlicher Eigenfrequenz; Kovacic &
//! Brennan (2011), The Duffing Equation, ch. 1.

use std::f64::consts::TAU;

use crate::effects::actuation::actuators;
use crate::effects::memory::{Friction, Spring, StiffLag, Swing};
use crate::effects::{
    Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, oscillators, times,
};

/// See the head of this file.
pub struct NonlinearStiffness;

/// Parameters before the ends of the ranges.
const OWN: usize = 4;

/// Periods, and for each of them damping ratios and hardnesses, to start from.
const PERIODS: usize = 10;
const DAMPINGS: [f64; 3] = [0.06, 0.25, 0.7];
const HARDNESSES: [f64; 3] = [0.3, 1.0, -0.15];

impl Effect for NonlinearStiffness {
    fn name(&self) -> &'static str {
        "nonlinear_stiffness"
    }

    fn meaning(&self) -> &'static str {
        "the outputs follow the actuators as a mass on a spring that hardens or softens"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Duffing (1918), Erzwungene Schwingungen bei veränderlicher Eigenfrequenz; Kovacic & Brennan (2011), The Duffing Equation, ch. 1"
    }

    fn traits(&self) -> Traits {
        Traits {
            is_rare: true,
            is_resonance: true,
            is_generic: true,
            refines: Some("second_order_lag"),
            ..Traits::default()
        }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let mut specs = oscillators::parameters(rig);
        specs.extend(parameters());
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
            damped.map(move |(damping, hardness)| [period, damping, hardness, 0.0])
        };
        guesses::thinned(&times::periods(rig), PERIODS).into_iter().flat_map(springs).map(at).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        spring(values, OWN, record, memory, columns, |t| Spring {
            hardness: values.at(2, t),
            rest: values.at(3, t),
            friction: Friction::NONE,
        });
    }

    fn memory(&self, values: Values) -> Option<f64> {
        Some(oscillators::fading(values.at(0, 0), values.at(1, 0)))
    }

    fn second_memory(&self, values: Values) -> Option<f64> {
        oscillators::fading_faster(values.at(0, 0), values.at(1, 0))
    }

    fn swinging(&self, values: Values) -> f64 {
        oscillators::swinging(values.at(0, 0), values.at(1, 0))
    }
}

/// Hardness of a spring, and where it rests.
pub(super) fn parameters() -> [ParameterSpec; 2] {
    [
        ParameterSpec::size("hardness", "1", 0.2).within(-0.5, 5.0),
        ParameterSpec::shape("rest", "1", 0.0, 0.2).within(-1.0, 1.0),
    ]
}

/// Moves every actuator as a mass on a spring does. Period and damping are the first two values; ends of the ranges follow `own` of them.
pub(super) fn spring(
    values: Values,
    own: usize,
    record: &Record,
    memory: &mut Memory,
    columns: &mut [Vec<f64>],
    spring: impl Fn(usize) -> Spring,
) {
    let count = columns.len();
    let (lags, mut last) = (memory.states::<StiffLag>(count), Swing::default());
    let ranges: Vec<(f64, f64)> = (0..count).map(|j| actuators::middle_and_half(values, own, count, j)).collect();
    for (t, time) in record.time.iter().enumerate() {
        let (shape, spring) = ((values.at(0, t) / TAU, values.at(1, t)), spring(t));
        for ((q, lag), (middle, half)) in columns.iter_mut().zip(lags.iter_mut()).zip(&ranges) {
            if actuators::is_range(*middle, *half) {
                let x = (q[t] - middle) / half;
                q[t] += half * (lag.step(*time, x, shape, spring, &mut last) - x);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An actuator between 1 and 3 that goes to `to` in a second and stays there, at 100 samples a second.
    fn held(to: f64, values: [f64; 4]) -> Vec<f64> {
        let time: Vec<f64> = (0..4000).map(|k| 0.01 * f64::from(k)).collect();
        let mut columns = vec![time.iter().map(|t| 2.0 + (to - 2.0) * t.min(1.0)).collect::<Vec<f64>>()];
        let record = Record::new(time, columns.clone(), vec![], vec![]);
        let all = [&values[..], &[3.0, 1.0]].concat();
        NonlinearStiffness.act(Carrier::Rig, Values::constant(&[], &all), &record, &mut columns);
        columns.remove(0)
    }

    /// Oracle: by hand, where it comes to rest: z = 1/2 pulls with 0.5 + 0.2³ at k = 1 and c = 0.3, in half ranges, and with 0.3 +
    /// sin(0.2 √3)/√3 = 0.496024 at k = −1/2.
    #[test]
    fn it_rests_where_the_spring_holds() {
        for (k, input) in [(1.0, 0.508), (-0.5, 0.496_023_934), (0.0, 0.5)] {
            let rest = held(2.0 + input, [0.8, 0.4, k, 0.3]);
            assert!((rest[3999] - 2.5).abs() < 1e-8, "{k}: {}", rest[3999]);
        }
    }

    /// Oracle: the closed form of a critically damped linear spring behind a ramp of 1/s.
    #[test]
    fn a_linear_spring_is_exact() {
        let (found, w) = (held(3.0, [3.0, 1.0, 0.0, 0.3]), TAU / 3.0);
        for (k, found) in found.iter().enumerate().take(101) {
            let t = 0.01 * k as f64;
            let sprung = 2.0 + t - 2.0 / w + (-w * t).exp() * (2.0 / w + t);
            assert!((found - sprung).abs() < 1e-10, "{t}: {found} {sprung}");
        }
    }
}
