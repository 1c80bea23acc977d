//! Disks that are full, limits of file size, and pipes that nobody reads: what was there stays, and nothing is half done.
#![cfg(unix)]

mod delayed;
mod fixture;

use std::{
    fs::{self, File},
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

use delayed::Rig;
use fixture::{Fixture, write};

fn program() -> Command {
    Command::new(assert_cmd::cargo::cargo_bin!("acm-eval"))
}

#[track_caller]
fn refused(output: &Output, named: &str, reason: &str) {
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{told}");
    assert!(told.contains(named) && told.contains(reason) && !told.contains("panicked"), "{told}");
}

/// A run and a report of it.
fn reported(root: &Path) -> (PathBuf, PathBuf) {
    let (run, out) = (write(&Fixture::default(), root, "cfc"), root.join("report"));
    assert!(program().arg("report").arg(&run).arg("--out").arg(&out).output().unwrap().status.success());
    (run, out)
}

#[test]
fn a_limit_of_file_size_keeps_the_former_page() {
    let root = tempfile::tempdir().unwrap();
    let (run, out) = reported(root.path());
    let page = fs::read(out.join("report.html")).unwrap();
    for blocks in [0, 4, 64] {
        let mut shell = Command::new("sh");
        shell.args(["-c", &format!("ulimit -f {blocks}; exec \"$0\" report \"$1\" --out \"$2\"")]);
        let output = shell.arg(program().get_program()).arg(&run).arg(&out).output().unwrap();
        refused(&output, "report", "File too large");
    }
    assert_eq!(fs::read(out.join("report.html")).unwrap(), page);
    for folder in ["", "figures", "tables"] {
        let mut names = fs::read_dir(out.join(folder)).unwrap().map(|entry| entry.unwrap().file_name());
        assert!(names.all(|name| !name.to_string_lossy().starts_with('.')), "a draft is left in {folder}");
    }
}

#[test]
fn a_table_that_cannot_be_printed_is_an_error_and_a_closed_pipe_is_none() {
    let root = tempfile::tempdir().unwrap();
    let (run, out) = reported(root.path());
    fs::remove_file(out.join("report.html")).unwrap();
    let mut report = program();
    report.arg("report").arg(&run).arg("--out").arg(&out);
    let mut child = report.stdout(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let told = child.wait().unwrap();
    assert!(told.code().is_none_or(|code| code == 0), "{told}");
    assert!(out.join("report.html").exists(), "the page was not finished");
    let Ok(full) = File::options().write(true).open("/dev/full") else { return eprintln!("skipped: no /dev/full") };
    refused(&report.stdout(full).stderr(Stdio::piped()).output().unwrap(), "standard output", "No space left");
}

#[test]
fn a_limit_of_file_size_keeps_the_former_finding_and_the_next_loop_is_whole() {
    let rig = Rig::new();
    let quick = ["arm", "--set", "search.max_effects=1"];
    rig.close(&quick, "out");
    let former = || ["model.json", "loop.html", "loop.json"].map(|name| fs::read(rig.path("out").join(name)).unwrap());
    let before = former();
    let mut shell = Command::new("sh");
    shell.args(["-c", "ulimit -f 4; exec \"$0\" \"$@\""]).arg(program().get_program()).arg("close-loop");
    let output = shell.args(quick).args(["--out", "out"]).current_dir(rig.folder.path()).output().unwrap();
    refused(&output, "out/", "File too large");
    assert!(former() == before, "a part of the former result was replaced");
    rig.close(&quick, "out");
    assert!(former()[0] == before[0]);
}

/// Wherever a loop is killed while its result takes the place of another, what is there is of one of them.
#[test]
fn a_kill_between_two_names_does_not_mix_two_results() {
    let tracer = |arguments: &[&str]| {
        let mut tracer = Command::new("strace");
        tracer.args(["-f", "-qq", "-o", "/dev/null"]).args(arguments);
        tracer
    };
    if !tracer(&["true"]).status().is_ok_and(|status| status.success()) {
        return eprintln!("skipped: there is no strace, or it may not trace");
    }
    let (rig, punctual) = (Rig::new(), Rig::with(0.0));
    punctual.close(&["arm"], "former");
    let names =
        ["model.json", "figures/intervals-1.svg", "figures/trace-1.svg", "tables/steps.csv", "loop.html", "loop.json"];
    let mut killed = 0;
    for call in ["rename,renameat,renameat2", "unlink,unlinkat"] {
        // The first ones, then every third: a loop has some twenty names to take.
        for nth in (1..4).chain((4..).step_by(3)) {
            let out = format!("{}-{nth}", &call[..6]);
            ["figures", "tables"].iter().for_each(|inside| fs::create_dir_all(rig.path(&out).join(inside)).unwrap());
            for name in names.iter().chain(&[".lock"]) {
                fs::copy(punctual.path("former").join(name), rig.path(&out).join(name)).unwrap();
            }
            let inject = format!("inject={call}:signal=KILL:when={nth}");
            let mut traced = tracer(&["-e", &format!("trace={call}"), "-e", &inject]);
            traced.arg(program().get_program()).args([
                "close-loop",
                "arm",
                "--set",
                "search.max_effects=1",
                "--out",
                &out,
            ]);
            let ended = traced.current_dir(rig.folder.path()).stdout(Stdio::null()).stderr(Stdio::null()).status();
            let former = |name: &str| fs::read(punctual.path("former").join(name)).unwrap();
            let new = |name: &&str| fs::read(rig.path(&out).join(name)).ok().map(|found| found != former(name));
            let found: Vec<bool> = names.iter().filter_map(new).collect();
            assert!(!found.is_empty() && found.iter().all(|new| *new == found[0]), "{out}: {found:?}");
            if ended.unwrap().success() {
                assert_eq!(found, [true; 6]);
                break;
            }
            killed += 1;
        }
    }
    assert!(killed >= 5, "killed {killed} times");
}
