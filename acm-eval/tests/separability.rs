//! The command `acm-eval separability`: from a folder of recordings to a page, numbers and a summary, or a message that
//! helps.

mod browser;

use std::{fs, path::Path};

use acm_trace::finding::Separability;
use assert_cmd::{Command, cargo::cargo_bin_cmd};

fn command() -> Command {
    cargo_bin_cmd!("acm-eval")
}

const MANIFEST: &str = r#"
name      = "slide"
title     = "A slide that goes back and forth at one speed"
synthetic = true
source    = "this test"
licence   = "CC0-1.0"

[table]
files = ["*.csv"]
time  = { column = "t", unit = "s" }

[[actuator]]
column = "q"
unit   = "m"

[[measured]]
column = "y"
unit   = "m"

[roles]
development = ["t1", "t2", "t3", "t4", "t5", "t6"]
held_out    = ["t7"]
"#;

/// Up and down between −0.4 m and 0.4 m at 0.2 m/s, and an output that follows with 0.5 mm of scatter.
fn slide(folder: &Path) {
    fs::write(folder.join("manifest.toml"), MANIFEST).unwrap();
    for k in 1..=7 {
        let row = |t: usize| {
            let time = 0.1 * t as f64;
            let phase = ((time + 0.9 * f64::from(k)) * 0.2 / 1.6).fract();
            let q = 0.4 - 1.6 * (phase - 0.5).abs();
            let scatter = 5e-4 * (137.0 * (t as f64 + 61.0 * f64::from(k)).sin()).sin();
            format!("{time:.3},{q:.6},{:.6}\n", 0.9 * q + scatter)
        };
        let rows: String = (0..240).map(row).collect();
        fs::write(folder.join(format!("t{k}.csv")), format!("t,q,y\n{rows}")).unwrap();
    }
}

fn said(output: &[u8]) -> String {
    String::from_utf8(output.to_vec()).unwrap()
}

#[test]
fn one_speed_does_not_tell_play_from_lag() {
    let folder = tempfile::tempdir().unwrap();
    slide(folder.path());
    let out = folder.path().join("result");
    let ran = command().arg("separability").arg(folder.path()).arg("--out").arg(&out).assert().success();
    let printed = said(&ran.get_output().stdout);
    let found: Separability =
        serde_json::from_slice(&fs::read(out.join("separability.json")).unwrap()).expect("numbers for programs");
    let group = |name: &str| found.groups.iter().find(|group| group.effects.iter().any(|effect| effect == name));
    let late = group("actuator_lag").expect("a lag and a play look alike at one speed");
    assert!(late.effects.iter().any(|effect| effect == "backlash"), "{:?}", late.effects);
    assert!(late.experiment.contains("three speeds"), "{}", late.experiment);
    assert_eq!((found.unit.as_str(), found.size), ("m", 0.01));
    assert_eq!(found.data.development, ["t1", "t2", "t3", "t4", "t5", "t6"]);
    assert_eq!(found.data.hash.len(), 64);

    let groups = printed.find("next experiment").expect("groups with their experiments");
    let matrix = printed.find("How many percent").expect("a matrix");
    assert!(groups < matrix && printed.contains("actuator_lag") && printed.contains("separability.html"));
    let line = printed.lines().map(|line| line.chars().count()).max().unwrap();
    assert!(line <= 100 || printed.lines().last().unwrap().chars().count() == line, "{printed}");
    let page = fs::read_to_string(out.join("separability.html")).unwrap();
    assert!(page.contains("What these trials can tell apart") && page.contains("actuator_lag"));
    browser::links_resolve(&out.join("separability.html"));

    // Foreign files in a folder are kept.
    let mine = folder.path().join("mine");
    fs::create_dir(&mine).unwrap();
    fs::write(mine.join("separability.html"), "notes").unwrap();
    let refused = command().arg("separability").arg(folder.path()).arg("--out").arg(&mine).assert().code(2);
    assert!(said(&refused.get_output().stderr).contains("it holds separability.html"));
    assert_eq!(
        (fs::read_dir(&mine).unwrap().count(), fs::read(mine.join("separability.html")).unwrap()),
        (1, b"notes".to_vec())
    );

    // The same question has the same answer, to the last bit.
    let before = fs::read(out.join("separability.json")).unwrap();
    command().arg("separability").arg(folder.path()).arg("--out").arg(&out).assert().success();
    assert_eq!(before, fs::read(out.join("separability.json")).unwrap());
}

#[test]
fn a_configuration_chooses_model_and_effects() {
    let folder = tempfile::tempdir().unwrap();
    slide(folder.path());
    let text = format!(
        "data = {:?}\n[nominal]\nmodel = \"polynomial\"\ndegree = 1\n[effects]\nonly = [\"backlash\", \"creep\"]\n",
        folder.path()
    );
    let file = folder.path().join("slide.toml");
    fs::write(&file, text).unwrap();
    let out = folder.path().join("result");
    command().arg("separability").arg("--config").arg(&file).arg("--out").arg(&out).assert().success();
    let found: Separability = serde_json::from_slice(&fs::read(out.join("separability.json")).unwrap()).unwrap();
    assert_eq!(found.effects, ["backlash", "creep"]);
}

#[test]
fn what_is_wrong_is_said_with_a_code() {
    let folder = tempfile::tempdir().unwrap();
    slide(folder.path());
    let run = |arguments: &[&str]| {
        let mut command = command();
        command.arg("separability").args(arguments).current_dir(folder.path());
        let ran = command.assert().failure();
        (ran.get_output().status.code().unwrap(), said(&ran.get_output().stderr))
    };
    assert_eq!(run(&[]).0, 2);
    let (code, words) = run(&[".", "--set", "effects.only=[\"backlush\"]"]);
    assert!(code == 2 && words.contains("backlush") && words.contains("known effects"), "{code} {words}");
    let (code, words) = run(&["nowhere"]);
    assert!(code == 4 && words.contains("nowhere"), "{code} {words}");
    fs::write(folder.path().join("file"), "").unwrap();
    let (code, words) = run(&[".", "--out", "file/below"]);
    assert!(code == 4 && words.contains("below"), "{code} {words}");
    fs::write(folder.path().join("t3.csv"), "t,q,y\n0,0,0\n0.1,oops,0\n").unwrap();
    let (code, words) = run(&["."]);
    assert!(code == 3 && words.contains("t3.csv") && words.contains("oops"), "{code} {words}");
}

#[test]
fn help_shows_how_to_ask_and_how_to_read() {
    let ran = command().args(["separability", "--help"]).assert().success();
    let help = said(&ran.get_output().stdout);
    for words in ["acm-eval separability my-robot", "--config", "How to read it", "Exit codes: 0 done; 2 usage"] {
        assert!(help.contains(words), "{words}: {help}");
    }
}
