//! Spoiled data sets: each message names file, row and column as exactly as it can, and what to do; a unit that is off is a
//! warning, and sets in order have none.
//!
//! The cases are those of `cargo run -p acm-datasets --example bad_files`.

#![allow(missing_docs)]

#[path = "../examples/bad_files/case.rs"]
mod case;
#[path = "../examples/bad_files/cells.rs"]
mod cells;
#[path = "../examples/bad_files/corpus.rs"]
mod corpus;
#[path = "../examples/bad_files/good.rs"]
mod good;
#[path = "../examples/bad_files/manifests.rs"]
mod manifests;
#[path = "../examples/bad_files/parquet_bytes.rs"]
mod parquet_bytes;
#[path = "../examples/bad_files/parquets.rs"]
mod parquets;
#[path = "../examples/bad_files/tables.rs"]
mod tables;
#[path = "../examples/bad_files/units.rs"]
mod units;

use assert_cmd::Command;
use case::Place;
use good::Set;

fn check(set: &Set) -> (i32, String) {
    let mut command = Command::cargo_bin("acm-data").expect("acm-data");
    let output = command.arg("check").arg(set.path()).output().expect("acm-data runs");
    (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn every_spoiled_set_is_named_in_its_place() {
    let cases = corpus::all();
    let lacks = |case| corpus::judge(case).expect("a temporary folder");
    let wrong = cases.iter().map(|case| (&case.name, lacks(case))).filter(|(_, lacks)| !lacks.is_empty());
    let wrong: Vec<String> = wrong.map(|(name, lacks)| format!("{name}: without {}", lacks.join("\n  "))).collect();
    assert!(cases.len() >= 300, "{}", cases.len());
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n\n"));
}

/// Of the real program, a sample.
#[test]
fn the_program_says_what_the_library_says() {
    let cases = corpus::all();
    for case in cases.iter().step_by(cases.len() / 30).filter(|case| case.said.place() != Place::Warning) {
        let set = Set::new().expect("a temporary folder");
        (case.spoil)(&set).expect("spoiled");
        let (code, message) = check(&set);
        let lacks = case.said.lacks(code, &message);
        assert!(lacks.is_empty(), "{}: without {}\n{message}", case.name, lacks.join("\n  "));
    }
}

#[test]
fn a_set_in_order_has_no_warning() {
    let set = Set::new().expect("a temporary folder");
    assert_eq!(check(&set), (0, String::new()));
}

/// A link within the data folder is as good as the file, and so is a data folder that is a link.
#[cfg(unix)]
#[test]
fn links_within_the_data_folder_are_followed() {
    use std::os::unix::fs::symlink;
    let set = Set::new().expect("a temporary folder");
    std::fs::rename(set.file("data/run_b.csv"), set.file("data/record.csv.1")).expect("moved");
    symlink("record.csv.1", set.file("data/run_b.csv")).expect("linked");
    assert_eq!(check(&set).0, 0, "{}", check(&set).1);
    symlink(set.path(), set.file("other")).expect("linked");
    Command::cargo_bin("acm-data").expect("acm-data").arg("check").arg(set.file("other")).assert().success();
}

/// A pipe in the place of the manifest or of a table is not waited for.
#[cfg(unix)]
#[test]
fn a_pipe_is_no_file() {
    for (file, expected) in [("manifest.toml", 2), ("run_b.csv", 4)] {
        let set = Set::new().expect("a temporary folder");
        let path = set.file(&format!("data/{file}"));
        std::fs::remove_file(&path).expect("removed");
        assert!(std::process::Command::new("mkfifo").arg(&path).status().expect("mkfifo").success());
        let (code, message) = check(&set);
        assert_eq!(code, expected, "{message}");
        assert!(message.contains(file) && message.contains("this is a named pipe, not a file"), "{message}");
    }
}
