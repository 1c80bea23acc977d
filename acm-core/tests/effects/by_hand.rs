//! Effects of the actuation against closed forms and hand arithmetic. Values are set by name; what is not set is at rest.

use std::f64::consts::TAU;

use acm_core::effects::{Carrier, Values, find};
use acm_core::record::Record;
use acm_core::rig::Rig;

use crate::rigs::{passive, signal};

/// What the effect makes of these actuators, one sample every half second.
fn acted(name: &str, carrier: Carrier, set: &[(&str, f64)], rig: &Rig, actuators: &[&[f64]]) -> Vec<Vec<f64>> {
    let effect = find(name).expect("an effect");
    let specs = effect.parameters(rig, carrier);
    let mut values: Vec<f64> = specs.iter().map(|spec| spec.neutral).collect();
    for (name, value) in set {
        let j = specs.iter().position(|spec| spec.name == *name);
        values[j.unwrap_or_else(|| panic!("{name} is none of {specs:?}"))] = *value;
    }
    let mut columns: Vec<Vec<f64>> = actuators.iter().map(|q| q.to_vec()).collect();
    let time = (0..columns[0].len()).map(|k| 10.0 + 0.5 * k as f64).collect();
    let record = Record::new(time, columns.clone(), vec![], vec![]);
    effect.act(carrier, Values::constant(&specs, &values), &record, &mut columns);
    columns
}

/// Two actuators in rad, from −1 to 1 and from 0 to 2.
fn two() -> Rig {
    Rig { actuators: vec![signal("q1", "rad", -1.0, 1.0), signal("q2", "rad", 0.0, 2.0)], ..passive().rig }
}

fn close(found: &[Vec<f64>], expected: &[&[f64]]) {
    for (found, expected) in found.iter().zip(expected) {
        let off = found.iter().zip(*expected).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(found.len() == expected.len() && off < 1e-12, "{found:?} and not {expected:?}");
    }
}

#[test]
fn static_effects() {
    let (rig, q1, q2) = (two(), [-1.0, 0.0, 0.5, 1.0], [0.0, 0.1, 1.0, 2.0]);
    let on = |name, set: &[(&str, f64)]| acted(name, Carrier::Rig, set, &rig, &[&q1, &q2]);
    let gain = on("static_gain", &[("gain_q1", 0.1), ("offset_q2", -0.2)]);
    close(&gain, &[&[-1.1, 0.0, 0.55, 1.1], &[-0.2, -0.1, 0.8, 1.8]]);
    let cut = on("saturation", &[("upper_cut_q1", 0.25), ("lower_cut_q2", 0.5), ("roundness", 0.0)]);
    close(&cut, &[&[-1.0, 0.0, 0.5, 0.75], &[0.5, 0.5, 1.0, 2.0]]);
    // Radius 0.5: 0.1 lies 0.4 below the lower end, and (0.4 + 0.5)²/2 is added.
    let soft = on("saturation", &[("upper_cut_q1", 0.25), ("lower_cut_q2", 0.5), ("roundness", 1.0)]);
    close(&soft, &[&[-1.0, 0.0, 0.5, 0.75], &[0.5, 0.505, 1.0, 2.0]]);
    let dead = on("dead_zone", &[("half_width_q1", 0.2), ("half_width_q2", 0.3), ("roundness", 0.0)]);
    close(&dead, &[&[-0.8, 0.0, 0.3, 0.8], &[0.0, 0.0, 0.7, 1.7]]);
    // Radius 0.2: 0.5 lies 0.1 beyond the zone's end, and (0.1 + 0.2)²/0.8 follows.
    let soft = on("dead_zone", &[("half_width_q1", 0.4), ("roundness", 0.5)]);
    close(&soft, &[&[-0.6, 0.0, 0.1125, 0.6], &q2]);
    let coupled = on("coupling", &[("q1_of_q2", 0.1), ("q2_of_q1", -0.2)]);
    close(&coupled, &[&[-1.0, 0.01, 0.6, 1.2], &[0.2, 0.1, 0.9, 1.8]]);
    // At 1.5 periods a unit, half a unit is three quarters of a period: the sine is −1.
    let set = [("sine_q1", 0.05), ("cosine_q1", 0.02), ("periods_q1", 1.5)];
    let periodic = acted("encoder_periodic", Carrier::Actuator(0), &set, &rig, &[&q1, &q2]);
    close(&periodic, &[&[-1.02, 0.02, 0.45, 0.98], &q2]);
}

#[test]
fn drifts() {
    let (rig, q1, q2) = (two(), [1.0, 1.0, 2.0], [0.0, 4.0, 4.0]);
    let gain = acted("gain_drift", Carrier::Rig, &[("rate", 0.01)], &rig, &[&q1, &q2]);
    close(&gain, &[&[1.0, 1.005, 2.02], &[0.0, 4.02, 4.04]]);
    let zero = acted("zero_drift", Carrier::Rig, &[("rate_q2", -0.02)], &rig, &[&q1, &q2]);
    close(&zero, &[&q1, &[0.0, 3.99, 3.98]]);
}

/// Friction and hysteresis, far from the last turn: a way forth and a way back much longer than their transition.
#[test]
fn friction_in_steady_motion() {
    let (rig, q1, q2) = (two(), [0.0, 0.9, 0.9, -0.8], [2.0, 1.0, 1.5, 2.0]);
    let on = |name, set: &[(&str, f64)]| acted(name, Carrier::Rig, set, &rig, &[&q1, &q2]);
    let dry = on("dry_friction", &[("friction_q1", 0.05), ("friction_q2", 0.1), ("presliding", 0.004)]);
    close(&dry, &[&[0.0, 0.85, 0.85, -0.75], &[2.0, 1.1, 1.4, 1.9]]);
    let tendon = on("tendon_friction", &[("friction_q1", 0.1), ("friction_q2", 0.2), ("presliding", 0.004)]);
    close(&tendon, &[&[0.0, 0.81, 0.81, -0.72], &[2.0, 1.2, 1.2, 1.6]]);
    let smooth = on("bouc_wen", &[("opening_q1", 0.05), ("opening_q2", 0.1), ("width", 0.004), ("asymmetry", 0.5)]);
    close(&smooth, &[&[0.0, 0.85, 0.85, -0.75], &[2.0, 1.1, 1.4, 1.9]]);
    let play = on("backlash", &[("width_q1", 0.05), ("width_q2", 0.1)]);
    close(&play, &[&[0.0, 0.85, 0.85, -0.75], &[2.0, 1.1, 1.4, 1.9]]);
}

/// After a turn and a way back of Δ, Dahl's state is −1 + 2 e^{−Δ/δ}, and Bouc–Wen's with a = 0 is 1 − Δ/δ.
#[test]
fn friction_just_after_a_turn() {
    let (rig, q1, q2) = (two(), [-1.0, 1.0, 0.99], [1.0, 1.0, 1.0]);
    let on = |name, set: &[(&str, f64)]| acted(name, Carrier::Rig, set, &rig, &[&q1, &q2]);
    let state = -1.0 + 2.0 * (-0.5f64).exp();
    let dry = on("dry_friction", &[("friction_q1", 0.1), ("presliding", 0.02)]);
    close(&dry, &[&[-1.0, 0.9, 0.99 - 0.1 * state], &q2]);
    let smooth = on("bouc_wen", &[("opening_q1", 0.1), ("width", 0.02), ("asymmetry", 0.0)]);
    close(&smooth, &[&[-1.0, 0.9, 0.99 - 0.05], &q2]);
}

/// Plays of 6, 24 and 100 % of 0.4: ±0.024, ±0.096, ±0.4. A turn back by 0.3 takes up the first two, 0.048 and 0.192.
#[test]
fn prandtl_ishlinskii_is_a_sum_of_plays() {
    let (rig, q1, q2) = (two(), [-1.0, 1.0, 0.7], [1.0, 1.0, 1.0]);
    let set = [("weight_1", 0.5), ("weight_3", 0.25), ("weight_8", 0.1), ("radius", 0.4)];
    let found = acted("prandtl_ishlinskii", Carrier::Rig, &set, &rig, &[&q1, &q2]);
    let there = 1.0 - 0.5 * 0.024 - 0.25 * 0.096 - 0.1 * 0.4;
    let back = 0.7 + 0.5 * 0.024 + 0.25 * 0.096 + 0.1 * (0.6 - 0.7);
    close(&found, &[&[-1.0, there, back], &q2]);
}

/// Actuators of two units share lengths as shares of their travel: 0.01 of 2 rad, and of 200 Pa.
#[test]
fn lengths_are_shares_where_units_differ() {
    let actuators = vec![signal("q1", "rad", -1.0, 1.0), signal("p", "Pa", 0.0, 200.0)];
    let rig = Rig { actuators, ..passive().rig };
    let (q, p) = ([-1.0, 1.0, 0.99], [0.0, 200.0, 199.0]);
    let set = [("friction_q1", 0.1), ("friction_p", 10.0), ("presliding", 0.01)];
    let found = acted("dry_friction", Carrier::Rig, &set, &rig, &[&q, &p]);
    let state = -1.0 + 2.0 * (-0.5f64).exp();
    close(&found, &[&[-1.0, 0.9, 0.99 - 0.1 * state], &[0.0, 190.0, 199.0 - 10.0 * state]]);
}

/// A ramp of 2/s: the lag trails by 2τ (1 − e^{−t/τ}), creep by its share of that, slip by 2c, the rate limit as it must.
#[test]
fn effects_of_time_on_a_ramp() {
    let (rig, q1, q2) = (two(), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0], [1.0; 6]);
    let on = |name, set: &[(&str, f64)]| acted(name, Carrier::Rig, set, &rig, &[&q1, &q2]);
    let each = |f: &dyn Fn(f64) -> f64| -> Vec<f64> { (0..6).map(|k| f(0.5 * f64::from(k))).collect() };
    let behind = |tau: f64| move |t: f64| 2.0 * tau * (1.0 - (-t / tau).exp());
    let lag = each(&|t| 2.0 * t - behind(0.7)(t));
    close(&on("actuator_lag", &[("tau", 0.7)]), &[&lag, &q2]);
    let creep = each(&|t| 2.0 * t - 0.3 * behind(4.0)(t));
    close(&on("creep", &[("share", 0.3), ("tau", 4.0)]), &[&creep, &q2]);
    close(&on("viscous_slip", &[("trail_q1", 0.1)]), &[&each(&|t| 2.0 * t - 0.2), &q2]);
    let (up, down) = (q1, [2.0, 1.5, 1.0, 0.5, 0.0, -0.5]);
    let slip = acted("viscous_slip", Carrier::Rig, &[("trail_q2", 0.1)], &rig, &[&up, &down]);
    close(&slip, &[&up, &down.map(|q| q + 0.1)]);
    close(&on("rate_limit", &[("slowness_q1", 0.8)]), &[&each(&|t| t / 0.8), &q2]);
    close(&on("rate_limit", &[("slowness_q1", 0.4)]), &[&q1, &q2]);
    close(&on("dead_time", &[("delay", 0.6)]), &[&each(&|t| 2.0 * (t - 0.6).max(0.0)), &q2]);
    let w = TAU / 3.0;
    let sprung = each(&|t| 2.0 * (t - 2.0 / w + (-w * t).exp() * (2.0 / w + t)));
    close(&on("second_order_lag", &[("period", 3.0), ("damping", 1.0)]), &[&sprung, &q2]);
}

/// What lasts of an unknown start: τ, and one over the real part of the slower pole.
#[test]
fn memory_is_the_slower_time() {
    let rig = two();
    for (name, values, expected) in [
        ("actuator_lag", vec![0.7], 0.7),
        ("creep", vec![0.3, 8.0], 8.0),
        ("second_order_lag", vec![TAU, 0.25], 4.0),
        // Poles of s² + 2.5 s + 1: −2 and −½.
        ("second_order_lag", vec![TAU, 1.25], 2.0),
    ] {
        let effect = find(name).expect("an effect");
        let specs = effect.parameters(&rig, Carrier::Rig);
        let found = effect.memory(Values::constant(&specs, &values)).expect("a time");
        assert!((found - expected).abs() < 1e-12, "{name}: {found}");
    }
}
