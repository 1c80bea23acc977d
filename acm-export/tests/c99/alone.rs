//! Nominal models without a network, with effects and without: C answers as Rust does.

use std::process::Command;

use acm_core::effects::Carrier;
use acm_core::{InterSample, NominalModel};
use acm_export::{onnx, torch};
use acm_stream::{Nominal, Parts, Signals};

use crate::compile::{assert_equal, compilers, link, origin, written};
use crate::robots::{augmented, hanging, rig, term};

/// The nominal model alone, with all of its outputs.
pub fn alone(nominal: Nominal) -> Parts {
    let signals =
        Signals { actuators: vec!["q1".into(), "q2".into()], contexts: vec!["throttle".into(), "altitude".into()] };
    let outputs = nominal.outputs();
    Parts::alone(signals, nominal, 0..outputs, 0.1).expect("a nominal model")
}

/// Models of every kind: an arm, a prediction that comes along, an arm with effects, and with actuators that do not go straight.
fn models() -> Vec<Nominal> {
    let terms = ["dead_time", "backlash", "tip_load", "measurement_lag"].map(|name| term(name, Carrier::Rig, &rig()));
    let model = augmented(terms.to_vec());
    let held = model.clone().with_inter_sample(&InterSample::Held(vec![0]));
    let quartic = model.clone().with_inter_sample(&InterSample::Quartic(vec![0, 1]));
    let nothing = Nominal::Model(NominalModel::None { outputs: 2 });
    let mut all = vec![Nominal::Model(hanging()), Nominal::Given(4), nothing];
    all.extend([augmented(vec![]), model, held, quartic].map(Nominal::Augmented));
    all
}

#[test]
fn a_model_without_a_network_answers_as_in_rust() {
    for (k, model) in models().into_iter().enumerate().filter(|(k, _)| *k != 2) {
        assert_equal(&format!("model {k}"), &alone(model), 2000);
    }
}

/// Its self-test passes, with every warning treated as an error.
#[test]
fn the_self_test_of_a_model_without_a_network_passes() {
    for cc in compilers() {
        for model in models() {
            let folder = written(&alone(model));
            let flags = ["-O1", "-DSELFTEST", "-Wconversion", "-Wshadow", "-fsanitize=address,undefined"];
            let program = link(cc, &folder, &["estimator.c"], &flags);
            let output = Command::new(program).output().expect("it runs");
            assert!(output.status.success(), "{cc}: {}", String::from_utf8_lossy(&output.stdout));
        }
    }
}

#[test]
fn formats_of_networks_refuse_it_and_name_the_one_that_takes_it() {
    let parts = alone(Nominal::Augmented(augmented(vec![])));
    for export in [onnx::export, torch::export] {
        let text = export(&parts, &origin()).expect_err("it is refused").to_string();
        assert!(text.contains("without a network") && text.contains("--c99 DIR"), "{text}");
    }
}
