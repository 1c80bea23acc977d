//! The tendon-driven soft trunk of the Stanford Autonomous Systems Lab (StanfordASL/trunk-stack, MIT licence).
//!
//! The repository keeps what was measured and what was commanded in two files per run. They are joined row by row
//! (their `ID`s must agree), rounded to what the sensors can tell (1e-3 deg, 1e-6 m), and written at 100 Hz and, every
//! fifth row, at 20 Hz, beside the manifest of this project's `asl-trunk` set.
//!
//! | run | measured | commanded |
//! | --- | --- | --- |
//! | `run1_0g` | `observations_controlled_1.csv` | `control_inputs_controlled_1.csv` |
//! | `run1_200g` | `observations_controlled_1_200g.csv` | `control_inputs_controlled_1.csv` |
//! | `run2_0g` | `observations_controlled_2.csv` | `control_inputs_controlled_2.csv` |

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::{Imported, Source};
use crate::error::{DataError, Problems};
use crate::files::atomic;
use crate::ingest::recording::{self, Recording, Wanted};
use crate::manifest::written;

/// The line of the list.
pub(super) const SOURCE: Source = Source {
    name: "asl-trunk",
    about: "tendon-driven soft trunk; git clone https://github.com/StanfordASL/trunk-stack",
    import,
};

/// Where the recordings lie in the repository.
const FOLDER: &str = "stack/main/data/trajectories/dynamic/servo_motor_archive";

const MANIFEST: &str = include_str!("../../asl-trunk/manifest.toml");

const RUNS: [(&str, &str, &str); 3] = [
    ("run1_0g", "observations_controlled_1.csv", "control_inputs_controlled_1.csv"),
    ("run1_200g", "observations_controlled_1_200g.csv", "control_inputs_controlled_1.csv"),
    ("run2_0g", "observations_controlled_2.csv", "control_inputs_controlled_2.csv"),
];

const COMMANDED: [&str; 6] = ["u1", "u2", "u3", "u4", "u5", "u6"];
const ANGLES: [&str; 6] = ["phi1", "phi2", "phi3", "phi4", "phi5", "phi6"];
const DISKS: [&str; 9] = ["x1", "y1", "z1", "x2", "y2", "z2", "x3", "y3", "z3"];

fn import(clone: &Path, out: &Path) -> Result<Imported, DataError> {
    let folder = folder(clone)?;
    written::claim(out, MANIFEST)?;
    let mut tables = Vec::new();
    for (run, measured, commanded) in RUNS {
        if !folder.join(measured).exists() && run != "run1_0g" {
            continue; // a part of the repository is imported as far as it goes; the manifest's check names the rest
        }
        let measured = read(&folder.join(measured), &[ANGLES.as_slice(), &DISKS].concat())?;
        let commanded = read(&folder.join(commanded), &COMMANDED)?;
        same_rows(&measured, &commanded)?;
        tables.push((run, measured, commanded));
    }
    let mut imported = Imported::new();
    for (run, measured, commanded) in &tables {
        for (rate, stride) in [("100hz", 1), ("20hz", 5)] {
            let name = format!("trunk_{run}_{rate}.csv");
            let (text, rows) = join(measured, commanded, stride);
            atomic::write_bytes(&out.join(&name), text.as_bytes())?;
            imported.push((name, rows));
        }
    }
    atomic::write_bytes(&out.join("manifest.toml"), MANIFEST.as_bytes())?;
    Ok(imported)
}

/// The archive in the clone, or the given folder where the files lie in it.
fn folder(clone: &Path) -> Result<PathBuf, DataError> {
    let first = RUNS[0].1;
    let places = [clone.join(FOLDER), clone.to_path_buf()];
    if let Some(place) = places.iter().find(|p| p.join(first).is_file()) {
        return Ok(place.clone());
    }
    let line = |p: &PathBuf| {
        format!("  {}: {}\n", p.display(), if p.is_dir() { format!("no {first}") } else { "no such folder".into() })
    };
    let obtain = "to obtain them: git clone https://github.com/StanfordASL/trunk-stack".to_string();
    Err(DataError::MissingData { name: SOURCE.name.into(), places: places.iter().map(line).collect(), obtain })
}

fn read(path: &Path, columns: &[&str]) -> Result<Recording, DataError> {
    let numbers: BTreeMap<String, bool> = columns.iter().chain(&["ID"]).map(|c| (c.to_string(), false)).collect();
    let wanted = Wanted { numbers, ..Wanted::default() };
    let mut problems = Vec::new();
    let recording = recording::read(path, &wanted, &mut problems);
    Problems(problems).into_result()?;
    recording.ok_or_else(|| DataError::NoRows { path: path.to_path_buf() })
}

/// Both files have the same rows, by number and ID.
fn same_rows(measured: &Recording, commanded: &Recording) -> Result<(), DataError> {
    let (a, b) = (&measured.numbers["ID"], &commanded.numbers["ID"]);
    let Some(row) = (0..a.len().max(b.len())).find(|i| a.get(*i) != b.get(*i)) else { return Ok(()) };
    let id = |ids: &Vec<f64>| ids.get(row).map_or("no row".to_string(), |id| format!("ID {id}"));
    let what = format!("{} here and {} in {}", id(b), id(a), measured.path.display());
    let remedy = "clone the repository again: the two files belong together";
    Err(DataError::BadText { path: commanded.path.clone(), row: row + commanded.first_row, what, remedy })
}

/// The joined table and its number of rows.
fn join(measured: &Recording, commanded: &Recording, stride: usize) -> (String, usize) {
    let header = [&["k"], COMMANDED.as_slice(), &ANGLES, &DISKS].concat();
    let mut text = header.join(",") + "\n";
    let rows = (0..measured.rows).step_by(stride);
    for row in rows.clone() {
        let _ = write!(text, "{}", measured.numbers["ID"][row]);
        for (table, columns, digits) in [(commanded, &COMMANDED[..], 3), (measured, &ANGLES, 3), (measured, &DISKS, 6)]
        {
            for column in columns {
                let _ = write!(text, ",{}", rounded(table.numbers[*column][row], digits));
            }
        }
        text.push('\n');
    }
    (text, rows.len())
}

/// A number with `digits` decimals, without zeros at its end.
fn rounded(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.to_string() }
}

#[cfg(test)]
mod tests {
    use super::rounded;

    #[test]
    fn numbers_are_rounded_and_short() {
        assert_eq!(rounded(-1.3182194200975204, 3), "-1.318");
        assert_eq!(rounded(0.10119184851646423, 6), "0.101192");
        assert_eq!(rounded(0.50000001, 3), "0.5");
        assert_eq!(rounded(-0.0001, 3), "0");
        assert_eq!(rounded(100.0, 3), "100");
    }
}
