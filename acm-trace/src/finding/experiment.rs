//! The cheapest experiment that separates effects, in words: what to move, what to hold, and what to compare.

/// Effects that differ in the same way from all others.
struct Family {
    names: &'static [&'static str],
    /// Experiment that separates the family's members from each other.
    within: &'static str,
    /// Experiment that shows the family itself.
    shows: &'static str,
}

const FAMILIES: &[Family] = &[
    Family {
        names: &[
            "dead_time",
            "actuator_lag",
            "second_order_lag",
            "nonlinear_stiffness",
            "coulomb_damping",
            "state_dependent_lag",
            "outflow",
            "overflow",
            "friction_lag",
            "asymmetric_lag",
            "viscous_slip",
            "rate_limit",
            "viscous_friction",
            "inertia",
            "vibration_mode",
        ],
        within: "move one actuator in fast steps, small and large, and hold for a second after each: a delay shifts \
                 the whole response, a lag rounds it off, a second-order lag overshoots, a rate limit takes longer \
                 for larger steps",
        shows: "move one actuator at three speeds that differ by a factor of ten: what is late grows with speed",
    },
    Family {
        names: &["measurement_lag", "measurement_creep", "measurement_delay", "measurement_second_order"],
        within: "tap the tip by hand, or whatever is measured, while the actuators rest",
        shows: "tap the tip by hand, or whatever is measured, while the actuators rest: only the \
                measurement delays or rounds off what is seen then",
    },
    Family {
        names: &[
            "backlash",
            "prandtl_ishlinskii",
            "bouc_wen",
            "tendon_friction",
            "dry_friction",
            "output_hysteresis",
            "output_bouc_wen",
            "output_prandtl_ishlinskii",
            "coulomb_friction",
            "dahl_friction",
            "lugre_friction",
            "stribeck_friction",
            "dead_zone",
        ],
        within: "reverse one actuator very slowly at small, middle and large amplitudes, and around two different \
                 angles: a play keeps its width, a hysteresis of many plays grows with the amplitude, friction of a \
                 tendon grows with the angle, a dead zone stays at its place",
        shows: "go up and down very slowly: the gap between both ways does not shrink with speed",
    },
    Family {
        names: &["creep", "zero_drift", "gain_drift"],
        within: "hold one pose for ten times as long as you have, then another, far from it: creep settles, drift \
                 goes on; a drift of the zero is the same at both, one of the gain is not",
        shows: "hold one pose for minutes, and come back to it at the end of the trial",
    },
    Family {
        names: &["measurement_drift"],
        within: "track a marker that is fixed beside the arm",
        shows: "track a marker that is fixed beside the arm: it drifts only if the measurement does",
    },
    Family {
        names: &["tip_load", "self_weight"],
        within: "hang a known mass at the tip in some trials, declare it as `payload`, and track a second marker \
                 half-way: a load at the tip bends the arm near its base more than weight that is spread along it",
        shows: "hang a known mass at the tip in some trials, and declare it as `payload`",
    },
    Family {
        names: &["downwash", "wake_lag", "ground_effect"],
        within: "step the throttle up and down with the arm at rest, near the ground and far from it: the delay of \
                 the response shows the wake, the difference between altitudes the ground",
        shows: "hold the arm still and step the throttle up and down: only the air follows it",
    },
    Family {
        names: &["side_wind", "base_tilt"],
        within: "hover with the arm at rest, then accelerate to both sides: tilt follows the acceleration, wind \
                 does not",
        shows: "accelerate the carrier to both sides with the arm at rest, and record its attitude",
    },
    Family {
        names: &["static_gain", "coupling", "saturation", "encoder_periodic", "input_nonlinearity", "joint_gravity"],
        within: "visit a grid of poses slowly, one actuator at a time and to the ends of its range, then two \
                 together: a gain grows with the angle, a coupling needs the other actuator, a saturation shows \
                 only at the ends",
        shows: "visit a grid of poses slowly, one actuator at a time, to the ends of its range",
    },
    Family {
        names: &["marker_offset", "misregistration", "scale"],
        within: "track a second marker on the arm, and one on the base: a shift of the frame moves all alike, a \
                 marker's offset moves one and turns with the tip, an error of scale grows with the distance",
        shows: "track a marker on the base: it shows the frame whatever the arm does",
    },
    Family {
        names: &["context_term", "context_gain", "context_lag", "input_disturbance", "input_gain"],
        within: "step the context signals one at a time, with the actuators at rest and then far from it: a gain shows only far from rest, \
                 a lag follows each step late, and a disturbance of the input as late as the actuators' own steps",
        shows: "hold the actuators at rest and move the context signal alone through its range, up and down",
    },
];

/// Returns the experiment that would separate these effects; none for fewer than two. Names may have carriers, as in
/// `coulomb_friction(x)`.
pub fn to_separate(names: &[String]) -> Option<String> {
    if names.len() < 2 {
        return None;
    }
    // A user-defined effect has no family, so no experiment is known that separates it from others.
    let known = |name: &String| !families(std::slice::from_ref(name)).is_empty();
    let all_known = names.iter().all(known);
    Some(match families(names)[..] {
        [] => ELSE.into(),
        [one] if all_known => FAMILIES[one].within.into(),
        ref several => shows(several),
    })
}

/// Returns the experiment that would separate these effects from a wrong calibration.
pub fn to_tell_from_calibration(names: &[String]) -> String {
    let how = match families(names)[..] {
        [] => "visit the same poses before and after".to_string(),
        ref several => shows(several),
    };
    format!(
        "recalibration alone takes this over, so no trial like these can show it; record trials that only calibrate, \
         while the effect is surely absent, give them the role `calibration`, and then {how}"
    )
}

/// Returns the experiment that would show effects that cannot be seen in these data.
pub fn to_show(names: &[String]) -> String {
    let how = match families(names)[..] {
        [] => ELSE.to_string(),
        ref several => shows(several),
    };
    format!("these trials show nothing of it, whatever its size: {how}")
}

/// Experiment where no better one is known.
const ELSE: &str = "repeat the recording with other speeds, amplitudes and pauses than these";

/// Largest number of experiments: one after the other, each needs time on the rig.
const MOST: usize = 3;

fn shows(families: &[usize]) -> String {
    families.iter().take(MOST).map(|&f| FAMILIES[f].shows).collect::<Vec<_>>().join("; and ")
}

fn families(names: &[String]) -> Vec<usize> {
    let plain = |name: &str| name.split(['(', ' ']).next().unwrap_or_default().to_string();
    let of = |name: &String| FAMILIES.iter().position(|family| family.names.contains(&plain(name).as_str()));
    let mut families: Vec<usize> = names.iter().filter_map(of).collect();
    families.sort_unstable();
    families.dedup();
    families
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(list: &[&str]) -> Vec<String> {
        list.iter().map(ToString::to_string).collect()
    }

    /// A new effect must be given a place here, so that nobody is left without a next experiment.
    #[test]
    fn every_effect_has_one_family() {
        for effect in acm_core::effects::ALL {
            let families = FAMILIES.iter().filter(|family| family.names.contains(&effect.name())).count();
            assert_eq!(families, 1, "{}", effect.name());
        }
    }

    #[test]
    fn one_family_and_two() {
        assert_eq!(to_separate(&names(&["backlash"])), None);
        assert!(to_separate(&names(&["dead_time", "actuator_lag"])).unwrap().contains("fast steps"));
        let both = to_separate(&names(&["backlash", "actuator_lag"])).unwrap();
        assert!(both.contains("three speeds") && both.contains("very slowly"), "{both}");
        let tap = to_separate(&names(&["actuator_lag", "measurement_lag"])).unwrap();
        assert!(tap.contains("tap the tip"), "{tap}");
    }

    #[test]
    fn an_effect_of_ones_own_is_told_by_what_shows_the_others() {
        let found = to_separate(&names(&["my_effect", "backlash"])).unwrap();
        assert!(found.contains("does not shrink with speed") && !found.contains("a play keeps its width"), "{found}");
        assert_eq!(to_separate(&names(&["my_effect", "my_other"])).unwrap(), ELSE);
    }

    #[test]
    fn carriers_do_not_matter() {
        let bare = to_separate(&names(&["coulomb_friction", "viscous_friction"]));
        assert_eq!(to_separate(&names(&["coulomb_friction(q1)", "viscous_friction(q2) × bend"])), bare);
    }
}
