//! Lists of experiments: their members are ordinary runs, the same bits on any number of jobs and after a stop, and their
//! tables say what the records say.

mod campaign;

use std::path::Path;

use acm_train::{
    run::record::{RunRecord, read_records},
    schedule::study::{
        paired::Difference,
        record::{StudyRecord, read},
        table::pairs,
    },
};
use assert_cmd::Command;
use campaign::{Campaign, bytes_below, timeless};

const ABLATION: &str = r#"
study    = "ablation"
question = "What does the wind tell?"
[[base]]
name       = "small"
experiment = "tiny.toml"
[[base]]
name       = "large"
experiment = "tiny.toml"
set.network.units = 6
[set]
protocol.cross_validation = true
protocol.final = false
[[variant]]
name = "all"
[[variant]]
name = "no wind"
set.inputs.channels = ["q1", "q2"]
[[variant]]
name = "wind shuffled"
only = ["small"]
set.inputs.shuffled = ["wind"]
[[variant]]
name = "no clock"
only = ["small"]
set.windows.elapsed = "one"
"#;

const SWEEP: &str = r#"
study    = "sweep"
question = "Which size?"
[[base]]
name       = "gru"
experiment = "tiny.toml"
[set.protocol]
cross_validation = true
final            = false
seeds            = [3]
[sweep]
sampler = "bayes"
count   = 6
batch   = 2
[sweep.space]
"network.units"          = [2, 3, 5]
"training.learning_rate" = { low = 1e-4, high = 1e-1, log = true }
"#;

fn conduct(campaign: &Campaign, file: &str, out: &str, more: &[&str]) -> Command {
    let mut command = campaign.program();
    command.args(["--config", file, "--out", out]).args(more);
    command
}

fn done(campaign: &Campaign, file: &str, out: &str, more: &[&str]) -> (String, StudyRecord, Vec<Vec<RunRecord>>) {
    let output = conduct(campaign, file, out, more).assert().success().get_output().stdout.clone();
    let (study, records) = read(&campaign.path(out)).unwrap();
    let text = String::from_utf8(output).unwrap().split("\n\nrecords and").next().unwrap().to_string();
    (text, study, records.into_iter().map(timeless).collect())
}

/// Oracle: the same edits given to the experiment file by hand.
#[test]
fn a_member_is_the_run_that_its_edits_ask_for() {
    let campaign = Campaign::new();
    campaign.write("study.toml", ABLATION);
    let (_, study, records) = done(&campaign, "study.toml", "study", &[]);
    let ids: Vec<&str> = study.members.iter().map(|member| member.id.as_str()).collect();
    assert_eq!(
        ids,
        ["small-all", "small-no-wind", "small-wind-shuffled", "small-no-clock", "large-all", "large-no-wind"]
    );
    assert!(records.iter().all(|of| of.len() == 6), "three folds with two seeds each");
    let folds = ["--set", "protocol.cross_validation=true", "--set", "protocol.final=false"];
    for (member, edits) in [
        (0, vec![]),
        (2, vec!["--set", "inputs.shuffled=[\"wind\"]"]),
        (3, vec!["--set", "windows.elapsed=one"]),
        (5, vec!["--set", "network.units=6", "--set", "inputs.channels=[\"q1\", \"q2\"]"]),
    ] {
        let alone = format!("alone{member}");
        let same = timeless(campaign.learn(&alone, &[&folds[..], &edits[..]].concat()));
        assert!(records[member] == same, "{} differs", ids[member]);
        let inside = campaign.path(&format!("study/runs/{}", ids[member]));
        assert!(bytes_below(&inside) == bytes_below(&campaign.path(&alone)), "files of {} differ", ids[member]);
    }
    let error = |member: usize| records[member].iter().map(|r| r.validation.estimators["gru"].rmse_total).sum::<f64>();
    assert!(error(2) > error(0), "a wind that was dealt out anew tells as much as before");
    let losses = |member: usize| records[member].iter().map(|r| r.epochs.clone()).collect::<Vec<_>>();
    assert_eq!(losses(3), losses(0), "a GRU is not told the time");
}

/// Oracle: mean and paired difference by hand arithmetic from the records' JSON.
#[test]
fn the_table_says_what_the_records_say() {
    let campaign = Campaign::new();
    // Networks that start from the nominal model hardly differ after three epochs: by less than what is printed.
    let apart = ABLATION.replace("[set]\n", "[set]\ntraining.output_layer = \"random\"\n");
    campaign.write("study.toml", &apart);
    let (text, _, records) = done(&campaign, "study.toml", "study", &[]);
    assert!(text.contains("What does the wind tell?") && text.contains("synthetic data"), "{text}");
    let errors = |id: &str| -> Vec<f64> {
        ["fold0", "fold1", "fold2"]
            .iter()
            .flat_map(|fold| [1, 2].map(|seed| format!("study/runs/{id}/records/{fold}-seed{seed}.json")))
            .map(|file| serde_json::from_slice::<serde_json::Value>(&campaign.read(&file)).unwrap())
            .map(|record| record["validation"]["estimators"]["gru"]["rmse_total"].as_f64().unwrap())
            .collect()
    };
    let (all, without) = (errors("small-all"), errors("small-no-wind"));
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let differences: Vec<f64> = all.iter().zip(&without).map(|(a, b)| b - a).collect();
    let squares: f64 = differences.iter().map(|d| (d - mean(&differences)).powi(2)).sum();
    let reach = 2.570_582 * (squares / 5.0 / 6.0).sqrt();
    let row = text.lines().find(|line| line.contains("no wind")).unwrap();
    let percent = format!("{:+.2} %", 100.0 * mean(&differences) / mean(&all));
    assert!(row.replace('−', "-").contains(&percent), "{percent} is not in {row}");
    let printed: Vec<f64> = row
        .replace('−', "-")
        .split(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '-' | '+')))
        .filter_map(|word| word.parse().ok())
        .collect();
    for expected in [1e3 * mean(&without), 1e3 * mean(&differences), 1e3 * reach] {
        let near = |value: &f64| (value - expected).abs() < 0.05 * reach * 1e3;
        assert!(printed.iter().any(near), "{expected} is not in {row}");
    }
    assert_eq!(Difference::of(&pairs(&records[0], &records[1])).unwrap().pairs, 6);
}

#[test]
fn a_sweep_is_the_same_on_any_number_of_jobs() {
    let campaign = Campaign::new();
    campaign.write("sweep.toml", SWEEP);
    let one = done(&campaign, "sweep.toml", "one", &["--jobs", "1"]);
    assert_eq!(one.2.len(), 6);
    assert!(one == done(&campaign, "sweep.toml", "two", &["--jobs", "2"]));
    let best = campaign.read("two/best-gru.toml");
    assert_eq!(best, campaign.read("one/best-gru.toml"));
}

#[cfg(unix)]
#[test]
fn a_killed_sweep_goes_on_where_it_was() {
    let campaign = Campaign::new();
    campaign.write("sweep.toml", SWEEP);
    let long = ["--set", "set.training.epochs=60", "--set", "set.training.patience=60"];
    let whole = done(&campaign, "sweep.toml", "whole", &long);
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin!("acm-train"))
        .args(["--config", "sweep.toml", "--out", "killed", "--jobs", "1", "--quiet"])
        .args(long)
        .current_dir(campaign.folder.path())
        .spawn()
        .unwrap();
    // In the second batch: the run folder of its first setting is the third.
    let third = campaign.path(&format!("killed/runs/{}/checkpoints/fold1-seed3.safetensors", whole.1.members[2].id));
    while !third.exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before {}", third.display());
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(!campaign.path("killed/best-gru.toml").exists());
    let resumed = done(&campaign, "sweep.toml", "killed", &[&long[..], &["--resume", "--jobs", "2"]].concat());
    assert!(whole == resumed, "the resumed sweep differs");
    for member in &whole.1.members {
        let of = |study: &str| bytes_below(&campaign.path(&format!("{study}/runs/{}", member.id)));
        assert!(of("whole") == of("killed"), "files of {} differ", member.id);
    }
    assert_eq!(campaign.read("whole/best-gru.toml"), campaign.read("killed/best-gru.toml"));
}

/// Oracle: rounds and their best by hand, from the records' mean errors.
#[test]
fn a_halving_trains_the_best_of_each_round_for_longer() {
    let campaign = Campaign::new();
    campaign.write("sweep.toml", &SWEEP.replace("\"bayes\"", "\"halving\"\neta = 2"));
    let four = ["--set", "set.training.epochs=4"];
    let (text, study, records) = done(&campaign, "sweep.toml", "sweep", &four);
    let epochs: Vec<usize> = records.iter().map(|of| of[0].experiment.training.epochs).collect();
    assert_eq!(epochs, [1, 1, 1, 1, 1, 1, 2, 2, 2, 4], "{text}");
    let mean = |of: &Vec<RunRecord>| of.iter().map(|r| r.validation.estimators["gru"].rmse_total).sum::<f64>();
    let setting = |member: usize| {
        let values = study.members[member].values.clone();
        values.into_iter().filter(|(key, _)| key != "training.epochs").collect::<Vec<_>>()
    };
    for (round, next) in [(0..6, 6..9), (6..9, 9..10)] {
        let mut best: Vec<usize> = round.collect();
        best.sort_by(|&a, &b| mean(&records[a]).total_cmp(&mean(&records[b])));
        for (from, to) in best.into_iter().zip(next) {
            assert_eq!(setting(from), setting(to));
        }
    }
    let again = done(&campaign, "sweep.toml", "sweep", &[&four[..], &["--resume"]].concat());
    assert!(again == (text, study, records), "a finished halving went on");
}

/// Oracle: the smallest mean error, looked for by hand; and the file runs as it is.
#[test]
fn the_best_setting_is_an_experiment_with_the_protocol_of_its_base() {
    let campaign = Campaign::new();
    campaign.write("sweep.toml", &SWEEP.replace("\"bayes\"", "\"sobol\""));
    let (text, study, records) = done(&campaign, "sweep.toml", "sweep", &[]);
    let mean = |of: &Vec<RunRecord>| {
        of.iter().map(|r| r.validation.estimators["gru"].rmse_total).sum::<f64>() / of.len() as f64
    };
    let best = (0..6).min_by(|&a, &b| mean(&records[a]).total_cmp(&mean(&records[b]))).unwrap();
    let rows: Vec<&str> = text.lines().filter(|line| line.contains("units=")).collect();
    assert_eq!(rows.len(), 6);
    assert!(rows[0].contains(&study.members[best].variant), "{text}");
    campaign.program().args(["--config", "sweep/best-gru.toml", "--out", "final"]).assert().success();
    let finals = read_records(&campaign.path("final")).unwrap();
    assert_eq!(finals.iter().map(|r| r.id.as_str()).collect::<Vec<_>>(), ["final-seed1", "final-seed2"]);
    assert_eq!(finals[0].experiment.network, records[best][0].experiment.network);
}

#[test]
fn other_trials_are_held_out_where_a_study_says_so() {
    let campaign = Campaign::new();
    let text = "study = \"comparison\"\nquestion = \"Which trial is hard?\"\n\
        [[base]]\nname = \"gru\"\nexperiment = \"tiny.toml\"\n\
        [[variant]]\nname = \"the manifest's\"\n\
        [[variant]]\nname = \"d1\"\nset.protocol = { held_out = [\"d1\"], folds = [[\"d2\"], [\"h1\"]] }\n";
    campaign.write("study.toml", text);
    let (_, _, records) = done(&campaign, "study.toml", "study", &[]);
    assert_eq!(records[0][0].split.held_out, ["h1", "h2"]);
    assert_eq!(records[1][0].split.held_out, ["d1"]);
    assert_eq!(records[1][0].split.training, ["d3", "h1", "h2"]);
    assert_eq!(records[1][0].split.validation, ["d2"]);
    assert_eq!(records[1][0].held_out.as_ref().unwrap().trials.keys().collect::<Vec<_>>(), ["d1"]);
}

#[test]
fn what_cannot_be_asked_is_refused_with_its_place() {
    let campaign = Campaign::new();
    for (was, is, words) in [
        ("\"ablation\"", "\"abaltion\"", &["study.toml:2:1", "abaltion", "sweep, ablation, comparison"][..]),
        ("question", "qestion", &["study.toml:3:1", "qestion"]),
        ("tiny.toml", "none.toml", &["none.toml"]),
        ("name = \"no wind\"", "name = \"ALL\"", &["study.toml:17:1", "alike"]),
        ("only = [\"small\"]", "only = [\"tall\"]", &["study.toml:", "tall", "small, large"]),
        ("inputs.shuffled = [\"wind\"]", "inputs.shuffled = [\"rain\"]", &["inputs.shuffled", "rain", "q1, q2, wind"]),
        ("units = 6", "units = 0", &["study.toml:10:13", "network.units", "0"]),
        ("units = 6", "unit = 6", &["study.toml:10:13", "unit", "did you mean `units`"]),
        ("cross_validation = true", "cross_validation = 7", &["study.toml:12:10", "cross_validation", "7"]),
        ("experiment = \"tiny.toml\"", "experiment = \"data\"", &["study.toml:6:1", "no file"]),
        (
            "elapsed = \"one\"",
            "length = 6",
            &["tiny.toml:10:1", "windows.reach", "in variant \"no clock\"", "study.toml"],
        ),
    ] {
        campaign.write("study.toml", &ABLATION.replacen(was, is, 1));
        let output = conduct(&campaign, "study.toml", "bad", &[]).assert().code(2).get_output().stderr.clone();
        let message = String::from_utf8(output).unwrap();
        for word in words {
            assert!(message.contains(word), "{word:?} is not in\n{message}");
        }
    }
    for (was, is, words) in [
        ("\"bayes\"", "\"halving\"\neta = 1", &["sweep.toml:13:1", "eta", "is 1"][..]),
        ("\"bayes\"", "\"havling\"", &["sweep.toml:12:1", "did you mean `halving`"]),
        ("\"training.learning_rate\"", "\"training.epochs\"", &["sweep.toml:17:1", "training.epochs", "rounds"]),
        (
            "[set.protocol]",
            "[set.baseline]\nkind = \"ridge\"\n[set.protocol]",
            &["sweep.toml:14:1", "halving", "ridge"],
        ),
    ] {
        let halving = SWEEP.replacen(was, is, 1).replace("\"bayes\"", "\"halving\"");
        campaign.write("sweep.toml", &halving);
        let output = conduct(&campaign, "sweep.toml", "bad", &[]).assert().code(2).get_output().stderr.clone();
        let message = String::from_utf8(output).unwrap();
        words.iter().for_each(|word| assert!(message.contains(word), "{word:?} is not in\n{message}"));
    }
    campaign.write("study.toml", ABLATION);
    done(&campaign, "study.toml", "study", &["--set", "set.training.epochs=1"]);
    let again = conduct(&campaign, "study.toml", "study", &[]).assert().code(2).get_output().stderr.clone();
    assert!(String::from_utf8(again).unwrap().contains("--resume"));
    let other = conduct(&campaign, "study.toml", "study", &["--resume"]).assert().code(2).get_output().stderr.clone();
    assert!(String::from_utf8(other).unwrap().contains("training.epochs is 1 there and 3 here"));
    assert!(Path::new(&campaign.path("study/runs/small-all/records")).exists());
}

/// Oracle: the same recordings with a second between any two samples, told as measured.
#[test]
fn time_that_is_untold_is_a_second_between_samples() {
    let (campaign, slow) = (Campaign::new(), Campaign::new());
    for trial in campaign::TRIALS {
        let file = format!("data/{trial}.csv");
        let text = String::from_utf8(slow.read(&file)).unwrap();
        let (heading, rows) = text.split_once('\n').unwrap();
        let seconds = rows.lines().enumerate().map(|(k, row)| format!("{k},{}\n", row.split_once(',').unwrap().1));
        slow.write(&file, &format!("{heading}\n{}", seconds.collect::<String>()));
    }
    let cfc = ["--set", "network={ kind = \"cfc\", units = 4 }", "--set", "windows.max_gap=1.5"];
    let losses = |records: Vec<RunRecord>| records.into_iter().map(|record| record.epochs).collect::<Vec<_>>();
    let untold = losses(campaign.learn("one", &[&cfc[..], &["--set", "windows.elapsed=one"]].concat()));
    assert_eq!(untold, losses(slow.learn("slow", &cfc)));
    assert_ne!(untold, losses(campaign.learn("told", &cfc)), "a CfC is told the time, and learns the same");
}
