//! Viscous slip: a soft drive yields in proportion to the speed at which it is moved.
//!
//! ```text
//! q̃_j = q_j − c_j dq_j/dt
//! ```
//!
//! | symbol | meaning                                                              | unit |
//! | `c_j`  | time by which the arm trails; negative where it runs ahead           | s    |
//!
//! The speed is the slope of a line through neighbouring samples ([`Slopes`]), up to two future ones among them. First-order
//! approximation of a lag, for one actuator at a time; Olsson et al. (1998), European Journal of Control 4(3).

use crate::effects::actuation::actuators;
use crate::effects::memory::Slopes;
use crate::effects::{
    Carrier, Commutes, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, times,
};
use crate::rig::Signal;

/// See the head of this file.
pub struct ViscousSlip;

/// Trails to start from on either side of 0: the effect is nearly linear in them.
const TRAILS: usize = 6;

impl Effect for ViscousSlip {
    fn name(&self) -> &'static str {
        "viscous_slip"
    }

    fn meaning(&self) -> &'static str {
        "an actuator trails in proportion to its speed"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Olsson et al. (1998), European Journal of Control 4(3)"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, shows_against_rate: true, commutes: Commutes::WithFilters, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let (typical, longest) = (times::typical(rig), 0.1 * times::trial(rig));
        let time = |q: &Signal| {
            let longest = if q.varies() { longest } else { 0.0 };
            ParameterSpec::size(format!("trail_{}", q.name), "s", typical.min(longest)).within(-longest, longest)
        };
        rig.actuators.iter().map(time).collect()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let late = guesses::thinned(&times::grid(rig), TRAILS);
        let either: Vec<f64> = late.iter().flat_map(|trail| [*trail, -trail]).collect();
        guesses::of_each(rig, &self.parameters(rig, carrier), &either, |_, trail| *trail)
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let slopes = memory.states::<Slopes>(columns.len());
        for (j, (q, slopes)) in columns.iter_mut().zip(slopes).enumerate() {
            let speed = slopes.of(&record.time, q);
            for (t, (q, speed)) in q.iter_mut().zip(speed).enumerate() {
                *q -= values.at(j, t) * speed;
            }
        }
    }
}
