//! `acm-data import asl-trunk`: from files as the authors published them to a set.

use std::path::Path;

use assert_cmd::Command;

use super::trunk::shared;

fn import(from: &Path, to: &Path) -> (i32, String) {
    let mut command = Command::cargo_bin("acm-data").expect("acm-data");
    let output = command.args(["import", "asl-trunk"]).arg(from).arg("--out").arg(to).output().expect("runs");
    (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned())
}

/// Oracle: the shared record, which others made from the same files.
#[test]
fn imported_rows_equal_the_shared_record() {
    let Some(shared) = shared() else { return eprintln!("skipped: no shared measurements") };
    let out = tempfile::tempdir().expect("folder");
    let (code, message) = import(&shared.join("data/asl-trunk/original-sample"), out.path());
    assert_eq!(code, 0, "{message}");
    let imported = std::fs::read_to_string(out.path().join("trunk_run1_0g_100hz.csv")).expect("imported");
    let record = std::fs::read_to_string(shared.join("data/asl-trunk/trunk_run1_0g_100hz.csv")).expect("record");
    assert!(imported.lines().count() >= 200);
    assert_eq!(imported.lines().next(), record.lines().next());
    for (mine, theirs) in imported.lines().zip(record.lines()).skip(1) {
        let numbers = |line: &str| line.split(',').map(|c| c.parse().expect("number")).collect::<Vec<f64>>();
        assert_eq!(numbers(mine), numbers(theirs));
    }
    let thinned = std::fs::read_to_string(out.path().join("trunk_run1_0g_20hz.csv")).expect("20 Hz");
    assert_eq!(thinned.lines().nth(2), imported.lines().nth(6));
}

fn fake_clone(measured: &str, commanded: &str) -> tempfile::TempDir {
    let clone = tempfile::tempdir().expect("folder");
    let archive = clone.path().join("stack/main/data/trajectories/dynamic/servo_motor_archive");
    std::fs::create_dir_all(&archive).expect("archive");
    for (name, text) in [("observations_controlled_1", measured), ("control_inputs_controlled_1", commanded)] {
        std::fs::write(archive.join(format!("{name}.csv")), text).expect("write");
    }
    clone
}

const MEASURED: &str = "ID,x1,y1,z1,x2,y2,z2,x3,y3,z3,phi1,phi2,phi3,phi4,phi5,phi6\n\
    0,0.1234567,2,3,4,5,6,7,8,9,1.00049,2,3,4,5,6\n1,1,2,3,4,5,6,7,8,9,1,2,3,4,5,6\n";

/// Rows are found below the clone's folder, joined and rounded; oracle: by hand.
#[test]
fn a_clone_is_joined_and_rounded() {
    let clone = fake_clone(MEASURED, "ID,u1,u2,u3,u4,u5,u6\n0,-0.0004,1.2345678,3,4,5,6\n1,1,2,3,4,5,6\n");
    let out = tempfile::tempdir().expect("folder");
    let (code, message) = import(clone.path(), out.path());
    assert_eq!(code, 0, "{message}");
    let text = std::fs::read_to_string(out.path().join("trunk_run1_0g_100hz.csv")).expect("imported");
    assert_eq!(text.lines().nth(1), Some("0,0,1.235,3,4,5,6,1,2,3,4,5,6,0.123457,2,3,4,5,6,7,8,9"));
    assert!(out.path().join("manifest.toml").is_file());
}

/// What somebody has written into the manifest is worth more than what it was.
#[test]
fn a_manifest_that_was_edited_is_kept() {
    let clone = fake_clone(MEASURED, "ID,u1,u2,u3,u4,u5,u6\n0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n");
    let out = tempfile::tempdir().expect("folder");
    assert_eq!(import(clone.path(), out.path()).0, 0);
    assert_eq!(import(clone.path(), out.path()).0, 0, "the same once more");
    let manifest = out.path().join("manifest.toml");
    let edited = std::fs::read_to_string(&manifest).expect("manifest") + "# mine\n";
    std::fs::write(&manifest, &edited).expect("write");
    let (code, message) = import(clone.path(), out.path());
    assert!(code == 2 && message.contains("name another folder with --out"), "{message}");
    assert_eq!(std::fs::read_to_string(&manifest).expect("manifest"), edited);
}

#[test]
fn rows_that_do_not_belong_together_are_refused() {
    let clone = fake_clone(MEASURED, "ID,u1,u2,u3,u4,u5,u6\n0,1,2,3,4,5,6\n2,1,2,3,4,5,6\n");
    let out = tempfile::tempdir().expect("folder");
    let (code, message) = import(clone.path(), out.path());
    assert_eq!(code, 3, "{message}");
    assert!(message.contains("control_inputs_controlled_1.csv, row 3: ID 2 here and ID 1 in"), "{message}");
    let (code, message) = import(&clone.path().join("nowhere"), out.path());
    assert_eq!(code, 3);
    assert!(message.contains("no such folder") && message.contains("git clone"), "{message}");
}
