//! Which network to use for sequences, on tables with planted truth: the mean of two networks of which each sees half, the last value
//! where nothing can be learned. The test part chooses nothing.

use std::{fmt::Write, fs, path::Path};

use acm_datasets::files::table::read_parquet;
use acm_train::run::sequences::record::read as read_record;
use acm_train::schedule::study::best::candidate::chosen;
use acm_train::schedule::study::of_sequences::best::record::{BestOfSequences, read};
use acm_train::schedule::study::of_sequences::best::text::why;
use assert_cmd::Command;
use tempfile::TempDir;

const QUESTION: &str = r#"
study  = "sequences"
target = "every"
seeds  = [1, 2]
[data]
kind     = "table"
folder   = "tables"
sequence = "run"
part     = "part"
elapsed  = "dt"
inputs   = ["a", "b"]
targets  = ["y"]
[network]
kind   = "mlp"
hidden = [8]
[training]
epochs        = 40
batch         = 4
learning_rate = 1e-2
schedule      = { kind = "cosine" }
patience      = 0
"#;

const STUDY: &str = r#"
study    = "best"
question = "Which network?"
[[base]]
name       = "sees a"
experiment = "asked.toml"
set.data.inputs = ["a"]
[[base]]
name       = "sees b"
experiment = "asked.toml"
set.data.inputs = ["b"]
"#;

/// Uniform draws in (−1, 1) by index and stream. SplitMix64: Steele, Lea and Flood (2014), OOPSLA.
fn noise(i: usize, stream: u64) -> f64 {
    let mut z = (i as u64).wrapping_add(stream << 32).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    2.0 * ((z ^ (z >> 31)) as f64 / u64::MAX as f64) - 1.0
}

/// 24 runs of 12 rows: 12 of training, 6 of validation, 6 of test, whose targets are multiplied by `test`.
fn folder(target: fn(f64, f64, usize) -> f64, test: f64) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut table = "run,part,dt,a,b,y\n".to_string();
    for run in 0..24 {
        let part = ["training", "training", "validation", "test"][run % 4];
        for row in 0..12 {
            let i = 12 * run + row + 1;
            let (a, b) = (noise(i, 1), noise(i, 2));
            let y = target(a, b, i) * if part == "test" { test } else { 1.0 };
            writeln!(table, "r{run},{part},0.1,{a},{b},{y}").unwrap();
        }
    }
    fs::create_dir(folder.path().join("tables")).unwrap();
    fs::write(folder.path().join("tables/all.csv"), table).unwrap();
    fs::write(folder.path().join("asked.toml"), QUESTION).unwrap();
    fs::write(folder.path().join("best.toml"), STUDY).unwrap();
    folder
}

fn program(folder: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("acm-train"));
    command.current_dir(folder).args(["--config", "best.toml"]).args(more);
    if !more.contains(&"--out") {
        command.args(["--out", "out"]);
    }
    command
}

fn choose(folder: &TempDir) -> BestOfSequences {
    program(folder.path(), &[]).assert().success();
    read(&folder.path().join("out")).unwrap()
}

/// Oracle: y = 0.5 a + 0.5 b; who sees a alone answers a/2 at best, and the mean of both is a quarter of each, off by (a + b)/4.
/// Alone an error of 0.25 var is left, of the mean 0.125 var, and var = 1/3.
#[test]
fn what_makes_up_for_each_other_is_averaged_and_scored_once() {
    let folder = folder(|a, b, _| 0.5 * a + 0.5 * b, 1.0);
    let record = choose(&folder);
    let best = chosen(&record.candidates);
    assert_eq!(best.members.len(), 2, "{:?}", record.candidates);
    assert!((best.mean - 0.125 / 3.0).abs() < 0.01, "{}", best.mean);
    assert_eq!((record.units, record.candidates[0].name()), (6, "the mean".into()));
    // Nothing but the winner has seen the test part.
    for base in ["sees-a", "sees-b"] {
        for seed in [1, 2] {
            let file = format!("out/runs/{base}/records/measured-seed{seed}.json");
            assert!(read_record(&folder.path().join(file)).unwrap().test.is_none());
        }
    }
    let tested = record.test.unwrap();
    let table = read_parquet(&folder.path().join("out").join(&tested.predictions)).unwrap();
    let numbers = |name: &str| {
        let (_, column) = table.iter().find(|(known, _)| known == name).unwrap();
        column.numbers().unwrap().to_vec()
    };
    let (targets, predicted) = (numbers("target"), numbers("predicted"));
    let squares: f64 = targets.iter().zip(&predicted).map(|(t, p)| (t - p) * (t - p)).sum();
    assert_eq!(targets.len(), 6 * 12);
    assert!((squares / 72.0 - tested.winner.loss).abs() < 1e-12 && tested.winner.loss < 0.7 * tested.constant.loss);
    // A second call computes nothing, and answers the same.
    let again = program(folder.path(), &["--resume"]).output().unwrap();
    assert!(String::from_utf8_lossy(&again.stdout).contains("mean of sees"), "{again:?}");
}

/// Oracle: nothing can be learned of noise; so the mean is to be used, and the networks' hundred numbers are not.
#[test]
fn where_nothing_can_be_learned_no_network_is_chosen() {
    let record = choose(&folder(|_, _, i| noise(i, 3), 1.0));
    assert_eq!(chosen(&record.candidates).name(), "the mean");
    assert!(why(&record).contains("better by more than chance"), "{}", why(&record));
}

/// Oracle: the truth is linear in the inputs of the first base, so the regression leaves nothing, with fewer numbers than a network.
#[test]
fn a_regression_is_chosen_where_the_truth_is_linear() {
    let folder = folder(|a, b, _| 0.5 * a - 0.25 * b, 1.0);
    fs::write(folder.path().join("best.toml"), STUDY.replace("set.data.inputs = [\"a\"]", "")).unwrap();
    let record = choose(&folder);
    assert_eq!(chosen(&record.candidates).name(), "ridge regression", "{:?}", record.candidates);
    assert!(record.test.unwrap().winner.loss < 1e-6);
}

/// Oracle: the truth is a step of the first base's input, which few leaves say and neither a line nor eight hidden units in forty epochs.
#[test]
fn trees_are_chosen_where_the_truth_is_a_step() {
    let record = choose(&folder(|a, _, _| if a > 0.25 { 1.0 } else { 0.0 }, 1.0));
    assert_eq!(chosen(&record.candidates).name(), "boosted trees", "{:?}", record.candidates);
    assert!(record.test.unwrap().winner.loss < 0.02);
}

/// The test part multiplied by a thousand changes no number of the choice.
#[test]
fn the_test_part_chooses_nothing() {
    let of = |test: f64| choose(&folder(|a, b, _| 0.5 * a + 0.5 * b, test));
    let (one, other) = (of(1.0), of(1000.0));
    assert_eq!((&one.candidates, &one.steps), (&other.candidates, &other.steps));
    assert_ne!(one.test.unwrap().winner, other.test.unwrap().winner);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let folder = folder(|a, b, _| a + b, 1.0);
    for (study, told) in [
        (STUDY.replace("set.data.inputs = [\"b\"]", "set.data.targets = [\"b\"]"), "has other targets"),
        (
            STUDY.replace("[[base]]\nname       = \"sees a\"", "[best]\nrobot = true\n[[base]]\nname = \"sees a\""),
            "robot",
        ),
    ] {
        fs::write(folder.path().join("best.toml"), study).unwrap();
        let output = program(folder.path(), &["--out", "refused"]).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(told), "{message}");
    }
}
