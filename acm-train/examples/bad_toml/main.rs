//! Spoils configuration files in every way there is, and counts the messages that say where.
//!
//! ```text
//! cargo run -p acm-train --example bad_toml -- [--count N]
//! ```
//!
//! The last line is the figure: `200 of 200 with file, line, column, key`. Without `--count`, all are evaluated.

#![allow(missing_docs)]

mod judge;
mod spoil;
mod whole;

use std::{error::Error, fs, process::ExitCode};

use acm_train::explain;
use spoil::Case;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let cases = spoil::all();
    let count = match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        [] => cases.len(),
        ["--count", count] => count.parse::<usize>()?.min(cases.len()),
        _ => return Err("write nothing, or --count N".into()),
    };
    let folder = tempfile::tempdir()?;
    let mut good = 0;
    // every part of the list has its share of a smaller count
    for case in (0..count).map(|i| &cases[i * cases.len() / count]) {
        match wrong(case, folder.path())? {
            None => good += 1,
            Some(what) => eprintln!("{what}\n"),
        }
    }
    println!("{good} of {count} with file, line, column, key");
    Ok(if good == count { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn wrong(case: &Case, folder: &std::path::Path) -> Result<Option<String>, Box<dyn Error>> {
    judge::prepare(folder)?;
    fs::write(folder.join(case.file), &case.text)?;
    Ok(match judge::read(case.reader, folder, case.file) {
        Ok(()) => Some(format!("{}: it was read", case.name)),
        Err(error) => {
            let code = error.exit_code();
            judge::complaint(case, code, &explain(error))
        }
    })
}
