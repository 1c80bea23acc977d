//! An outside baseline in the network's place: the same plans, windows and target time stamps, and the same record.

mod campaign;

use acm_datasets::files::table::{Column, read_parquet};
use acm_train::{
    config::{Baseline, Experiment, RidgeConfig, TreesConfig},
    run::record::{RunRecord, read_records},
};
use campaign::{Campaign, EXPERIMENT, bytes_below, inputs, timeless, tip};

const RIDGE: [&str; 2] = ["--set", "baseline.kind=ridge"];
const TREES: [&str; 4] = ["--set", "baseline.kind=boosted_trees", "--set", "baseline.rounds=15"];
const BOTH: [&str; 2] = ["--set", "protocol.cross_validation=true"];

/// What the wind did two and three samples ago, beside what the actuators do: a linear filter, since there is no nominal
/// model in that test.
fn filtered(trial: usize, k: usize) -> [f64; 3] {
    let ([q1, q2, wind], before) = (inputs(trial, k), |lag| inputs(trial, k.saturating_sub(lag))[2]);
    [0.2 * q1 + 0.03 * before(2), 0.15 * q2 - 0.01 * wind + 0.02 * before(3), 0.05 * q1 - 0.1 * q2]
}

/// Oracle: a planted filter within the window, which a line can follow to the last digits.
#[test]
fn a_ridge_finds_a_planted_filter_in_trials_that_it_has_not_seen() {
    let campaign = Campaign::with(filtered);
    let sizes = ["--set", "baseline.penalties=[1e-11, 1.0]", "--set", "nominal.model=none"];
    let records = campaign.learn("run", &[&RIDGE[..], &BOTH, &sizes].concat());
    let ids: Vec<&str> = records.iter().map(|record| record.id.as_str()).collect();
    assert_eq!((ids.len(), &ids[..3]), (8, &["final-seed1", "final-seed2", "fold0-seed1"][..]), "{ids:?}");
    for record in &records {
        let scores = record.held_out.as_ref().unwrap_or(&record.validation);
        let [before, after] = ["nominal", "ridge"].map(|name| scores.estimators[name].rmse_total);
        assert!(before > 0.1 && after < 1e-6, "{}: from {before} m to {after} m", record.id);
        assert_eq!((record.best_epoch, record.epochs.len()), (2, 2));
        assert_eq!(record.epochs[1].learning_rate, 1e-11);
        // Five samples of three inputs and a constant, for three outputs.
        assert_eq!(record.parameters, 3 * (5 * 3 + 1));
    }
    assert_eq!(std::fs::read_dir(campaign.path("run/checkpoints")).unwrap().count(), 0);
}

fn column<'t>(table: &'t [(String, Column)], name: &str) -> &'t Column {
    &table.iter().find(|(found, _)| found == name).unwrap().1
}

/// Everything of a table of predictions but what learns.
fn common(campaign: &Campaign, run: &str, record: &RunRecord) -> String {
    let table = read_parquet(&campaign.path(run).join(&record.predictions)).unwrap();
    let names = ["trial", "part", "time", "measured_x", "nominal_x", "polynomial_z"];
    names.map(|name| format!("{:?}", column(&table, name))).concat()
}

#[test]
fn targets_and_record_are_those_of_a_network() {
    let campaign = Campaign::new();
    let both = [&BOTH[..], &["--set", "protocol.validation_fold=0"]].concat();
    let network = campaign.learn("gru", &both);
    for (kind, arguments) in [("ridge", &RIDGE[..]), ("boosted_trees", &TREES)] {
        let records = campaign.learn(kind, &[arguments, &both].concat());
        assert_eq!(records.len(), network.len());
        for (own, other) in records.iter().zip(&network) {
            assert_eq!((&own.id, &own.split, own.windows), (&other.id, &other.split, other.windows));
            assert_eq!((&own.channels, &own.data), (&other.channels, &other.data));
            assert_eq!(own.validation.estimators["nominal"], other.validation.estimators["nominal"]);
            assert!(common(&campaign, kind, own) == common(&campaign, "gru", other), "{kind} {}", own.id);
            let names: Vec<&String> = own.validation.estimators.keys().collect();
            assert!(names.contains(&&kind.to_string()) && names.len() == 3, "{names:?}");
            assert!(own.epochs.iter().all(|e| e.validation_loss >= own.epochs[own.best_epoch - 1].validation_loss));
        }
        assert_eq!(records[0].held_out, records[1].held_out, "a seed changes nothing");
    }
}

#[test]
fn threads_and_jobs_change_no_bit_and_a_finished_run_is_taken_over() {
    let campaign = Campaign::new();
    for arguments in [&RIDGE[..], &TREES] {
        let with = |out: &str, more: &[&str]| {
            let records = campaign.learn(out, &[arguments, &BOTH, more].concat());
            (timeless(records), bytes_below(&campaign.path(out)))
        };
        let out = |name: &str| format!("{}-{name}", arguments.len());
        let once = with(&out("a"), &["--jobs", "1", "--threads", "1"]);
        for (name, more) in [("b", ["--jobs", "2", "--threads", "1"]), ("c", ["--jobs", "1", "--threads", "3"])] {
            assert!(once == with(&out(name), &more), "{more:?} gave other bits");
        }
        std::fs::remove_file(campaign.path(&out("b")).join("records/final-seed2.json")).unwrap();
        assert!(once == with(&out("b"), &["--resume"]), "resumed, the records differ");
    }
}

/// As for networks: held-out measurements a thousand times as large change no number of the fit.
#[test]
fn held_out_measurements_leave_no_trace() {
    let plain = Campaign::new();
    let scaled = Campaign::with(|trial, k| tip(trial, k).map(|value| if trial >= 4 { 1000.0 * value } else { value }));
    for (out, arguments) in [("ridge", &RIDGE[..]), ("trees", &TREES)] {
        let (a, b) = (plain.learn(out, arguments), scaled.learn(out, arguments));
        assert_eq!((&a[0].epochs, &a[0].validation), (&b[0].epochs, &b[0].validation));
        assert!(a[0].held_out != b[0].held_out, "the scaling did not reach the scores");
        assert_eq!(plain.read(&format!("{out}/training.log")), scaled.read(&format!("{out}/training.log")));
        let predicted = |campaign: &Campaign| {
            let table = read_parquet(&campaign.path(out).join(&a[0].predictions)).unwrap();
            format!("{:?}", column(&table, "predicted_y"))
        };
        assert!(predicted(&plain) == predicted(&scaled), "{out} predicts something else");
    }
}

#[test]
fn the_resolved_experiment_is_an_experiment() {
    let campaign = Campaign::new();
    let table = campaign.command(&RIDGE).assert().success().get_output().stdout.clone();
    assert!(String::from_utf8(table).unwrap().contains("ridge"));
    let again = ["--config", "runs/tiny/experiment.toml", "--out", "again"];
    campaign.program().args(again).assert().success();
    let [first, second] = ["runs/tiny", "again"].map(|run| timeless(read_records(&campaign.path(run)).unwrap()));
    assert!(first == second);
    for baseline in [Baseline::Ridge(RidgeConfig::default()), Baseline::BoostedTrees(TreesConfig::default())] {
        let asked = Experiment { baseline: Some(baseline), ..Experiment::default() };
        assert_eq!(toml::from_str::<Experiment>(&toml::to_string(&asked).unwrap()).unwrap(), asked);
    }
    assert!(!toml::to_string(&Experiment::default()).unwrap().contains("baseline"));
}

#[test]
fn what_cannot_be_is_refused_at_its_line() {
    let campaign = Campaign::new();
    let cases: &[(&str, &[&str])] = &[
        ("kind = \"forest\"", &["tiny.toml:17:1", "baseline.kind", "forest", "boosted_trees"]),
        ("kind = \"ridge\"\nlag = 3", &["tiny.toml:18:1", "lag", "unknown field", "penalties"]),
        ("kind = \"ridge\"\nlags = 6", &["tiny.toml:18:1", "baseline.lags", "is 6", "windows.length = 5"]),
        ("kind = \"ridge\"\nlags = 0", &["tiny.toml:18:1", "baseline.lags", "is 0"]),
        ("kind = \"ridge\"\npenalties = []", &["tiny.toml:18:1", "baseline.penalties", "empty"]),
        ("kind = \"ridge\"\npenalties = [1.0, -2.0]", &["baseline.penalties", "-2", "0 or more"]),
        ("kind = \"ridge\"\npenalties = [nan]", &["baseline.penalties", "finite"]),
        ("kind = \"boosted_trees\"\nlags = [5]", &["tiny.toml:18:1", "baseline.lags", "names 5", "4 back"]),
        ("kind = \"boosted_trees\"\nlags = []", &["baseline.lags", "empty"]),
        ("kind = \"boosted_trees\"\nrounds = 0", &["tiny.toml:18:1", "baseline.rounds", "is 0"]),
        ("kind = \"boosted_trees\"\ndepth = 0", &["baseline.depth", "is 0"]),
        ("kind = \"boosted_trees\"\nlearning_rate = 1.5", &["baseline.learning_rate", "1.5", "up to 1"]),
        ("kind = \"boosted_trees\"\npenalty = -1.0", &["baseline.penalty", "-1"]),
        ("lags = 3", &["tiny.toml:16", "baseline", "kind"]),
    ];
    for (text, parts) in cases {
        campaign.write("tiny.toml", &EXPERIMENT.replace("[training]", &format!("[baseline]\n{text}\n\n[training]")));
        let output = campaign.command(&[]).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        let missing: Vec<_> = parts.iter().filter(|part| !message.contains(**part)).collect();
        assert!(output.status.code() == Some(2) && missing.is_empty(), "{text}: without {missing:?}\n{message}");
    }
}
