//! Names that are as right as the true one, because the excitation cannot tell them apart.
//!
//! ```text
//! listed where  share · RMS ≤ 0.82 mm,     share = √(left² − own²)/RMS
//! ```
//!
//! | symbol | meaning                                                                        | unit |
//! | `RMS`  | of what the mechanism does to the tip                                          | m    |
//! | `left` | of it that the other effect leaves at its best values                          | m    |
//! | `own`  | of it that the true effect leaves at its best values                           | m    |
//!
//! 0.82 mm is what adds a tenth to the square of 2.6 mm of noise. Shares were measured by fitting every effect of the
//! library to what each mechanism does, without noise, on development trials from 6 s on (before, it is the unknown
//! state at the start that is fitted), to about ±0.02; for steady loads with the calibration free to move, as it takes
//! up a part of them. A mechanism from outside of the library has aliases where an effect takes away 95 % of its
//! square: to name that one is not wrong.

use super::design::Design;
use super::kind::Cause;
use super::truth::Alias;

/// What may hide below the noise, mm.
const HIDDEN: f64 = 0.82;
/// Share that is left of a mechanism of which 95 % of the square are taken away.
const TAKEN: f64 = 0.22;

const SECOND: &str = "a second-order response of large damping is a lag of two poles, and nearly a delay";
const MIRROR: &str = "the arm's map is smooth: a lag before it and a lag behind it blur the same";
const SHORT: &str = "a lag of a tenth of a second, seen ten times a second, is little more than a delay";
const TRAIL: &str = "trailing in proportion to speed is the first order of a lag and of a delay";
const ONE_SPEED: &str = "at one speed, lags, delays and losses against the motion shift the tip by one constant way";
const TURN: &str = "a loss against the motion, with a transition as wide as the play, is that play";
const LOOPS: &str = "both are loops that do not ask for speed and have rounded turns";
const SLOW: &str = "between reversals at equal intervals, what comes late over seconds is a loop";
const SAG: &str = "weight at the tip and weight along the arm sag alike, unless the mass is written down";
const STEADY: &str = "where throttle is steady, a jet is late by nothing that shows";
const STEADY_PUSH: &str = "where throttle is steady, a push of air downwards is like a weight";
const CONTEXT: &str = "a gain that depends on altitude is in the library's second step";

/// Effects of the library that this design cannot tell from the cause, which moves the tip by `rms` mm.
pub fn aliases(cause: Cause, design: Design, rms: f64) -> Vec<Alias> {
    let hidden = |share: f64| match cause.library() {
        Some(_) => share * rms <= HIDDEN,
        None => share <= TAKEN,
    };
    let all = shares(cause, design).iter().filter(|(_, share, _)| hidden(*share));
    all.map(|(name, _, reason)| Alias { name: (*name).into(), reason: (*reason).into() }).collect()
}

/// Effect, share of the cause that it cannot do beyond what the true effect cannot, and why so little.
fn shares(cause: Cause, design: Design) -> &'static [(&'static str, f64, &'static str)] {
    match (cause, design) {
        (Cause::DeadTime, Design::Rich) => &[
            ("second_order_lag", 0.02, SECOND),
            ("actuator_lag", 0.07, SHORT),
            ("viscous_slip", 0.08, TRAIL),
            ("measurement_lag", 0.08, SHORT),
        ],
        (Cause::DeadTime, Design::Paper) => &[
            ("second_order_lag", 0.01, SECOND),
            ("actuator_lag", 0.07, ONE_SPEED),
            ("measurement_lag", 0.07, ONE_SPEED),
            ("viscous_slip", 0.07, ONE_SPEED),
            ("bouc_wen", 0.07, ONE_SPEED),
            ("dry_friction", 0.08, ONE_SPEED),
        ],
        (Cause::ActuatorLag, Design::Rich) => {
            &[("second_order_lag", 0.0, SECOND), ("dead_time", 0.04, SHORT), ("measurement_lag", 0.04, MIRROR)]
        }
        (Cause::ActuatorLag, Design::Paper) => &[
            ("second_order_lag", 0.0, SECOND),
            ("measurement_lag", 0.02, MIRROR),
            ("dead_time", 0.03, ONE_SPEED),
            ("bouc_wen", 0.06, ONE_SPEED),
            ("dry_friction", 0.06, ONE_SPEED),
            ("viscous_slip", 0.09, ONE_SPEED),
        ],
        (Cause::MeasurementLag, Design::Rich) => {
            &[("second_order_lag", 0.01, SECOND), ("actuator_lag", 0.02, MIRROR), ("dead_time", 0.04, SHORT)]
        }
        (Cause::MeasurementLag, Design::Paper) => &[
            ("second_order_lag", 0.0, SECOND),
            ("actuator_lag", 0.01, MIRROR),
            ("dead_time", 0.03, ONE_SPEED),
            ("bouc_wen", 0.07, ONE_SPEED),
            ("dry_friction", 0.07, ONE_SPEED),
            ("viscous_slip", 0.09, ONE_SPEED),
        ],
        (Cause::Backlash, Design::Rich) => &[("bouc_wen", 0.0, TURN), ("dry_friction", 0.0, TURN)],
        (Cause::Backlash, Design::Paper) => &[
            ("bouc_wen", 0.0, TURN),
            ("dry_friction", 0.0, TURN),
            ("actuator_lag", 0.08, ONE_SPEED),
            ("measurement_lag", 0.08, ONE_SPEED),
            ("second_order_lag", 0.08, ONE_SPEED),
        ],
        (Cause::Hysteresis, Design::Rich) => &[("bouc_wen", 0.025, LOOPS), ("dry_friction", 0.065, LOOPS)],
        (Cause::Hysteresis, Design::Paper) => &[("bouc_wen", 0.0, LOOPS), ("dry_friction", 0.03, LOOPS)],
        (Cause::Creep, Design::Paper) => &[("dry_friction", 0.0, SLOW), ("bouc_wen", 0.03, SLOW)],
        (Cause::QuadraticDrag, Design::Paper) => &[
            ("viscous_slip", 0.05, ONE_SPEED),
            ("second_order_lag", 0.08, ONE_SPEED),
            ("dead_time", 0.08, ONE_SPEED),
            ("actuator_lag", 0.12, ONE_SPEED),
            ("measurement_lag", 0.12, ONE_SPEED),
            ("bouc_wen", 0.13, ONE_SPEED),
            ("dry_friction", 0.13, ONE_SPEED),
            ("backlash", 0.21, ONE_SPEED),
        ],
        (Cause::TipLoad, Design::Rich) => &[("self_weight", 0.0, SAG)],
        (Cause::TipLoad, Design::Paper) => {
            &[("self_weight", 0.0, SAG), ("wake_lag", 0.07, STEADY_PUSH), ("downwash", 0.075, STEADY_PUSH)]
        }
        (Cause::SelfWeight, Design::Rich) => &[("tip_load", 0.04, SAG)],
        (Cause::SelfWeight, Design::Paper) => {
            &[("tip_load", 0.04, SAG), ("wake_lag", 0.075, STEADY_PUSH), ("downwash", 0.075, STEADY_PUSH)]
        }
        (Cause::Downwash, Design::Rich) => &[("wake_lag", 0.07, STEADY)],
        (Cause::Downwash, Design::Paper) => {
            &[("wake_lag", 0.03, STEADY), ("self_weight", 0.06, STEADY_PUSH), ("tip_load", 0.075, STEADY_PUSH)]
        }
        (Cause::WakeLag, Design::Paper) => {
            &[("downwash", 0.0, STEADY), ("self_weight", 0.05, STEADY_PUSH), ("tip_load", 0.07, STEADY_PUSH)]
        }
        (Cause::HeightGain, _) => &[("static_gain", 0.0, CONTEXT)],
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::super::kind::{INSIDE, OUTSIDE};
    use super::*;

    /// Oracle: the library's own list.
    #[test]
    fn aliases_are_other_effects_of_the_library() {
        for cause in INSIDE.into_iter().chain(OUTSIDE) {
            assert!(cause.library().is_none_or(|name| acm_core::effects::find(name).is_some()), "{cause:?}");
            for design in Design::ALL {
                for alias in aliases(cause, design, 1.0) {
                    assert!(acm_core::effects::find(&alias.name).is_some(), "{cause:?}: {}", alias.name);
                    assert!(cause.library() != Some(alias.name.as_str()));
                }
            }
        }
    }

    #[test]
    fn a_larger_effect_has_fewer_aliases() {
        let count = |rms: f64| aliases(Cause::DeadTime, Design::Rich, rms).len();
        assert_eq!([count(9.0), count(11.0), count(20.0), count(60.0)], [4, 2, 1, 0]);
    }
}
