//! A saved model with effects as the nominal model of an experiment, from the command line and from the library.

mod campaign;

use std::path::Path;

use acm_core::{
    NominalSpec,
    augmented::AugmentedModel,
    calibrate,
    effects::{Carrier, instance::Term},
};
use acm_datasets::{DomainFilter, Role, Trial, rig::rig};
use acm_train::config::{Experiment, read};
use acm_train::run::evaluation::held_out::{errors, same_targets};
use acm_train::run::nominal::augmented::origin;
use acm_train::run::progress::Progress;
use acm_train::run::record::{NominalSource, RunRecord, read_nominal, read_records};
use acm_train::run::stop::Stop;
use acm_train::schedule::job::run;
use acm_train::schedule::request::Request;
use acm_train::store::hashed;
use campaign::{Campaign, MANIFEST, inputs};

/// Time by which the tip follows late, in samples of 0.1 s.
const LATE: usize = 3;

/// What c1 measures, without wind: a polynomial of the second degree.
fn still(trial: usize, k: usize) -> [f64; 3] {
    let [q1, q2, _] = inputs(trial, k);
    [0.2 * q1, 0.15 * q2, 0.05 * q1 * q2]
}

/// The same, late; at rest before the first sample.
fn late(trial: usize, k: usize) -> [f64; 3] {
    still(trial, k.saturating_sub(LATE))
}

/// The polynomial that fits the calibration trial, with effects; saved beside the experiment.
fn save(campaign: &Campaign, effects: Vec<Term>) {
    let data = acm_datasets::Campaign::read(&campaign.path("data"), None).unwrap();
    let calibration: Vec<&Trial> = data.trials(Role::Calibration).collect();
    let fitted = calibrate(&NominalSpec::Polynomial { degree: 3 }, &data.observations(&calibration)).unwrap();
    let all: Vec<&Trial> = data.trials.iter().collect();
    let model = AugmentedModel::new(rig(&data, &all), fitted.model, None, None, effects).unwrap();
    let model = model.clone().with_origin(origin(&model, &data));
    campaign.write("model.json", str::from_utf8(&hashed::encode(&model).unwrap()).unwrap());
}

fn dead_time() -> Term {
    let (effect, values) = ("dead_time".into(), vec![LATE as f64 * 0.1]);
    Term { effect, carrier: Carrier::Rig, context: None, values, definition: None }
}

const AUGMENTED: [&str; 2] = ["--set", "nominal.augmented=model.json"];

#[test]
fn a_model_without_effects_is_the_model_that_it_was_made_from() {
    let campaign = Campaign::new();
    save(&campaign, vec![]);
    let plain = campaign.learn("plain", &[]);
    let saved = campaign.learn("saved", &AUGMENTED);
    for (a, b) in plain.iter().zip(&saved) {
        let nominal = |record: &RunRecord| record.held_out.as_ref().unwrap().estimators["nominal"].rmse_total;
        assert!((nominal(a) - nominal(b)).abs() < 1e-12, "{} m and {} m", nominal(a), nominal(b));
    }
    assert!(same_targets(&plain, &saved));
    let (source, asked) = (read_nominal(&campaign.path("saved")).unwrap(), &saved[0].experiment.nominal);
    assert_eq!(source.source, NominalSource::Augmented);
    assert!(source.calibrations["calibration"].nominal.is_none());
    assert_eq!(asked.augmented.as_deref(), Some(Path::new("model.json")));
    assert_eq!(asked.augmented_sha256.as_ref().map(String::len), Some(64));
    assert_eq!(plain[0].experiment.nominal.augmented, None);
}

/// Oracle: the delay is planted, and is three samples long: where it is known, nothing is left.
#[test]
fn a_planted_delay_is_removed() {
    let campaign = Campaign::with(still);
    save(&campaign, vec![dead_time()]);
    for (trial, name) in campaign::TRIALS.iter().enumerate() {
        let row = |k: usize| {
            let ([q1, q2, wind], [x, y, z]) = (inputs(trial, k), late(trial, k));
            format!("{},{q1},{q2},{wind},{x},{y},{z}\n", k as f64 / 10.0)
        };
        let rows: String = (0..campaign::SAMPLES).map(row).collect();
        campaign.write(&format!("data/{name}.csv"), &format!("t,q1,q2,wind,x,y,z\n{rows}"));
    }
    let (experiment, source) = read(&campaign.path("tiny.toml"), &[]).unwrap();
    let (progress, stop) = (Progress::Quiet, Stop::default());
    let conduct = |experiment: Experiment, out: &str| {
        let out = campaign.path(out);
        let request = Request::new(&out, &progress, &stop);
        run(experiment, &source, &request).unwrap()
    };
    let mut known = experiment.clone();
    known.nominal.augmented = Some("model.json".into());
    let (before, after) = (conduct(experiment, "before"), conduct(known.clone(), "after"));
    assert!(same_targets(&before, &after));
    let (plain, found) = (errors(&before), errors(&after));
    assert_eq!(plain.iter().map(|e| e.seed).collect::<Vec<_>>(), [1, 2]);
    assert_eq!(plain[0].samples, found[0].samples);
    assert!(plain[0].nominal > 0.02, "the delay is {} m", plain[0].nominal);
    assert!(found[0].nominal < 1e-9, "{} m are left", found[0].nominal);
    known.inputs.domain_filter = DomainFilter::Hull;
    (known.windows.length, known.windows.reach) = (1, 1);
    let filtered = conduct(known, "filtered");
    assert!(filtered[0].data.trials["h1"].samples < campaign::SAMPLES, "nothing was filtered");
    let left = errors(&filtered)[0].nominal;
    assert!(left < 1e-9, "{left} m are left where samples were filtered out after the delay had acted");
    let record = read_records(&campaign.path("after")).unwrap().remove(0);
    assert_eq!(record.held_out.unwrap().estimators["gru"].rmse_total, found[0].network);
}

#[test]
fn a_finished_run_goes_on_with_its_own_model_alone() {
    let campaign = Campaign::new();
    save(&campaign, vec![]);
    campaign.learn("run", &AUGMENTED);
    campaign.learn("run", &[&AUGMENTED[..], &["--resume"]].concat());
    save(&campaign, vec![dead_time()]);
    refuses(
        &campaign,
        &[&["--out", "run", "--resume"], &AUGMENTED[..]].concat(),
        2,
        &["augmented_sha256", "--out DIR"],
    );
    let noted = campaign.program().args(["--config", "run/experiment.toml", "--out", "again"]).output().unwrap();
    let message = String::from_utf8_lossy(&noted.stderr);
    assert_eq!(noted.status.code(), Some(2), "{message}");
    assert!(message.contains("augmented_sha256") && message.contains("model.json"), "{message}");
}

const ARM: &str = r#"
[arm]
length = { value = 0.40, unit = "m" }
axis   = "-z"
strain = { basis = "legendre", order = 1 }
[roles]"#;

/// A file as earlier versions wrote it.
fn without_origin(campaign: &Campaign) {
    let text = hashed::verify(&campaign.read("model.json")).unwrap();
    let mut model: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert!(model.as_object_mut().unwrap().remove("origin").is_some());
    campaign.write("model.json", str::from_utf8(&hashed::encode(&model).unwrap()).unwrap());
}

#[test]
fn a_model_of_another_arm_is_refused() {
    let campaign = Campaign::new();
    let manifest = MANIFEST.replacen("\n[roles]", ARM, 1);
    assert_ne!(manifest, MANIFEST);
    campaign.write("data/manifest.toml", &manifest);
    save(&campaign, vec![]);
    campaign.learn("same", &AUGMENTED);
    // What an earlier version did not write is not compared.
    let cases = [
        ("value = 0.40, unit = \"m\"", "value = 530, unit = \"mm\"", "length 0.4 m, that of the data has 0.53 m", true),
        (
            "axis   = \"-z\"",
            "axis = \"-z\"\ndown = \"x\"",
            "gravity along (0, 0, -1), that of the data has along (1, 0, 0)",
            true,
        ),
        ("axis   = \"-z\"", "axis = \"x\"\ndown = \"-z\"", "axis \"-z\", that of the data has \"x\"", false),
        ("order = 1", "order = 2", "strain { basis = \"legendre\", order = 1 }, that of the data has", false),
        (ARM, "\n[roles]", "length 0.4 m, that of the data has none", true),
    ];
    for (from, to, part, _) in cases {
        campaign.write("data/manifest.toml", &manifest.replacen(from, to, 1));
        refuses(
            &campaign,
            &AUGMENTED,
            3,
            &["does not fit the data formulas: its [arm] has", part, "acm-eval close-loop"],
        );
    }
    without_origin(&campaign);
    for (k, (from, to, part, is_known)) in cases.into_iter().enumerate() {
        campaign.write("data/manifest.toml", &manifest.replacen(from, to, 1));
        match is_known {
            true => refuses(&campaign, &AUGMENTED, 3, &[part]),
            false => drop(campaign.learn(&format!("old{k}"), &AUGMENTED)),
        }
    }
}

/// What `acm-train` says while it runs with the saved model.
fn told(campaign: &Campaign, out: &str) -> String {
    let output = campaign.command(&[&["--out", out][..], &AUGMENTED].concat()).output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{told}");
    told
}

/// The tables of a robot of the same signals.
fn write_tables(campaign: &Campaign, width: f64, tip: fn([f64; 3]) -> [f64; 3]) {
    for (trial, name) in campaign::TRIALS.iter().enumerate() {
        let row = |k: usize| {
            let [q1, q2, wind] = inputs(trial, k);
            let q1 = if *name == "d2" { width * q1 } else { q1 };
            let [x, y, z] = tip([q1, q2, wind]);
            format!("{},{q1},{q2},{wind},{x},{y},{z}\n", k as f64 / 10.0)
        };
        let rows: String = (0..campaign::SAMPLES).map(row).collect();
        campaign.write(&format!("data/{name}.csv"), &format!("t,q1,q2,wind,x,y,z\n{rows}"));
    }
}

/// Oracle: the formulas. Where q1 goes as far as 1.8 rad instead of 1.2 rad, so many samples lie outside.
#[test]
fn ranges_that_are_left_are_told() {
    let campaign = Campaign::with(still);
    save(&campaign, vec![]);
    assert!(!told(&campaign, "same").contains("warning"), "the same robot in the same folder");
    let highest = (0..6).flat_map(|trial| (0..campaign::SAMPLES).map(move |k| inputs(trial, k)[0]));
    let (low, high) = highest.fold((0.0, 0.0), |(low, high): (f64, f64), q| (low.min(q), high.max(q)));
    write_tables(&campaign, 1.5, |[q1, q2, _]| [0.2 * q1, 0.15 * q2, 0.05 * q1 * q2]);
    let wide: Vec<f64> = (0..campaign::SAMPLES).map(|k| 1.5 * inputs(2, k)[0]).collect();
    let outside = wide.iter().filter(|q| **q < low || **q > high).count();
    let by = wide.iter().map(|q| (low - q).max(q - high)).fold(0.0, f64::max);
    let said = told(&campaign, "wide");
    let share = 100.0 * outside as f64 / (6 * campaign::SAMPLES) as f64;
    let part = format!("warning: model.json: q1 leaves the range that it was calibrated on, {low:.2} to {high:.2} rad");
    assert!(said.replace('−', "-").contains(&part), "no {part:?} in {said}");
    let part = format!("in {share:.2} % of the samples, by up to {by:.3} rad");
    assert!(said.contains(&part) && said.matches("warning").count() == 1, "no {part:?} in {said}");
}

/// Names, units, arm and ranges agree, and the robot is another one.
#[test]
fn a_robot_that_moves_otherwise_is_told() {
    let campaign = Campaign::with(still);
    save(&campaign, vec![]);
    write_tables(&campaign, 1.0, |[q1, q2, _]| [0.2 * q2, 0.15 * q2, 0.05 * q1 * q2]);
    let said = told(&campaign, "other");
    let squares = (0..campaign::SAMPLES).map(|k| inputs(0, k)).map(|[q1, q2, _]| (0.2 * (q1 - q2)).powi(2));
    let rms = (squares.sum::<f64>() / campaign::SAMPLES as f64).sqrt();
    for part in [
        format!("warning: model.json: on c1 it misses x by {rms:.4} m RMS, where it was made by"),
        "it may be of another robot than these data; if so, run `acm-eval close-loop`".into(),
    ] {
        assert!(said.contains(&part), "no {part:?} in {said}");
    }
    assert!(!said.contains("misses y") && !said.contains("; y by"), "{said}");
    without_origin(&campaign);
    assert!(!told(&campaign, "old").contains("warning"), "a file of before tells no error");
}

fn refuses(campaign: &Campaign, arguments: &[&str], code: i32, parts: &[&str]) {
    let output = campaign.command(arguments).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
    for part in parts {
        assert!(message.contains(part), "{arguments:?}: no {part:?} in\n{message}");
    }
}

#[test]
fn a_model_that_cannot_be_used_is_refused() {
    let campaign = Campaign::new();
    refuses(&campaign, &AUGMENTED, 2, &["nominal.augmented", "model.json", "no such file"]);
    save(&campaign, vec![]);
    let twice = [&AUGMENTED[..], &["--set", "nominal.degree=2"]].concat();
    refuses(&campaign, &twice, 2, &["nominal.degree", "is set together with nominal.augmented", "delete one"]);
    refuses(&campaign, &["--set", "nominal.augmented_sha256=\"00\""], 2, &["has no nominal.augmented"]);
    let text = String::from_utf8(campaign.read("model.json")).unwrap();
    let other = hashed::encode(&serde_json::json!({"effects": [{}]})).unwrap();
    let flipped = text.replacen("e-", "e+", 1);
    for damaged in [&text[..text.len() / 2], "{}", "[1, 2]", str::from_utf8(&other).unwrap(), &flipped] {
        campaign.write("model.json", damaged);
        refuses(&campaign, &AUGMENTED, 3, &["model.json is no model with effects", "acm-eval close-loop"]);
    }
    campaign.write("model.json", &text);
    let other = MANIFEST.replace("column = \"wind\"\nunit   = \"1\"", "column = \"wind\"\nunit   = \"m/s\"");
    campaign.write("data/manifest.toml", &other);
    refuses(&campaign, &AUGMENTED, 3, &["does not fit the data formulas", "wind [1]", "wind [m/s]", "close-loop"]);
    let fewer = MANIFEST.replace("[[actuator]]\ncolumn = \"q2\"\nunit   = \"rad\"", "");
    campaign.write("data/manifest.toml", &fewer);
    refuses(&campaign, &AUGMENTED, 3, &["actuators are q1 [rad], q2 [rad], those of the data are q1 [rad]"]);
    assert!(!campaign.path("runs/tiny/records").exists(), "something was run");
}
