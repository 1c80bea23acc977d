//! The same seed gives the same bits: run twice, on one thread or two, one run at a time or two, killed or not.

mod campaign;

use std::{
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

use campaign::{Campaign, bytes_below, timeless};

#[test]
fn on_any_number_of_threads_and_jobs() {
    let campaign = Campaign::new();
    let arguments = ["--set", "protocol.cross_validation=true"];
    let with = |out: &str, more: &[&str]| {
        let records = campaign.learn(out, &[&arguments[..], more].concat());
        (timeless(records), bytes_below(&campaign.path(out)))
    };
    let (records, files) = with("a", &["--jobs", "1", "--threads", "1"]);
    assert_eq!(records.len(), 8, "three folds and the final run, with two seeds each");
    assert_ne!(records[6].epochs, records[7].epochs, "two seeds are two networks");
    for (out, more) in [
        ("b", ["--jobs", "1", "--threads", "1"]),
        ("c", ["--jobs", "2", "--threads", "1"]),
        ("d", ["--jobs", "1", "--threads", "2"]),
    ] {
        assert!((records.clone(), files.clone()) == with(out, &more), "{more:?} gave other bits");
    }
}

#[cfg(unix)]
#[test]
fn stopped_or_killed_and_resumed() {
    let campaign = Campaign::new();
    let long = ["--set", "training.epochs=120", "--set", "training.patience=120", "--set", "training.dropout=0.2"];
    let whole = timeless(campaign.learn("whole", &long));
    for (signal, code) in [("INT", Some(130)), ("KILL", None)] {
        let (status, message) = interrupt(&campaign, signal, &[&["--out", signal], &long[..]].concat());
        assert_eq!(status, code, "{message}");
        if signal == "INT" {
            assert!(message.contains("--resume") && message.contains("INT"), "{message}");
        }
        let records = timeless(campaign.learn(signal, &[&["--resume"], &long[..]].concat()));
        assert!(records == whole, "resumed after SIG{signal}, the records differ");
        assert!(
            bytes_below(&campaign.path(signal)) == bytes_below(&campaign.path("whole")),
            "files differ after SIG{signal}"
        );
    }
}

/// Starts the program, waits for its first checkpoint, sends the signal; exit code and stderr.
#[cfg(unix)]
fn interrupt(campaign: &Campaign, signal: &str, arguments: &[&str]) -> (Option<i32>, String) {
    let child = Command::new(assert_cmd::cargo::cargo_bin!("acm-train"))
        .args(["--config", "tiny.toml", "--jobs", "1"])
        .args(arguments)
        .current_dir(campaign.folder.path())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_for(&child, &campaign.path(signal).join("checkpoints/final-seed1.safetensors"));
    let sent = Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let output = child.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

fn wait_for(child: &Child, file: &std::path::Path) {
    let start = Instant::now();
    while !file.exists() {
        assert!(start.elapsed() < Duration::from_secs(60), "process {} writes no {}", child.id(), file.display());
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn a_folder_is_resumed_by_its_own_experiment_alone() {
    let campaign = Campaign::new();
    campaign.learn("run", &[]);
    let refused = |arguments: &[&str], parts: &[&str]| {
        let output = campaign.command(&[&["--out", "run"], arguments].concat()).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        for part in parts {
            assert!(message.contains(part), "`{part}` is not in\n{message}");
        }
    };
    refused(&[], &["run already holds a run", "--resume", "--out DIR"]);
    refused(&["--resume", "--set", "network.units=5"], &["network.units is 4 there and 5 here", "--out DIR"]);
    refused(&["--resume", "--set", "network.kind=\"cfc\""], &["network.kind"]);
    refused(&["--resume", "--set", "protocol.seeds=[1]"], &["protocol.seeds is [1, 2] there and [1] here"]);
    let table = String::from_utf8(campaign.read("data/h1.csv")).unwrap();
    campaign.write("data/h1.csv", table.trim_end().rsplit_once('\n').unwrap().0);
    refused(&["--resume"], &["other data", "hash"]);
    campaign.write("data/h1.csv", &table);
    let before = bytes_below(&campaign.path("run"));
    campaign.learn("run", &["--resume"]);
    assert!(before == bytes_below(&campaign.path("run")), "a finished run was run again");
}

#[test]
fn a_damaged_record_is_named_and_can_be_made_again() {
    let campaign = Campaign::new();
    let whole = timeless(campaign.learn("run", &[]));
    let record = campaign.read("run/records/final-seed2.json");
    std::fs::write(campaign.path("run/records/final-seed2.json"), &record[..record.len() / 2]).unwrap();
    let output = campaign.command(&["--out", "run", "--resume"]).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{message}");
    assert!(message.contains("final-seed2.json") && message.contains("move it away"), "{message}");
    std::fs::remove_file(campaign.path("run/records/final-seed2.json")).unwrap();
    assert!(whole == timeless(campaign.learn("run", &["--resume"])));
}

#[test]
fn a_record_of_another_experiment_is_not_taken_for_one_of_this() {
    let campaign = Campaign::new();
    campaign.learn("run", &[]);
    campaign.learn("short", &["--set", "training.epochs=2"]);
    for file in ["records/final-seed1.json", "predictions/final-seed1.parquet"] {
        std::fs::copy(campaign.path("short").join(file), campaign.path("run").join(file)).unwrap();
    }
    let output = campaign.command(&["--out", "run", "--resume"]).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{message}");
    for part in ["final-seed1.json", "another experiment", "training.epochs is 3 there and 2 here"] {
        assert!(message.contains(part), "{part} is not in {message}");
    }
}

#[test]
fn one_process_at_a_time() {
    let campaign = Campaign::new();
    std::fs::create_dir(campaign.path("run")).unwrap();
    let lock = std::fs::File::create(campaign.path("run/.lock")).unwrap();
    lock.lock().unwrap();
    let output = campaign.command(&["--out", "run"]).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(5), "{message}");
    assert!(message.contains("run is in use by another process") && message.contains("--out DIR"), "{message}");
    drop(lock);
    campaign.learn("run", &[]);
}
