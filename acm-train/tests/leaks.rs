//! Held-out trials take no part in learning.

mod campaign;

use campaign::{Campaign, tip};

/// A number of each trial that nothing recorded tells.
fn canary(trial: usize) -> f64 {
    [0.0, 0.31, -0.12, 0.05, -0.27, 0.22][trial] * 0.1
}

/// The target is a constant of the trial, so nothing that is learned on other trials can know it.
#[test]
fn a_canary_is_not_predicted() {
    let campaign = Campaign::with(|trial, _| [canary(trial); 3]);
    for kind in ["mlp", "gru", "cfc"] {
        let edits =
            [format!("network={{kind=\"{kind}\"}}"), "nominal.model=\"none\"".into(), "training.epochs=12".into()];
        let arguments: Vec<&str> = edits.iter().flat_map(|edit| ["--set", edit]).collect();
        for record in campaign.learn(kind, &arguments) {
            let scores = &record.held_out.unwrap().estimators[kind];
            assert!(scores.r2.iter().all(|r2| *r2 <= 0.1), "{kind} explains the canary: R² {:?}", scores.r2);
        }
    }
}

/// The same campaign with held-out measurements a thousand times as large.
#[test]
fn held_out_measurements_leave_no_trace_in_the_training() {
    let campaign = Campaign::new();
    let scaled = Campaign::with(|trial, k| tip(trial, k).map(|value| if trial >= 4 { 1000.0 * value } else { value }));
    let arguments = ["--set", "protocol.cross_validation=true"];
    let plain = campaign.learn("run", &arguments);
    let large = scaled.learn("run", &arguments);
    let log = campaign.read("run/training.log");
    assert!(log.len() > 1000 && log == scaled.read("run/training.log"), "the training logs differ");
    for (a, b) in plain.iter().zip(&large) {
        assert_eq!((&a.epochs, &a.validation), (&b.epochs, &b.validation));
        let checkpoint = format!("run/checkpoints/{}.safetensors", a.id);
        assert!(campaign.read(&checkpoint) == scaled.read(&checkpoint), "the weights of {} differ", a.id);
    }
    let error = |records: &[acm_train::run::record::RunRecord]| {
        records.iter().find_map(|r| r.held_out.as_ref()).unwrap().estimators["nominal"].rmse_total
    };
    assert!(error(&large) > 100.0 * error(&plain), "the scaling did not reach the scores");
}
