//! Delays where the offset between the clocks of actuators and outputs is itself an estimate.
//!
//! ```text
//! Δ ± √(h² + c²)          h: half of the interval of the fit, c: of the offset between the clocks, both of 95 %
//! ```
//!
//! A clock offset acts like a dead time: Δ is what remains of the dead time after the offset. The two errors are independent, since one
//! comes from the rates of the recordings and the other from the residual; so they add in squares.

use crate::finding::{FoundEffect, FoundParameter};

/// Names of delays between actuators and outputs.
const DELAYS: [&str; 2] = ["dead_time", "measurement_delay"];

/// Widens the intervals of delays, of effects and of the clock's correction, by the uncertainty of the clocks.
pub fn widened(
    effects: Vec<FoundEffect>,
    clock: Option<FoundParameter>,
    half: f64,
) -> (Vec<FoundEffect>, Option<FoundParameter>) {
    let is_delay = |effect: &FoundEffect| DELAYS.contains(&effect.name.as_str());
    let of = |effect: FoundEffect| match is_delay(&effect) {
        true => FoundEffect { parameters: effect.parameters.into_iter().map(|p| delay(p, half)).collect(), ..effect },
        false => effect,
    };
    (effects.into_iter().map(of).collect(), clock.map(|clock| wide(clock, half)))
}

/// Widens the interval of a delay, whose lower bound stays at 0 or above. An offset does not change the dependence on a signal.
fn delay(parameter: FoundParameter, half: f64) -> FoundParameter {
    if parameter.depends_on.is_some() {
        return parameter;
    }
    let wide = wide(parameter, half);
    FoundParameter { interval: wide.interval.map(|bound| bound.max(0.0)), ..wide }
}

fn wide(parameter: FoundParameter, half: f64) -> FoundParameter {
    let [low, high] = parameter.interval;
    let value = parameter.value;
    FoundParameter { interval: [value - (value - low).hypot(half), value + (high - value).hypot(half)], ..parameter }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::finding::{Confidence, Level};

    fn found(name: &str, value: f64, interval: [f64; 2]) -> FoundEffect {
        let parameter = FoundParameter {
            name: "delay".into(),
            value,
            unit: "s".into(),
            interval,
            depends_on: None,
            at_bound: false,
            undetermined: false,
        };
        FoundEffect {
            name: name.into(),
            meaning: String::new(),
            site: acm_core::effects::Site::Actuation,
            carrier: None,
            parameters: vec![parameter],
            size: 1.0,
            removes: 0.0,
            confidence: Confidence { level: Level::Sure, share: 1.0 },
            doubts: vec![],
            follows: None,
            equivalent: vec![],
            alternatives: vec![],
            in_calibration: None,
            source: String::new(),
        }
    }

    /// Oracle: by hand, 3 and 4 make 5.
    #[test]
    fn the_interval_of_a_delay_holds_that_of_the_clock() {
        let of = |name, half| {
            let effects = vec![found(name, 0.010, [0.007, 0.013])];
            widened(effects, None, half).0.remove(0).parameters.remove(0).interval
        };
        let near = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c).abs() < 1e-12 && (b - d).abs() < 1e-12;
        assert!(near(of("dead_time", 0.004), [0.005, 0.015]), "{:?}", of("dead_time", 0.004));
        assert!(near(of("dead_time", 0.0), [0.007, 0.013]), "a given offset is known");
        assert!(near(of("dead_time", 0.1), [0.0, 0.010 + 0.003_f64.hypot(0.1)]), "no delay is below 0");
        assert!(near(of("actuator_lag", 0.004), [0.007, 0.013]), "a lag is no delay");
        let open = vec![found("dead_time", 0.01, [f64::NEG_INFINITY, f64::INFINITY])];
        assert_eq!(widened(open, None, 0.01).0[0].parameters[0].interval[1], f64::INFINITY);
        let clock = found("", -0.02, [-0.023, -0.017]).parameters.remove(0);
        let interval = widened(vec![], Some(clock), 0.004).1.map(|clock| clock.interval).unwrap_or_default();
        assert!(near(interval, [-0.025, -0.015]), "{interval:?}");
    }
}
