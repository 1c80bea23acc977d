//! The tutorial of several clocks, word by word: every command of `book/src/recordings.md`, and the manifest that it shows.
//! Oracle: the clocks and the play that `three_clocks` planted.

#![allow(missing_docs)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use acm_datasets::Campaign;
use serde_json::Value;

fn root() -> PathBuf {
    std::path::absolute("..").unwrap()
}

/// A block of the chapter: its language, and its lines.
struct Block {
    language: String,
    text: String,
}

fn blocks(chapter: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut rest = chapter;
    while let Some((_, fenced)) = rest.split_once("\n```") {
        let (language, body) = fenced.split_once('\n').expect("a language");
        let (text, behind) = body.split_once("\n```").expect("an end");
        blocks.push(Block { language: language.to_string(), text: text.to_string() + "\n" });
        rest = behind;
    }
    blocks
}

/// The programs of other crates lie beside this one's; they are built here, so that they are not older than it.
fn built() -> PathBuf {
    let cargo = Command::new(env!("CARGO"))
        .args(["build", "--quiet", "-p", "acm-datasets", "-p", "acm-train", "--bins"])
        .current_dir(root())
        .status();
    assert!(cargo.expect("cargo").success());
    assert_cmd::cargo::cargo_bin!("acm-eval").parent().expect("a folder").to_path_buf()
}

/// Runs `cargo run -p CRATE -- …`, and `cp -r`, as the chapter has them.
fn run(line: &str, folder: &Path, programs: &Path) -> Output {
    let mut words = line.split_whitespace();
    let mut command = match (words.next(), words.next()) {
        (Some("cargo"), Some("run")) => {
            assert_eq!(words.next(), Some("-p"), "{line}");
            let program = words.next().map(|name| name.replace("acm-datasets", "acm-data")).expect("a crate");
            assert_eq!(words.next(), Some("--"), "{line}");
            Command::new(programs.join(program))
        }
        (Some(program), Some(first)) => {
            let mut command = Command::new(program);
            command.arg(first);
            command
        }
        _ => panic!("{line}"),
    };
    let arguments = words.map(|word| word.trim_matches('\'')).take_while(|word| *word != "#");
    let output = command.args(arguments).current_dir(folder).output().expect("runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{line}\n{}{said}", String::from_utf8_lossy(&output.stdout));
    output
}

fn copied(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder") {
        let path = entry.expect("a file").path();
        let copy = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copied(&path, &copy);
        } else {
            fs::copy(&path, copy).expect("copied");
        }
    }
}

/// Added to the clocks of the commands of `run1` to `run4` and `slow`, and the log's times at which the takes begin.
const MOTORS: [f64; 5] = [0.742, 0.208, 0.883, 0.555, 0.31];
const LOG: [f64; 5] = [39.0, 63.7, 88.4, 113.1, 14.3];

#[test]
fn the_commands_of_the_tutorial_lead_to_a_network_and_a_closed_loop() {
    let (scratch, programs) = (tempfile::tempdir().expect("a folder"), built());
    let folder = scratch.path();
    copied(&root().join("datasets/three-clocks"), &folder.join("datasets/three-clocks"));
    copied(&root().join("experiments"), &folder.join("experiments"));
    let chapter = fs::read_to_string(root().join("book/src/recordings.md")).expect("the chapter");
    let mut printed = String::new();
    let mut commands = 0;
    for block in blocks(&chapter) {
        match block.language.as_str() {
            "sh" => {
                for line in block.text.lines() {
                    printed += &String::from_utf8_lossy(&run(line, folder, &programs).stdout);
                    commands += usize::from(line.starts_with("cargo run"));
                }
            }
            "toml manifest" => fs::write(folder.join("my-robot/manifest.toml"), &block.text).expect("written"),
            _ => {}
        }
    }
    assert!(commands >= 4 && printed.contains("no problems"), "{commands} commands: {printed}");
    clocks(&folder.join("my-robot"));
    network(&folder.join("runs/my-robot"));
    streamed(folder, &programs);
    closed(&folder.join("runs/loop-my-robot/loop.json"));
}

/// The play makes the tip late by less than 0.06 rad at the motion's speed, and the estimate holds that.
fn clocks(folder: &Path) {
    let campaign = Campaign::read(folder, None).expect("read");
    for (source, planted, within) in [("motors", MOTORS, 0.12), ("ulog", LOG.map(|begins| -begins), 0.01)] {
        let found: Vec<f64> = campaign.alignments.iter().filter(|a| a.source == source).map(|a| a.offset).collect();
        assert!(
            found.len() == 5 && found.iter().zip(planted).all(|(a, b)| (a - b).abs() < within),
            "{source}: {found:?}"
        );
    }
}

fn network(folder: &Path) {
    let records = fs::read_dir(folder.join("records")).expect("records").count();
    assert!(records > 0);
}

/// The held-out trial, line by line on one clock. Oracle: what was measured, and that samples 20 ms apart have a history.
fn streamed(folder: &Path, programs: &Path) {
    let campaign = Campaign::read(&folder.join("my-robot"), None).expect("read");
    let trial = campaign.trial("run4").expect("a trial");
    let line = |k: usize| {
        let (q, battery) = (&trial.actuators, trial.context[(k, 0)]);
        format!("{},{},{},{battery}\n", trial.time[k], q[(k, 0)], q[(k, 1)])
    };
    let header = "time,motors.q1,motors.q2,ulog.battery_status.voltage_v\n".to_string();
    let lines: String = std::iter::once(header).chain((0..trial.samples()).map(line)).collect();
    let mut command = assert_cmd::Command::new(programs.join("acm-eval"));
    let done = command
        .args(["stream", "runs/my-robot", "--everywhere"])
        .current_dir(folder)
        .write_stdin(lines)
        .assert()
        .success();
    let answers = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
    let rows: Vec<Vec<&str>> = answers.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0][..5], ["time", "x", "y", "nominal_x", "nominal_y"], "{answers:.200}");
    assert_eq!(rows.len(), 1 + trial.samples());
    let history = rows[0].iter().position(|name| *name == "history").expect("a history");
    let longest = rows[1..].iter().map(|row| row[history].parse::<usize>().unwrap_or(0)).max();
    assert!(longest > Some(100), "samples belong together: {longest:?}");
    let rms = |column: usize| {
        let error = |k: usize| rows[k + 1][column].parse::<f64>().expect("a number") - 1000.0 * trial.measured[(k, 0)];
        ((0..trial.samples()).map(|k| error(k).powi(2)).sum::<f64>() / trial.samples() as f64).sqrt()
    };
    assert!(rms(1) < rms(3) && rms(3) < 20.0, "{} and {} mm", rms(1), rms(3));
}

fn closed(file: &Path) {
    let found: Value = serde_json::from_str(&fs::read_to_string(file).expect("loop.json")).expect("JSON");
    let cautions = found["cautions"].to_string();
    assert!(cautions.contains("`motors` was estimated") && cautions.contains("dead time"), "{cautions}");
    let names: Vec<&str> =
        found["effects"].as_array().expect("a list").iter().filter_map(|e| e["name"].as_str()).collect();
    assert!(!names.is_empty(), "{}", found["sentence"]);
    let value = |key: &Value| key.as_f64().expect("a number");
    let (before, after) =
        (value(&found["errors"]["baselines"]["nominal"]["value"]), value(&found["errors"]["after"]["value"]));
    assert!(after < before, "{before} {after}");
}

/// The files of the project are those that the example makes.
#[test]
fn the_recordings_of_the_tutorial_are_small() {
    let files =
        fs::read_dir(root().join("datasets/three-clocks")).expect("the folder").map(|entry| entry.expect("a file"));
    let bytes: u64 = files.map(|file| file.metadata().expect("a file").len()).sum();
    assert!((100_000..=300_000).contains(&bytes), "{bytes} bytes");
}
