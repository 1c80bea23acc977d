//! Spoiled configuration files: each message names file, line, column and key, says what to do, and is short.
//!
//! The cases are those of `cargo run -p acm-train --example bad_toml`.

#[path = "../examples/bad_toml/judge.rs"]
mod judge;
#[path = "../../datasets/examples/fuzz_files/mutate.rs"]
mod mutate;
#[path = "../examples/bad_toml/spoil.rs"]
mod spoil;
#[path = "../examples/fuzz_toml/target.rs"]
mod target;
#[path = "../examples/bad_toml/whole.rs"]
mod whole;

use std::fs;

use acm_train::explain;
use assert_cmd::Command;
use judge::LONGEST;
use whole::Reader;

#[test]
fn files_in_order_are_read() {
    let folder = tempfile::tempdir().unwrap();
    judge::prepare(folder.path()).unwrap();
    for whole in whole::ALL {
        fs::write(folder.path().join(whole.file), whole.text).unwrap();
        judge::read(whole.reader, folder.path(), whole.file).unwrap_or_else(|error| panic!("{}", explain(error)));
        // line ends of Windows, and the mark that its editors put first
        let other = format!("\u{feff}{}", whole.text.replace('\n', "\r\n"));
        fs::write(folder.path().join(whole.file), other).unwrap();
        judge::read(whole.reader, folder.path(), whole.file).unwrap_or_else(|error| panic!("{}", explain(error)));
    }
}

/// Every key that the program knows is in the files that are spoiled: serde lists them where one is unknown.
#[test]
fn every_key_is_spoiled() {
    let folder = tempfile::tempdir().unwrap();
    judge::prepare(folder.path()).unwrap();
    for whole in whole::ALL {
        let tables = whole.text.lines().filter(|line| line.starts_with('['));
        for header in std::iter::once("").chain(tables) {
            let (before, after) = whole.text.split_once(header).unwrap();
            fs::write(folder.path().join(whole.file), format!("{before}{header}\nnobody = 1\n{after}")).unwrap();
            let Err(error) = judge::read(whole.reader, folder.path(), whole.file) else { continue };
            let message = error.to_string();
            let Some((_, known)) = message.split_once("expected one of ") else { continue };
            for name in known.split('`').skip(1).step_by(2) {
                let written = whole::ALL.iter().any(|other| {
                    let starts =
                        |line: &str| line.starts_with(&format!("{name} =")) || line.contains(&format!("{name} ="));
                    let heads = |line: &str| {
                        line.starts_with('[') && line.trim_matches(['[', ']']).split('.').any(|part| part == name)
                    };
                    other.text.lines().any(|line| starts(line) || heads(line))
                });
                assert!(written, "{header} knows `{name}`, which no file has:\n{message}");
            }
        }
    }
}

#[test]
fn every_spoiled_file_is_refused_in_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let mut wrong = vec![];
    let cases = spoil::all();
    assert!(cases.len() > 200, "{}", cases.len());
    for case in &cases {
        judge::prepare(folder.path()).unwrap();
        fs::write(folder.path().join(case.file), &case.text).unwrap();
        match judge::read(case.reader, folder.path(), case.file) {
            Ok(()) => wrong.push(format!("{}: it was read", case.name)),
            Err(error) => wrong.extend(judge::complaint(case, error.exit_code(), &explain(error))),
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n\n"));
}

/// Of the real program, a sample.
#[test]
fn the_program_says_what_the_library_says() {
    let folder = tempfile::tempdir().unwrap();
    judge::prepare(folder.path()).unwrap();
    let cases = spoil::all();
    let sample = cases.len() / 40;
    for case in cases.iter().step_by(sample).filter(|case| case.reader != Reader::Manifest) {
        fs::write(folder.path().join(case.file), &case.text).unwrap();
        let mut program = Command::new(assert_cmd::cargo::cargo_bin!("acm-train"));
        let output = program.current_dir(folder.path()).args(["--config", case.file]).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        let code = output.status.code().unwrap_or(255) as u8;
        if let Some(wrong) = judge::complaint(case, code, &message) {
            panic!("{wrong}");
        }
        judge::prepare(folder.path()).unwrap();
    }
}

/// A line that nobody can read is not printed, and deep tables end in a message.
#[test]
fn long_lines_and_deep_tables() {
    let folder = tempfile::tempdir().unwrap();
    let long = "x".repeat(60_000);
    let deep = vec!["a"; 20_000].join(".");
    let texts = [
        format!("question = \"{long}\"\ndata = 5\n"),
        format!("data = 5 # {long}\n"),
        format!("{long} = 5\n"),
        format!("device = \"{long}\"\n"),
        format!("[inputs]\nchannels = [\"{long}\", \"{long}\"]\n").replacen(&long, &long[..30_000], 2),
        format!("[windows]\ntarget = \"{long}\"\n"),
        format!("{deep} = 5\n"),
        format!("[{deep}]\n"),
        format!("a = {}", "{ a = ".repeat(10_000)),
        format!("[[base]]\n{}", "[[base.set.a]]\n".repeat(4000)),
        "\u{202e}atad = \"\u{0}\"\n".to_string(),
        "data = \"\u{200b}\"\nwindows.length = 0\n".to_string(),
    ];
    for text in texts {
        let path = folder.path().join("long.toml");
        fs::write(&path, &text).unwrap();
        let mut program = Command::new(assert_cmd::cargo::cargo_bin!("acm-train"));
        let output = program.current_dir(folder.path()).args(["--config", "long.toml"]).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        let start: String = text.chars().take(40).collect();
        assert_eq!(output.status.code(), Some(2), "{start}: {message}");
        assert!(message.len() <= LONGEST && message.contains("long.toml:"), "{start}: {} bytes", message.len());
        assert!(!message.contains("panicked"), "{start}: {message}");
    }
}

/// An experiment without a key is not one with all defaults, and a pipe is not waited for.
#[test]
fn what_is_no_experiment_is_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |file: &str, parts: &[&str]| {
        let mut program = Command::new(assert_cmd::cargo::cargo_bin!("acm-train"));
        let output = program.current_dir(folder.path()).args(["--config", file]).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(parts.iter().all(|part| message.contains(part)), "{parts:?} in {message}");
    };
    for (text, what) in [("", "is empty"), ("# data = \"my-robot\"\n", "nothing but comments")] {
        fs::write(folder.path().join("empty.toml"), text).unwrap();
        refused("empty.toml", &["empty.toml:1:1", what, "experiments/cfc.toml"]);
    }
    refused(".", &["this is a folder, not a file"]);
    #[cfg(unix)]
    {
        let pipe = folder.path().join("pipe.toml");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        refused("pipe.toml", &["pipe.toml: this is a named pipe, not a file"]);
    }
}

/// A short run of `cargo run -p acm-train --example fuzz_toml -- --count N`.
#[test]
fn damaged_files_are_read_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    for whole in whole::ALL {
        for number in 0..100 {
            let bytes = mutate::damaged(&[whole.text.as_bytes().to_vec()], 1, number);
            assert_eq!(target::wrong(whole, folder.path(), &bytes).unwrap(), None, "{} {number}", whole.file);
        }
    }
}
