//! Outputs in small units, and many of them, from the recordings to console, page, LaTeX and CSV.
//!
//! | set     | outputs                                            | unit | size      |
//! | ------- | -------------------------------------------------- | ---- | --------- |
//! | angles  | `a = q1(t − 0.2)`, `b = q1(t − 0.2) q2`            | mrad | some mrad |
//! | torques | `m_k = q1(t − 0.2) + k q2 / 17`, k = 1 to 17       | N*m  | some mN·m |
//!
//! 10 Hz. The nominal model is a polynomial, which a dead time of two samples makes wrong; what learns is ridge regression on
//! lagged inputs, which has a single run, and a small GRU with two seeds.

use std::{fs, path::Path};

use acm_eval::report::Report;
use acm_train::config::read;
use acm_train::run::evaluation::summary;
use acm_train::run::progress::Progress;
use acm_train::run::record::RunRecord;
use acm_train::run::stop::Stop;
use acm_train::schedule::job;
use acm_train::schedule::request::Request;
use assert_cmd::cargo::cargo_bin_cmd;

const TRIALS: [&str; 5] = ["c1", "d1", "d2", "d3", "h1"];
const SAMPLES: usize = 150;

/// A data set, and its outputs at actuators `[q1, q2]` two samples ago and now.
struct Set {
    unit: &'static str,
    outputs: usize,
    output: fn(usize, [f64; 2], [f64; 2]) -> f64,
}

const ANGLES: Set =
    Set { unit: "mrad", outputs: 2, output: |k, late, now| 3.0 * late[0] * if k == 0 { 1.0 } else { now[1] } };
const TORQUES: Set =
    Set { unit: "N*m", outputs: 17, output: |k, late, now| 0.004 * (late[0] + k as f64 / 17.0 * now[1]) };

impl Set {
    fn write(&self, root: &Path) {
        let folder = &root.join("data");
        fs::create_dir(folder).unwrap();
        let names: Vec<String> = (0..self.outputs).map(|k| format!("m{k}")).collect();
        let measured: String =
            names.iter().map(|name| format!("[[measured]]\ncolumn = \"{name}\"\nunit = \"{}\"\n", self.unit)).collect();
        fs::write(folder.join("manifest.toml"), format!("{MANIFEST}{measured}")).unwrap();
        for (trial, name) in TRIALS.iter().enumerate() {
            let at = |k: usize| {
                let t = 0.1 * k as f64;
                [(0.9 * t + trial as f64).sin(), (0.37 * t + 2.0 * trial as f64).cos()]
            };
            let mut text = format!("t,q1,q2,{}\n", names.join(","));
            for k in 0..SAMPLES {
                let (now, late) = (at(k), at(k.saturating_sub(2)));
                let outputs = (0..self.outputs).map(|o| (self.output)(o, late, now).to_string());
                let row: Vec<String> =
                    [0.1 * k as f64, now[0], now[1]].map(|x| x.to_string()).into_iter().chain(outputs).collect();
                text += &(row.join(",") + "\n");
            }
            fs::write(folder.join(format!("{name}.csv")), text).unwrap();
        }
    }
}

const MANIFEST: &str = r#"name = "small"
title = "Small units"
licence = "CC0-1.0"
source = "made by this test"
synthetic = true
[table]
files = ["*.csv"]
trial = { file = "(.*)" }
time = { column = "t", unit = "s" }
[roles]
calibration = ["c1"]
development = ["d1", "d2", "d3"]
held_out = ["h1"]
[[actuator]]
column = "q1"
unit = "rad"
[[actuator]]
column = "q2"
unit = "rad"
"#;

const EXPERIMENT: &str = r#"question = "How large?"
data = "data"
[nominal]
model = "polynomial"
degree = 1
[windows]
length = 10
reach = 10
[inputs]
domain_filter = "none"
channels = ["q1", "q2"]
[protocol]
cross_validation = false
seeds = [1, 2]
validation_fold = 0
folds = [["d1"], ["d2"], ["d3"]]
held_out = ["h1"]
"#;
const RIDGE: &str = "[baseline]\nkind = \"ridge\"\n";
const GRU: &str = "[network]\nkind = \"gru\"\nunits = 4\n[training]\nepochs = 2\n";

fn learn(folder: &Path, name: &str, what: &str) -> Vec<RunRecord> {
    let file = folder.join(format!("{name}.toml"));
    fs::write(&file, format!("{EXPERIMENT}{what}")).unwrap();
    let (experiment, source) = read(&file, &[]).unwrap();
    let (out, progress, stop) = (folder.join(name), Progress::Quiet, Stop::default());
    job::run(experiment, &source, &Request::new(&out, &progress, &stop)).unwrap()
}

/// Numbers in a line of a table that stand for errors.
fn numbers(line: &str) -> Vec<f64> {
    line.split(|c: char| !(c.is_ascii_digit() || c == '.')).filter_map(|word| word.parse().ok()).collect()
}

/// Oracle: the RMSE in the record, in SI units, and the number that is printed times what its unit means.
#[test]
fn errors_of_milliradians_keep_three_digits_everywhere() {
    let folder = tempfile::tempdir().unwrap();
    ANGLES.write(folder.path());
    let ridge = learn(folder.path(), "ridge", RIDGE);
    let gru = learn(folder.path(), "gru", GRU);
    let error = gru[0].held_out.as_ref().unwrap().estimators["nominal"].rmse_total;
    assert!((1e-4..1e-2).contains(&error), "some milliradians: {error}");

    let console = summary::text(&gru.iter().collect::<Vec<_>>());
    assert!(console.contains("RMSE in mrad") && !console.contains("3-D"), "{console}");
    let nominal = console.lines().rev().find(|line| line.contains("nominal ")).unwrap();
    assert!((numbers(nominal)[2] / (1e3 * error) - 1.0).abs() < 5e-3, "{error} rad in {nominal}");
    assert!(summary::text(&ridge.iter().collect::<Vec<_>>()).contains("ridge"));

    let report = Report::of(&["ridge", "gru"].map(|name| folder.path().join(name)), "test".into()).unwrap();
    let table = report.chapters[0].tables.iter().find(|table| table.name == "errors").unwrap();
    let latex = table.latex(&report.chapters[0].data);
    let row = latex.lines().find(|line| line.starts_with("Nominal")).unwrap();
    assert!((numbers(row)[2] / (1e3 * error) - 1.0).abs() < 5e-3, "{error} rad in {row}");
    assert!(latex.contains("[mrad]") && !latex.contains("0.00 "), "{latex}");
    let csv = table.csv();
    assert!(csv.starts_with("Model,m0 [rad],"), "files keep one unit: {csv}");
    let html = acm_eval::page::html(&report);
    assert!(html.contains("[mrad]") && !html.contains("0.00</td>"), "a page in mrad");
    let after_script = |part: &str| part.split_once("</script>").map_or(part, |(_, rest)| rest).to_owned();
    let shown: String = html.split("<script").map(after_script).collect();
    assert!(shown.len() > 10_000 && !shown.contains(" tip"), "an angle is no tip");
}

/// Ridge regression has no seeds, so there is nothing to tell models apart by.
#[test]
fn without_seeds_nothing_is_bold() {
    let folder = tempfile::tempdir().unwrap();
    ANGLES.write(folder.path());
    learn(folder.path(), "ridge", RIDGE);
    let report = Report::of(&[folder.path().join("ridge")], "test".into()).unwrap();
    let table = report.chapters[0].tables.iter().find(|table| table.name == "errors").unwrap();
    assert!(!table.latex(&report.chapters[0].data).contains("textbf"), "{}", table.csv());
}

#[test]
fn seventeen_outputs_have_a_row_each() {
    let folder = tempfile::tempdir().unwrap();
    TORQUES.write(folder.path());
    let records = learn(folder.path(), "ridge", RIDGE);
    let console = summary::text(&records.iter().collect::<Vec<_>>());
    let widest = console.lines().map(|line| line.chars().count()).max().unwrap();
    assert!(widest <= 100, "{widest} columns\n{console}");
    assert!(console.contains("RMSE in mN·m") && !console.contains("3-D"), "{console}");
    assert!((0..17).all(|k| console.lines().any(|line| line.contains(&format!("m{k} ")))), "{console}");
    let output = cargo_bin_cmd!("acm-eval").arg("report").arg(folder.path().join("ridge")).output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("[mN·m]") && said.lines().all(|line| line.chars().count() <= 110), "{said}");
}
