//! Spoils a data set in every way there is, and counts the messages that say where.
//!
//! ```text
//! cargo run -p acm-datasets --example bad_files -- [--count N]
//! ```
//!
//! The last line is the figure: `300 of 300 with file, row, column`. What has no row (a column that is missing, a file that
//! is not a table) or no column (a row that is too long) must be named as exactly as it can be; the lines before say how many
//! there are of each. Without `--count`, all are evaluated.

#![allow(missing_docs)]

mod case;
mod cells;
mod corpus;
mod good;
mod manifests;
mod parquet_bytes;
mod parquets;
mod tables;
mod units;

use std::collections::BTreeMap;
use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use case::Place;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let cases = corpus::all();
    let count = match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        [] => cases.len(),
        ["--count", count] => count.parse::<usize>()?.min(cases.len()),
        _ => return Err("write nothing, or --count N".into()),
    };
    let (mut good, mut slowest, mut places) = (0, (0.0, ""), BTreeMap::<Place, usize>::new());
    for case in (0..count).map(|i| &cases[i * cases.len() / count]) {
        let start = Instant::now();
        let lacks = corpus::judge(case)?;
        let seconds = start.elapsed().as_secs_f64();
        if seconds > slowest.0 {
            slowest = (seconds, &case.name);
        }
        match lacks.is_empty() {
            true => {
                good += 1;
                *places.entry(case.said.place()).or_insert(0) += 1;
            }
            false => eprintln!("{}: without {}\n", case.name, lacks.join("\n  ")),
        }
    }
    for (place, what) in [
        (Place::Cell, "with file, row and column"),
        (Place::Row, "with file and row: the row as a whole is wrong"),
        (Place::Column, "with file and column: the column as a whole is wrong"),
        (Place::Key, "with file, line and column: a manifest"),
        (Place::File, "with file and what is wrong with it as a whole"),
        (Place::Warning, "with a warning that names file and column"),
    ] {
        println!("{:5} {what}", places.get(&place).unwrap_or(&0));
    }
    println!("the slowest took {:.1} s: {}", slowest.0, slowest.1);
    if let Some(memory) = memory() {
        println!("greatest memory: {memory}");
    }
    println!("{good} of {count} with file, row, column");
    Ok(if good == count { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Most memory that the process has held, where the system tells.
fn memory() -> Option<String> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmHWM:")).map(|size| size.trim().to_string())
}
