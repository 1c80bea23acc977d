//! The import of walker2d, against the set that a program with numpy made, where that is at hand.

use std::fs;
use std::path::{Path, PathBuf};

use acm_datasets::sequences::table::{Rules, Tables, read};
use acm_datasets::sequences::{Asked, SequenceSet};
use assert_cmd::Command;
use nalgebra::DMatrix;

/// The folder of the set, in `$ACM_SHARED` or `../shared`.
fn made() -> Option<PathBuf> {
    let beside = std::path::absolute("../../shared").unwrap();
    let places = [std::env::var_os("ACM_SHARED").map(PathBuf::from), Some(beside)];
    let folder = |place: PathBuf| place.join("data/walker2d");
    places.into_iter().flatten().map(folder).find(|folder| folder.join("rollouts.parquet").is_file())
}

/// Every row: states, and whether it is kept.
fn rows(folder: &Path) -> SequenceSet {
    let asked = Tables {
        files: vec!["rollouts.parquet".into()],
        sequence: Some("rollout".into()),
        part: Some("part".into()),
        time: Some("k".into()),
        inputs: (0..17).map(|s| format!("s{s}")).chain(["kept".to_string()]).collect(),
        targets: vec!["kept".into()],
        ..Tables::default()
    };
    read(&asked, folder, Rules { asked: Asked::Every, labels: true }).expect("read")
}

/// An array as numpy writes it.
fn npy(rows: &DMatrix<f64>) -> Vec<u8> {
    let shape = format!("{:?}", rows.shape());
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
    let header = format!("{header:<117}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(rows.transpose().iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

fn import(clone: &Path, out: &Path) -> std::process::Output {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("acm-data"));
    command.args(["import", "walker2d"]).arg(clone).arg("--out").arg(out).output().expect("started")
}

/// A message without the line breaks that a terminal's width makes.
fn words(output: &std::process::Output) -> String {
    String::from_utf8_lossy(&output.stderr).split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Oracle: split and dropped steps as numpy drew them, row by row.
#[test]
fn split_and_dropped_steps_are_those_of_the_benchmark() {
    let Some(made) = made() else {
        eprintln!("skipped: no data/walker2d/rollouts.parquet in $ACM_SHARED or ../shared");
        return;
    };
    let table = rows(&made);
    let folder = tempfile::tempdir().expect("a folder");
    let clone = folder.path().join("clone/data/walker");
    fs::create_dir_all(&clone).expect("a folder");
    for rollout in table.parts().iter().flat_map(|(_, part)| part.iter()) {
        let states = rollout.inputs.columns(0, 17).into_owned();
        fs::write(clone.join(format!("rollout_{}.npy", rollout.name)), npy(&states)).expect("written");
    }
    let out = folder.path().join("out");
    let output = import(&folder.path().join("clone"), &out);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found = rows(&out);
    assert_eq!((found.training.len(), found.validation.len(), found.test.len()), (300, 40, 60));
    assert!(found == table, "states, parts or dropped steps differ");
    // One step fewer is another set.
    let first = clone.join("rollout_000.npy");
    fs::write(&first, npy(&DMatrix::repeat(20, 17, 0.5))).expect("written");
    let refused = import(&clone, &out);
    let message = words(&refused);
    assert!(!refused.status.success() && message.contains("as published, at commit 59f6e01f"), "{message}");
}

#[test]
fn files_that_are_none_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let message = |folder: &Path| {
        let output = import(folder, &folder.join("out"));
        assert!(!output.status.success());
        words(&output)
    };
    let nothing = message(folder.path());
    assert!(nothing.contains("no rollout_000.npy") && nothing.contains("git clone"), "{nothing}");
    for n in 0..400 {
        fs::write(folder.path().join(format!("rollout_{n:03}.npy")), npy(&DMatrix::repeat(3, 16, 1.0)))
            .expect("written");
    }
    let narrow = message(folder.path());
    assert!(narrow.contains("rollout_035.npy") && narrow.contains("(steps, 17)"), "{narrow}");
    fs::write(folder.path().join("rollout_035.npy"), b"no array").expect("written");
    let other = message(folder.path());
    assert!(other.contains("rollout_035.npy") && other.contains("no array of numpy"), "{other}");
}
