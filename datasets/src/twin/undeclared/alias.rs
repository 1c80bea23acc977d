//! Names that are as right as the true one, because the excitation cannot tell them apart.
//!
//! A name stands here where its operator, at its best parameters, does the same to the tip as the mechanism does, up to a
//! part of the mechanism that noise covers. Nothing stands here because a finder tends to err there.

use super::design::Design;
use super::kind::Cause;
use super::truth::Alias;

const POLES: &str = "two real poles are a second-order response of large damping";
const MIRROR: &str = "the arm's map is smooth: a lag before it and a lag behind it blur the same";
const ONE_SPEED: &str =
    "at one speed a delay, a lag and a loss against the motion all shift the tip by one constant way";
const ONE_ACTUATOR: &str = "one actuator moves: trailing in proportion to its speed is the first order of a lag";
const SUM_OF_PLAYS: &str = "a play is a sum of plays with one term";
const SOFT_TURN: &str = "a loss against the motion, with a transition as wide as the play, is that play";
const SAME_LOOP: &str =
    "both are rate-independent loops whose turns are rounded: with enough of them they differ within noise";
const SAG: &str = "weight at the tip and weight along the arm sag alike, unless the mass is written down";
const STEADY: &str = "at a steady throttle a jet is late by nothing that shows";
const WEIGHT_OF_AIR: &str = "at a steady throttle a push downwards is like a weight";
const CONTEXT: &str = "a gain that may depend on altitude is in the library's second step";
const SLOW_LAG: &str = "its damping makes it a plain lag where nothing moves fast enough to ring";

/// Effects of the library that this design cannot tell from the cause.
pub fn aliases(cause: Cause, design: Design) -> Vec<Alias> {
    let paper = design == Design::Paper;
    let mut all: Vec<(&str, &str)> = match cause {
        Cause::ActuatorLag => vec![("second_order_lag", POLES), ("measurement_lag", MIRROR)],
        Cause::MeasurementLag => vec![("actuator_lag", MIRROR), ("second_order_lag", MIRROR)],
        Cause::Backlash => {
            vec![("prandtl_ishlinskii", SUM_OF_PLAYS), ("dry_friction", SOFT_TURN), ("bouc_wen", SOFT_TURN)]
        }
        Cause::Hysteresis => {
            vec![("bouc_wen", SAME_LOOP), ("dry_friction", SAME_LOOP), ("backlash", SAME_LOOP)]
        }
        Cause::TipLoad => vec![("self_weight", SAG)],
        Cause::SelfWeight => vec![("tip_load", SAG)],
        Cause::HeightGain => vec![("static_gain", CONTEXT)],
        _ => vec![],
    };
    if paper {
        let shifts = ["dead_time", "actuator_lag", "measurement_lag", "second_order_lag", "backlash", "dry_friction"];
        let loops = ["bouc_wen", "prandtl_ishlinskii"];
        match cause {
            Cause::ActuatorLag | Cause::MeasurementLag | Cause::DeadTime | Cause::QuadraticDrag => {
                all.extend(shifts.map(|name| (name, ONE_SPEED)));
                all.extend(loops.map(|name| (name, ONE_SPEED)));
                all.push(("viscous_slip", ONE_ACTUATOR));
            }
            Cause::Backlash => {
                all.extend(shifts.map(|name| (name, ONE_SPEED)));
                all.push(("viscous_slip", ONE_ACTUATOR));
            }
            Cause::Resonance => all.push(("actuator_lag", SLOW_LAG)),
            Cause::Downwash => all.extend([("wake_lag", STEADY), ("self_weight", WEIGHT_OF_AIR)]),
            Cause::WakeLag => all.extend([("downwash", STEADY), ("self_weight", WEIGHT_OF_AIR)]),
            _ => {}
        }
    }
    let own = cause.library();
    let mut found: Vec<Alias> = Vec::new();
    for (name, reason) in all {
        if Some(name) != own && found.iter().all(|alias| alias.name != name) {
            found.push(Alias { name: name.into(), reason: reason.into() });
        }
    }
    found
}
