//! One small run from file to table: what it writes, and that learning lowers the error.

mod campaign;

use acm_datasets::files::table::{Column, read_parquet};
use acm_train::run::record::{NominalSource, RunRecord, Stage, read_nominal};
use campaign::{Campaign, SAMPLES};

fn run(campaign: &Campaign) -> (Vec<RunRecord>, String) {
    let edits = ["training.epochs=40", "training.learning_rate=0.01", "network.units=8", "protocol.validation_fold=0"];
    let arguments: Vec<&str> = edits.iter().flat_map(|edit| ["--set", edit]).collect();
    let output = campaign.command(&arguments).assert().success().get_output().clone();
    let records = acm_train::run::record::read_records(&campaign.path("runs/tiny")).unwrap();
    (records, String::from_utf8(output.stdout).unwrap())
}

#[test]
fn a_run_leaves_what_it_promises() {
    let campaign = Campaign::new();
    let (records, table) = run(&campaign);
    assert_eq!(records.iter().map(|r| r.id.as_str()).collect::<Vec<_>>(), ["final-seed1", "final-seed2"]);
    for record in &records {
        check(&campaign, record);
    }
    for part in ["synthetic data", "nominal", "polynomial", "gru", "±", "Held-out", "runs/tiny", "acm-eval"] {
        assert!(table.contains(part), "`{part}` is not in\n{table}");
    }
    let nominal = read_nominal(&campaign.path("runs/tiny")).unwrap();
    assert_eq!(nominal.source, NominalSource::CalibrationTrials);
    assert_eq!(nominal.calibrations["calibration"].trials, ["c1"]);
    let again = campaign.program().args(["--config", "runs/tiny/experiment.toml", "--out", "again"]).output().unwrap();
    assert!(
        again.status.success(),
        "the resolved experiment is an experiment: {}",
        String::from_utf8_lossy(&again.stderr)
    );
    assert_eq!(campaign.read("runs/tiny/training.log"), campaign.read("again/training.log"));
}

fn check(campaign: &Campaign, record: &RunRecord) {
    assert_eq!((record.stage, record.channels.len()), (Stage::Final, 3));
    assert_eq!(record.outputs, ["x", "y", "z"]);
    assert_eq!(record.split.training, ["d2", "d3"]);
    assert_eq!(record.split.validation, ["d1"]);
    assert_eq!(record.split.held_out, ["h1", "h2"]);
    let windows = SAMPLES - 4;
    assert_eq!((record.windows.training, record.windows.validation), (2 * windows, windows));
    let held_out = record.held_out.as_ref().unwrap();
    assert_eq!(held_out.estimators["gru"].samples, 2 * windows);
    assert_eq!(record.data.trials["h1"].samples, SAMPLES);
    let (before, after) = (held_out.estimators["nominal"].rmse_total, held_out.estimators["gru"].rmse_total);
    assert!(after < 0.8 * before, "learning took the error from {before} m to {after} m");
    let best = record.epochs.iter().min_by(|a, b| a.validation_loss.total_cmp(&b.validation_loss)).unwrap();
    assert_eq!(record.best_epoch, best.epoch);
    let table = read_parquet(&campaign.path("runs/tiny").join(&record.predictions)).unwrap();
    let names: Vec<&str> = table.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names[..7], ["trial", "part", "time", "measured_x", "nominal_x", "polynomial_x", "predicted_x"]);
    // Oracle: the error of the table, computed here, is the error of the record.
    let squared: Vec<f64> = (0..3).flat_map(|o| held_out_errors(&table, 3 + 4 * o)).collect();
    let rmse = (squared.iter().sum::<f64>() / (2 * windows) as f64).sqrt();
    assert!((rmse - after).abs() < 1e-12, "table says {rmse}, record says {after}");
}

fn held_out_errors(table: &[(String, Column)], measured: usize) -> Vec<f64> {
    let (Column::Text(part), Column::Number(truth), Column::Number(estimate)) =
        (&table[1].1, &table[measured].1, &table[measured + 3].1)
    else {
        panic!("column types")
    };
    let error = |k: usize| (truth[k] - estimate[k]).powi(2);
    (0..part.len()).filter(|k| part[*k] == "held_out").map(error).collect()
}

/// Without calibration trials, each fold calibrates on what it learns from.
#[test]
fn without_calibration_trials() {
    let campaign = Campaign::new();
    let manifest = campaign::MANIFEST.replace("calibration = [\"c1\"]", "excluded = [\"c1\"]");
    campaign.write("data/manifest.toml", &manifest);
    let records = campaign.learn("run", &["--set", "protocol.cross_validation=true", "--set", "protocol.seeds=[7]"]);
    assert_eq!(records.len(), 4);
    let nominal = read_nominal(&campaign.path("run")).unwrap();
    assert_eq!(nominal.source, NominalSource::TrainingTrials);
    assert_eq!(nominal.calibrations["fold0"].trials, ["d2", "d3"]);
    assert_eq!(nominal.calibrations["fold2"].trials, ["d1", "d2"]);
}

/// The data's own prediction is the nominal model; here it is the truth, so nothing is left.
#[test]
fn with_the_data_s_own_prediction() {
    let campaign = Campaign::new();
    let own = ["x", "y", "z"].map(|c| format!("[[predicted]]\ncolumn = \"{c}\"\nunit = \"m\"\n")).concat();
    campaign.write("data/manifest.toml", &campaign::MANIFEST.replace("[roles]", &format!("{own}[roles]")));
    let records = campaign.learn("run", &[]);
    assert_eq!(records[0].held_out.as_ref().unwrap().estimators["nominal"].rmse_total, 0.0);
    assert_eq!(read_nominal(&campaign.path("run")).unwrap().source, NominalSource::Predicted);
}

/// The data folder is looked for above the experiment file where the current directory has none of that name.
#[test]
fn from_another_directory() {
    let campaign = Campaign::new();
    let (elsewhere, out) = (tempfile::tempdir().unwrap(), campaign.path("out"));
    let mut command = campaign.program();
    command.current_dir(elsewhere.path()).arg("--config").arg(campaign.path("tiny.toml")).arg("--out").arg(&out);
    command.args(["--set", "protocol.seeds=[3]"]).assert().success();
    assert!(out.join("records/final-seed3.json").exists());
    assert_eq!(std::fs::read_dir(elsewhere.path()).unwrap().count(), 0);
}
