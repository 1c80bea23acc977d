//! Samples that cannot be taken leave the estimator as it was.

use acm_core::effects::Carrier;
use acm_export::{ExportError, Origin, c99, rehearsal};
use acm_stream::{Nominal, StateRule};
use rehearsal::Sample;

use crate::compile::{compiler, link, through, written};
use crate::robots::{augmented, hanging, parts, rig, small, term};

/// Oracle: the same program without the samples that it refuses.
#[test]
fn a_refused_sample_changes_nothing() {
    let Some(cc) = compiler() else { return };
    let effects = ["dead_time", "actuator_lag"].map(|name| term(name, Carrier::Rig, &rig())).to_vec();
    for state in [StateRule::Running, StateRule::Window(5)] {
        let parts = parts(small(), Nominal::Augmented(augmented(effects.clone())), state);
        let folder = written(&parts);
        let program = link(cc, &folder, &["estimator.c", "drive.c"], &["-O1", "-fsanitize=address,undefined"]);
        let good = rehearsal::samples(&parts, 300);
        let bad = |k: usize, sample: &Sample| {
            let mut bad = sample.clone();
            match k % 5 {
                0 => bad.inputs[1] = f64::NAN,
                1 => bad.inputs[0] = f64::INFINITY,
                2 => bad.inputs[2] = -2e12,
                3 => bad.elapsed = if k < 5 { f64::NEG_INFINITY } else { 0.0 },
                _ => bad.elapsed = f64::NAN,
            }
            bad
        };
        let both: Vec<Sample> =
            good.iter().enumerate().flat_map(|(k, sample)| [sample.clone(), bad(k, sample)]).collect();
        let found = through(&program, &both);
        assert!(found.iter().skip(1).step_by(2).all(|answer| [1.0, 2.0].contains(&answer[0])));
        let taken: Vec<Vec<f64>> = found.into_iter().step_by(2).collect();
        assert_eq!(taken, through(&program, &good));
    }
}

/// More samples than a delay has room for: refused by its number, and taken again when there is room.
#[test]
fn a_delay_that_is_full_says_so() {
    let Some(cc) = compiler() else { return };
    let model = Nominal::Augmented(augmented(vec![term("dead_time", Carrier::Rig, &rig())]));
    let parts = parts(small(), model, StateRule::Running);
    let folder = written(&parts);
    let flags = ["-O1", "-DESTIMATOR_EFFECT_1_ROOM=6", "-fsanitize=address,undefined"];
    let program = link(cc, &folder, &["estimator.c", "drive.c"], &flags);
    let mut samples = rehearsal::samples(&parts, 30);
    samples.iter_mut().for_each(|sample| sample.elapsed = 1e-4);
    samples[20].elapsed = 100.0;
    let codes: Vec<f64> = through(&program, &samples).iter().map(|answer| answer[0]).collect();
    assert_eq!(codes[..6], [0.0; 6]);
    assert_eq!(codes[6..20], [6.0; 14]);
    assert_eq!(codes[20..25], [0.0; 5]);
}

#[test]
fn a_network_that_corrects_the_actuators_is_refused_by_name() {
    let mut parts = parts(small(), Nominal::Model(hanging()), StateRule::Running);
    parts.tip = 0..1;
    parts.targets = acm_stream::Scaler { mean: vec![0.0], spread: vec![1e-2] };
    parts.straight = vec![];
    parts.actuators = vec![0.1, 0.1];
    for export in [c99::export, acm_export::onnx::export, acm_export::torch::export] {
        let text = export(&parts, &crate::compile::origin()).expect_err("it is refused").to_string();
        assert!(text.contains("corrects the actuators") && text.contains("network.corrects"), "{text}");
    }
}

#[test]
fn a_name_that_is_no_identifier_is_refused() {
    let parts = parts(small(), Nominal::Model(hanging()), StateRule::Running);
    for name in ["", "9lives", "Arm", "my-arm", "über", "a b"] {
        let origin = Origin { name: name.into(), source: String::new(), recorded: None };
        assert!(matches!(c99::export(&parts, &origin), Err(ExportError::Name { .. })), "{name}");
    }
}
