//! Tables as people have them, each read as the one file of a `[[source]]` and of a `[table]`: right, or refused with place and
//! remedy. Oracle: the table as it was meant, by hand.

#![allow(missing_docs)]

mod cases;

use std::panic::{AssertUnwindSafe, catch_unwind};

use acm_datasets::Recordings;
use acm_datasets::recordings::Options;
use cases::{Case, Wanted};

/// What every table means: t in s, q in rad, y in mm.
const T: [f64; 4] = [0.0, 0.1, 0.2, 0.3];
const Q: [f64; 4] = [0.5, 0.25, 1.5, -2.0];
const Y: [f64; 4] = [10.0, 20.0, 30.0, 40.0];

fn manifest(source: bool, keys: &str) -> String {
    let (head, before) = match source {
        true => ("[[source]]\nname = \"a\"\nfiles = [\"a.csv\"]\nclock = \"reference\"\n", "a."),
        false => ("[table]\nfiles = [\"a.csv\"]\ntrial = { file = \"(.*)\" }\n", ""),
    };
    let time = if keys.contains("time =") { "" } else { "time = { column = \"t\", unit = \"s\" }\n" };
    format!(
        "{head}{time}{keys}\n[[actuator]]\ncolumn = \"{before}q\"\nunit = \"rad\"\n[[measured]]\ncolumn = \"{before}y\"\nunit = \
         \"mm\"\n[roles]\ndevelopment = [\"a\"]\n"
    )
}

/// Time from its first sample, q, y in mm; and the warnings.
type Read = Result<(Vec<f64>, Vec<f64>, Vec<f64>, Vec<String>), String>;

fn read(source: bool, case: &Case) -> Read {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("manifest.toml"), manifest(source, case.keys)).expect("written");
    std::fs::write(folder.path().join("a.csv"), &case.bytes).expect("written");
    let data = Recordings::open(folder.path(), None, &Options::default()).map_err(|e| e.to_string())?;
    let trial = data.all().next().expect("a trial").map_err(|e| e.to_string())?.into_owned();
    let first = trial.time.first().copied().unwrap_or_default();
    let time = trial.time.iter().map(|t| t - first).collect();
    let column = |matrix: &nalgebra::DMatrix<f64>, factor: f64| matrix.iter().map(|v| v * factor).collect();
    Ok((time, column(&trial.actuators, 1.0), column(&trial.measured, 1000.0), data.warnings.clone()))
}

/// What does not hold of a table.
fn wrong(source: bool, case: &Case) -> Option<String> {
    let Ok(found) = catch_unwind(AssertUnwindSafe(|| read(source, case))) else { return Some("it panicked".into()) };
    let near = |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    match (&case.wanted, found) {
        (Wanted::Right(rows), Ok((t, q, y, warnings))) => {
            let of = |all: [f64; 4]| rows.iter().map(|k| all[*k]).collect::<Vec<f64>>();
            let start = of(T).first().copied().unwrap_or_default();
            let time: Vec<f64> = of(T).iter().map(|t| t - start).collect();
            let right = near(&t, &time) && near(&q, &of(Q)) && near(&y, &of(Y)) && warnings.is_empty();
            (!right).then(|| format!("SILENTLY WRONG: {t:?} {q:?} {y:?} {warnings:?}"))
        }
        (Wanted::Right(_), Err(message)) => Some(format!("refused: {message}")),
        (Wanted::Refused(_), Ok(read)) => Some(format!("ACCEPTED: {read:?}")),
        (Wanted::Refused(parts), Err(message)) => {
            let lacking: Vec<&&str> = parts.iter().filter(|part| !message.contains(**part)).collect();
            // a key that there is not is a problem of the manifest
            let placed = message.contains("a.csv") || message.contains("manifest.toml:");
            (!lacking.is_empty() || !placed).then(|| format!("lacks {lacking:?}: {message}"))
        }
    }
}

#[test]
fn a_messy_table_is_right_or_refused_with_place_and_remedy() {
    let cases = cases::all();
    assert!(cases.len() >= 60, "{}", cases.len());
    let mut failures = Vec::new();
    for case in &cases {
        for (form, source) in [("[[source]]", true), ("[table]", false)] {
            failures.extend(wrong(source, case).map(|what| format!("{} as {form}: {what}", case.name)));
        }
    }
    let right = cases.iter().filter(|case| matches!(case.wanted, Wanted::Right(_))).count();
    eprintln!("{} tables, of which {right} are read and the others refused", cases.len());
    assert!(failures.is_empty(), "{} of {}:\n{}", failures.len(), 2 * cases.len(), failures.join("\n"));
}
