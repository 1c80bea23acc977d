//! From parts to a program of C, and samples through it.

use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use acm_export::{File, Origin, c99, rehearsal};
use acm_stream::{AverageParts, Parts};
use rehearsal::{Answer, Sample};
use tempfile::TempDir;

/// As little as a careful project allows.
pub const WARNINGS: [&str; 5] = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"];

pub fn origin() -> Origin {
    Origin { name: "estimator".into(), source: "a test".into(), recorded: None }
}

/// Those of gcc and clang that are there; what is not there is named.
pub fn compilers() -> Vec<&'static str> {
    let there = |cc: &&str| Command::new(cc).arg("--version").output().is_ok_and(|output| output.status.success());
    let (found, missing): (Vec<_>, Vec<_>) = ["gcc", "clang"].into_iter().partition(there);
    missing.iter().for_each(|cc| eprintln!("skipped: {cc} is not installed"));
    found
}

/// The first of them.
pub fn compiler() -> Option<&'static str> {
    compilers().first().copied()
}

/// A folder with `estimator.h`, `estimator.c` and `drive.c`.
pub fn written(parts: &Parts) -> TempDir {
    beside_a_driver(c99::export(parts, &origin()).expect("it can be written"))
}

/// The same of an average.
pub fn written_average(average: &AverageParts) -> TempDir {
    beside_a_driver(c99::export_average(average, &origin()).expect("it can be written"))
}

fn beside_a_driver(files: Vec<File>) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for file in files {
        std::fs::write(folder.path().join(file.path), file.bytes).expect("a file");
    }
    std::fs::write(folder.path().join("drive.c"), include_str!("drive.c")).expect("a file");
    folder
}

/// Compiles and links files of a folder; says what the compiler said where it fails.
pub fn link(cc: &str, folder: &TempDir, files: &[&str], flags: &[&str]) -> PathBuf {
    let program = folder.path().join(format!("program-{cc}"));
    let output = Command::new(cc)
        .current_dir(folder.path())
        .args(WARNINGS)
        .args(flags)
        .args(files)
        .arg("-o")
        .arg(&program)
        .output()
        .expect("the compiler runs");
    let said = String::from_utf8_lossy(&output.stderr).chars().take(3000).collect::<String>();
    assert!(output.status.success(), "{cc} {flags:?}: {said}");
    program
}

/// What a program answers to samples: result, range, history, outputs, nominal outputs.
pub fn through(program: &PathBuf, samples: &[Sample]) -> Vec<Vec<f64>> {
    let mut child = Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it runs");
    let mut stdin = child.stdin.take().expect("a pipe");
    let bytes: Vec<u8> = samples
        .iter()
        .flat_map(|sample| [sample.elapsed, f64::from(u8::from(sample.seen))].into_iter().chain(sample.inputs.clone()))
        .flat_map(f64::to_le_bytes)
        .collect();
    let writer = std::thread::spawn(move || stdin.write_all(&bytes));
    let output = child.wait_with_output().expect("it ends");
    writer.join().expect("no panic").expect("it reads all");
    assert!(output.status.success(), "{:?}", output.status);
    let numbers: Vec<f64> = output.stdout.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
    numbers.chunks(numbers.len() / samples.len()).map(<[f64]>::to_vec).collect()
}

/// Largest deviations of C from Rust in units of the outputs' RMS: of the answers, and of the nominal model.
pub fn deviations(found: &[Vec<f64>], right: &[Answer]) -> [f64; 2] {
    let sizes = rehearsal::rms(right);
    let mut worst: [f64; 2] = [0.0; 2];
    for (k, (found, right)) in found.iter().zip(right).enumerate() {
        assert_eq!(found[0], 0.0, "sample {k} was refused");
        let range = right.in_range.map_or(-1.0, |inside| f64::from(u8::from(inside)));
        assert_eq!(found[1], range, "range of sample {k}");
        for (o, size) in sizes.iter().enumerate() {
            let off = [found[3 + o] - right.tip[o], found[3 + sizes.len() + o] - right.nominal[o]];
            for (worst, off) in worst.iter_mut().zip(off) {
                assert!(off.is_finite());
                *worst = worst.max(off.abs() / size);
            }
        }
    }
    worst
}

/// The whole way, for `count` samples with gaps; nothing where no compiler is there.
pub fn compare(parts: &Parts, count: usize) -> Option<[f64; 2]> {
    let cc = compiler()?;
    let samples = rehearsal::samples(parts, count);
    let right = rehearsal::answers(parts, &samples).expect("samples that can be taken");
    Some(driven(cc, &written(parts), &samples, &right))
}

fn driven(cc: &str, folder: &TempDir, samples: &[Sample], right: &[Answer]) -> [f64; 2] {
    let program = link(cc, folder, &["estimator.c", "drive.c"], &["-O1"]);
    deviations(&through(&program, samples), right)
}

/// Asserts what an export must reach.
pub fn assert_equal(what: &str, parts: &Parts, count: usize) {
    assert_close(what, compare(parts, count));
}

/// The same of an average.
pub fn assert_equal_average(what: &str, average: &AverageParts, count: usize) {
    let Some(cc) = compiler() else { return };
    let samples = rehearsal::samples_of_average(average, count);
    let right = rehearsal::answers_of_average(average, &samples).expect("samples that can be taken");
    assert_close(what, Some(driven(cc, &written_average(average), &samples, &right)));
}

fn assert_close(what: &str, found: Option<[f64; 2]>) {
    if let Some([all, nominal]) = found {
        println!("{what}: {all:.1e} of the RMS, nominal model {nominal:.1e}");
        assert!(all < 1e-5, "{what}: {all:.1e} of the RMS");
        assert!(nominal < 1e-9, "{what}: nominal model {nominal:.1e} of the RMS");
    }
}
