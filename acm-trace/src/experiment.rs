//! The cheapest experiment that tells effects apart, in words.

/// Effects that differ in the same way from all others.
struct Family {
    names: &'static [&'static str],
    /// What separates its members from each other.
    within: &'static str,
    /// What shows the family itself.
    shows: &'static str,
}

const FAMILIES: &[Family] = &[
    Family {
        names: &["dead_time", "actuator_lag", "second_order_lag", "measurement_lag", "viscous_slip", "rate_limit", "viscous_friction"],
        within: "move one actuator in fast steps and hold: a delay shifts the whole response, a lag rounds it off; to tell \
                 the actuation from the measurement, tap the tip by hand while the actuators rest",
        shows: "move one actuator at three speeds that differ by a factor of ten: what is late grows with speed",
    },
    Family {
        names: &["backlash", "prandtl_ishlinskii", "bouc_wen", "tendon_friction", "dry_friction", "output_hysteresis", "coulomb_friction", "dead_zone"],
        within: "reverse one actuator at small, middle and large amplitudes, very slowly: a play keeps its width, friction of a \
                 tendon grows with the angle, a hysteresis of many plays grows with the amplitude",
        shows: "go up and down very slowly: the gap between both ways does not shrink with speed",
    },
    Family {
        names: &["creep", "zero_drift", "gain_drift", "measurement_drift"],
        within: "hold one pose for ten times as long as you have: creep settles, drift goes on; repeat at another pose to \
                 tell a drift of the zero from one of the gain",
        shows: "hold one pose for minutes",
    },
    Family {
        names: &["tip_load", "self_weight"],
        within: "hang a known mass at the tip and declare it as `payload`: a load at the tip bends the arm near its base more \
                 than weight that is spread along it",
        shows: "hang a known mass at the tip, and declare it as `payload`",
    },
    Family {
        names: &["downwash", "wake_lag", "ground_effect"],
        within: "step the throttle at two altitudes with the arm at rest: the delay of the response shows the wake, the \
                 difference between altitudes the ground",
        shows: "hold the arm still and step the throttle",
    },
    Family {
        names: &["side_wind", "base_tilt"],
        within: "hover, then accelerate to both sides: tilt follows the acceleration, wind does not",
        shows: "accelerate the carrier with the arm at rest",
    },
    Family {
        names: &["static_gain", "coupling", "saturation", "encoder_periodic", "marker_offset", "misregistration", "scale", "context_term"],
        within: "visit a grid of poses slowly with one actuator at a time, to the ends of its range: a gain grows with the \
                 angle, a shift of the frame is the same everywhere, a marker's offset turns with the tip",
        shows: "visit a grid of poses slowly, before and after",
    },
];

/// The experiment that would tell these effects apart; none for fewer than two.
pub fn to_separate(names: &[String]) -> Option<String> {
    if names.len() < 2 {
        return None;
    }
    let of = |name: &String| FAMILIES.iter().position(|family| family.names.contains(&name.as_str()));
    let mut families: Vec<usize> = names.iter().filter_map(of).collect();
    families.sort_unstable();
    families.dedup();
    match families[..] {
        [] => Some("repeat the recording with other speeds, amplitudes and pauses than these".into()),
        [one] => Some(FAMILIES[one].within.into()),
        _ => Some(families.iter().take(2).map(|&f| FAMILIES[f].shows).collect::<Vec<_>>().join("; and ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A new effect must be given a place here, so that nobody is left without a next experiment.
    #[test]
    fn every_effect_has_a_family() {
        let known = |name: &str| FAMILIES.iter().any(|family| family.names.contains(&name));
        let lost: Vec<&str> =
            acm_core::effects::ALL.iter().map(|effect| effect.name()).filter(|name| !known(name)).collect();
        assert!(lost.iter().all(|name| *name == "inertia"), "{lost:?}");
    }

    #[test]
    fn one_family_and_two() {
        let names = |list: &[&str]| list.iter().map(|name| name.to_string()).collect::<Vec<_>>();
        assert_eq!(to_separate(&names(&["backlash"])), None);
        assert!(to_separate(&names(&["dead_time", "actuator_lag"])).unwrap().contains("fast steps"));
        let both = to_separate(&names(&["backlash", "actuator_lag"])).unwrap();
        assert!(both.contains("three speeds") && both.contains("very slowly"), "{both}");
    }
}
