//! Every effect: equal to Rust.

use acm_core::InterSample;
use acm_core::effects::{ALL, Carrier, Rig, instance::Instance};
use acm_stream::{Nominal, StateRule};

use crate::compile::assert_equal;
use crate::robots::{augmented, augmented_on, parts, rig, small, term};

#[test]
fn every_effect_acts_as_in_rust() {
    for effect in ALL {
        // Some act on rigs without an arm alone.
        let rigs = [rig(), Rig { arm: None, ..rig() }];
        let found = rigs.iter().find_map(|rig| effect.carriers(rig).last().map(|carrier| (rig, *carrier)));
        let (rig, carrier) = found.unwrap_or_else(|| panic!("{} on these rigs", effect.name()));
        let model = Nominal::Augmented(augmented_on(rig.clone(), vec![term(effect.name(), carrier, rig)]));
        let parts = parts(small(), model, StateRule::Running);
        assert_equal(effect.name(), &parts, 1500);
    }
}

/// Windows of rates of change from none, which means the nearest five samples, to many samples, at a rate that a search did not choose.
#[test]
fn rates_of_change_come_from_windows_of_any_width() {
    let rig = rig();
    for name in
        ["coulomb_friction", "stribeck_friction", "viscous_friction", "inertia", "lugre_friction", "output_bouc_wen"]
    {
        for window in [0.0, 0.09, 0.4, 1.2] {
            let mut motion = term(name, Carrier::Actuator(0), &rig);
            *motion.values.last_mut().expect("a window") = window;
            let model = Nominal::Augmented(augmented(vec![motion]));
            assert_equal(&format!("{name}, {window} s"), &parts(small(), model, StateRule::Running), 3000);
        }
    }
}

#[test]
fn sizes_may_depend_on_a_signal() {
    let rig = rig();
    for (name, context) in [
        ("static_gain", Carrier::Context(0)),
        ("dead_time", Carrier::Context(1)),
        ("dry_friction", Carrier::Actuator(1)),
        ("tip_load", Carrier::Context(0)),
        ("second_order_lag", Carrier::Context(1)),
        ("context_term", Carrier::Context(1)),
    ] {
        let effect = acm_core::effects::find(name).expect("an effect");
        let own = effect.carriers(&rig)[0];
        let plain = Instance::new(effect, own, &rig);
        let straight = plain.with_context(context, &rig).expect("it may vary");
        for instance in [straight.clone(), straight.with_bow(&rig).expect("a line")] {
            let guesses = instance.initial_guesses(&rig);
            let mut theta = guesses[guesses.len() / 2].clone();
            let first = instance.own_parameters();
            instance.parameters()[first..]
                .iter()
                .zip(&mut theta[first..])
                .for_each(|(spec, value)| *value = 0.3 * spec.scale);
            let model = Nominal::Augmented(augmented(vec![instance.term(&theta)]));
            assert_equal(&format!("{name} by {context:?}"), &parts(small(), model, StateRule::Running), 1500);
        }
    }
}

/// The latency example's seven, and more of each place, together over ten thousand steps.
#[test]
fn many_effects_act_together() {
    let rig = rig();
    let effects = [
        ("dead_time", Carrier::Rig),
        ("backlash", Carrier::Rig),
        ("dry_friction", Carrier::Rig),
        ("actuator_lag", Carrier::Rig),
        ("creep", Carrier::Rig),
        ("tip_load", Carrier::Rig),
        ("wake_lag", Carrier::Context(0)),
        ("marker_offset", Carrier::Rig),
        ("base_tilt", Carrier::Rig),
        ("misregistration", Carrier::Rig),
        ("dahl_friction", Carrier::Actuator(0)),
        ("context_lag", Carrier::Context(1)),
        ("measurement_lag", Carrier::Rig),
        ("measurement_delay", Carrier::Rig),
    ];
    let terms = effects.map(|(name, carrier)| term(name, carrier, &rig)).to_vec();
    assert_equal("fourteen effects", &parts(small(), Nominal::Augmented(augmented(terms)), StateRule::Running), 10_000);
}

/// Held actuators jump at each sample; every other effect goes straight.
#[test]
fn actuators_may_be_held() {
    let rig = rig();
    let effects = ["dead_time", "backlash", "actuator_lag", "second_order_lag", "creep", "measurement_lag"];
    let terms = effects.map(|name| term(name, Carrier::Rig, &rig)).to_vec();
    let straight = augmented(terms);
    for inter_sample in [InterSample::Held(vec![0]), InterSample::Held(vec![0, 1])] {
        let model = Nominal::Augmented(straight.clone().with_inter_sample(&inter_sample));
        assert_equal(&format!("{inter_sample:?}"), &parts(small(), model, StateRule::Running), 3000);
    }
}

/// Oracle: the stream of the same model. The steps between samples differ, so that some quartics are parabolas or lines.
#[test]
fn actuators_may_follow_a_quartic() {
    let rig = rig();
    let effects = ["dead_time", "backlash", "actuator_lag", "second_order_lag", "creep", "measurement_lag"];
    let terms = effects.map(|name| term(name, Carrier::Rig, &rig)).to_vec();
    let straight = augmented(terms);
    for inter_sample in [InterSample::Quartic(vec![1]), InterSample::Quartic(vec![0, 1])] {
        let model = Nominal::Augmented(straight.clone().with_inter_sample(&inter_sample));
        assert_equal(&format!("{inter_sample:?}"), &parts(small(), model, StateRule::Running), 3000);
    }
}
