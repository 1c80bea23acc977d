//! Damages experiment files, studies and manifests at random, and reads them: each must give an experiment or a message.
//!
//! ```text
//! cargo run -p acm-train --example fuzz_toml -- [--count N] [--seed S]
//! ```
//!
//! Damage K of a seed is always the same; what fails is kept in `fuzz-<file>-<seed>-<number>` in the current folder.

#![allow(missing_docs)]

#[allow(dead_code)] // used by another example
#[path = "../bad_toml/judge.rs"]
mod judge;
#[path = "../../../datasets/examples/fuzz_files/mutate.rs"]
mod mutate;
#[allow(dead_code)]
#[path = "../bad_toml/spoil.rs"]
mod spoil;
mod target;
#[path = "../bad_toml/whole.rs"]
mod whole;

use std::{error::Error, fs, process::ExitCode};

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let option = |name: &str| arguments.iter().position(|a| a == name).and_then(|i| arguments.get(i + 1));
    let count: u64 = option("--count").map_or(Ok(1000), |n| n.parse())?;
    let seed: u64 = option("--seed").map_or(Ok(1), |n| n.parse())?;
    let folder = tempfile::tempdir()?;
    let corpus: Vec<Vec<u8>> = whole::ALL.iter().map(|whole| whole.text.as_bytes().to_vec()).collect();
    let mut failed = 0;
    for number in 0..count {
        for (w, whole) in whole::ALL.iter().enumerate() {
            let bytes = mutate::damaged(&corpus[w..=w], seed, number);
            if let Some(what) = target::wrong(whole, folder.path(), &bytes)? {
                failed += 1;
                let name = format!("fuzz-{}-{seed}-{number}", whole.file);
                fs::write(&name, bytes)?;
                eprintln!("{name}: {what}");
            }
        }
    }
    let files = count * whole::ALL.len() as u64;
    println!("{files} damaged files, each read or refused with a message but {failed}");
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
