//! Small studies of the embedded campaign and their page, made once for all tests of this program.

use std::{
    path::{Path, PathBuf},
    sync::OnceLock,
};

use acm_train::{
    config::{Source, kind},
    run::{progress::Progress, stop::Stop},
    schedule::{request::Request, study},
};
use assert_cmd::cargo::cargo_bin_cmd;
use tempfile::TempDir;

const ABLATION: &str = r#"
study    = "ablation"
question = "What does each input tell a small network?"
[set]
protocol = { cross_validation = true, final = false, seeds = [1, 2] }
[[variant]]
name = "all inputs"
[[variant]]
name = "without throttle"
set.inputs.channels = ["q1", "q2", "rate(q1)", "altitude"]
[[variant]]
name = "q2 shuffled"
set.inputs.shuffled = ["q2"]
"#;

const SWEEP: &str = r#"
study    = "sweep"
question = "Which size and rate?"
[set.protocol]
cross_validation = true
final = false
seeds = [1]
[sweep]
sampler = "grid"
[sweep.space]
"network.hidden"         = [[8], [16]]
"training.learning_rate" = [1e-3, 3e-3]
"#;

const COMPARISON: &str = r#"
study    = "comparison"
question = "Which model errs least?"
[[base]]
name = "Ridge"
experiment = "MLP"
set.baseline.kind = "ridge"
set.protocol.seeds = [1]
[[variant]]
name = "trials 10–12"
[[variant]]
name = "trials 1–3"
set.protocol = { held_out = ["1", "2", "3"], folds = [["4", "8", "12"]] }
"#;

/// The network of all of them, small enough to be trained here.
const BASE: &str = r#"
[[base]]
name       = "MLP"
experiment = "MLP"
set        = { network.hidden = [8], windows.stride = 8, training.epochs = 2, protocol.seeds = [1, 2, 3] }
"#;

/// The folder with `ablation`, `sweep`, `comparison`, `nominal`, `residual`, and `page` made of all of them.
pub fn folder() -> &'static Path {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    FOLDER.get_or_init(conduct_all).path()
}

fn conduct_all() -> TempDir {
    let root = tempfile::tempdir().unwrap();
    let experiments = std::path::absolute("../experiments").unwrap();
    let mlp = experiments.join("paper/mlp.toml").display().to_string();
    for (name, text) in [("ablation", ABLATION), ("sweep", SWEEP), ("comparison", COMPARISON)] {
        let file = root.path().join(format!("{name}.toml"));
        std::fs::write(&file, format!("{text}{BASE}").replace("\"MLP\"\nset", &format!("{mlp:?}\nset"))).unwrap();
        conduct(&file, &root.path().join(name));
    }
    for name in ["nominal", "residual"] {
        conduct(&experiments.join(format!("{name}.toml")), &root.path().join(name));
    }
    let studies: Vec<PathBuf> =
        ["nominal", "residual", "sweep", "ablation", "comparison"].map(|name| root.path().join(name)).into();
    let mut report = cargo_bin_cmd!("acm-eval");
    report.arg("report").args(studies).arg("--out").arg(root.path().join("page")).assert().success();
    root
}

fn conduct(file: &Path, out: &Path) {
    let source = Source::read(file, &[]).unwrap();
    let kind = kind(&source).unwrap().unwrap();
    let (progress, stop) = (Progress::Quiet, Stop::default());
    let request = Request::new(out, &progress, &stop);
    study::conduct(kind, source, &request).unwrap();
}
