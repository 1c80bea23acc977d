//! Disks that are full, limits of file size, and pipes that nobody reads, on the real program.
#![cfg(unix)]

use std::{
    fs::{self, File},
    path::Path,
    process::{Command, Output, Stdio},
};

fn program() -> Command {
    Command::new(assert_cmd::cargo::cargo_bin!("acm-data"))
}

#[track_caller]
fn refused(output: &Output, named: &str, reason: &str) {
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{told}");
    assert!(told.contains(named) && told.contains(reason) && !told.contains("panicked"), "{told}");
}

/// Names of files that are not whole.
fn drafts(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).map(|entries| entries.filter_map(Result::ok).collect::<Vec<_>>());
    let entries = entries.unwrap_or_default();
    entries.iter().filter(|entry| entry.file_name().to_string_lossy().starts_with(".writing-")).count()
}

#[test]
fn a_limit_of_file_size_is_named_and_leaves_no_half_file() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("campaign");
    let mut shell = Command::new("sh");
    shell.args(["-c", "ulimit -f 8; exec \"$0\" generate --undeclared 1 --out \"$1\""]);
    let output = shell.arg(program().get_program()).arg(&out).output().unwrap();
    refused(&output, "campaign", "File too large");
    assert_eq!(drafts(&out), 0);
}

#[test]
fn a_text_that_cannot_be_printed_is_an_error_and_a_closed_pipe_is_none() {
    let set = std::path::absolute("acm-twin").unwrap();
    let mut child = program().arg("check").arg(&set).stdout(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let Ok(full) = File::options().write(true).open("/dev/full") else { return eprintln!("skipped: no /dev/full") };
    let output = program().arg("check").arg(&set).stdout(full).output().unwrap();
    refused(&output, "standard output", "No space left on device");
}
