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
use good::{Set, csv, rows};

fn check(set: &Set) -> (i32, String) {
    let mut command = Command::cargo_bin("acm-data").expect("acm-data");
    let output = command.arg("check").arg(set.path()).output().expect("acm-data runs");
    let text = [output.stdout, output.stderr].concat();
    (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&text).into_owned())
}

#[test]
fn every_spoiled_set_is_told_in_its_place() {
    let cases = corpus::all();
    let mut wrong = vec![];
    for case in &cases {
        let lacks = corpus::judge(case).expect("a temporary folder");
        if !lacks.is_empty() {
            wrong.push(format!("{}: without {}", case.name, lacks.join("\n  ")));
        }
    }
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

/// What is unusual and in order: no problem, no warning.
#[test]
fn sets_in_order_are_read_without_a_warning() {
    let text = csv(&rows(1));
    let unusual: &[(&str, Vec<u8>)] = &[
        ("as it is", text.clone().into_bytes()),
        ("line ends of Windows", text.replace('\n', "\r\n").into_bytes()),
        ("line ends of old Macs", text.replace('\n', "\r").into_bytes()),
        ("a mark of order", format!("\u{feff}{text}").into_bytes()),
        ("no line end at the end", text.trim_end().as_bytes().to_vec()),
        ("blank lines at the end", format!("{text}\n\n\r\n").into_bytes()),
        ("quoted names", text.replacen("t,q,h,y", "\"t\",\"q\",\"h\",\"y\"", 1).into_bytes()),
        ("blanks around numbers", text.replace(',', " , ").into_bytes()),
        ("denormals and negative zero", text.replacen("\n100,", "\n100,-0.0,4e-320,5e-324\n150,", 1).into_bytes()),
        ("numbers of other forms", text.replacen("\n100,", "\n100,+.5,5.,1.5E-3\n150,", 1).into_bytes()),
        ("a lost marker", text.replacen("\n100,", "\n100,1,2,\n150,", 1).into_bytes()),
    ];
    for (name, bytes) in unusual {
        let set = Set::new().expect("a temporary folder");
        set.write("data/run_b.csv", bytes).expect("written");
        let (code, message) = check(&set);
        assert_eq!(code, 0, "{name}: {message}");
        assert!(!message.contains("warning"), "{name}: {message}");
    }
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
    let mut command = Command::cargo_bin("acm-data").expect("acm-data");
    command.arg("check").arg(set.file("other")).assert().success();
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
