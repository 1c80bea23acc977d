//! Damages CSV files, Parquet files, manifests and recordings at random, and reads them: each must give a data set or a message.
//!
//! ```text
//! cargo run -p acm-datasets --example fuzz_files -- [--count N] [--seed S] [--from K] [--target NAME]
//! ```
//!
//! NAME: csv, parquet, manifest, motive, vicon, trc, ulog, mcap; sources-csv, sources-motive, sources-ulog: one file of a set of sources.
//!
//! Damage K of a seed is always the same. What fails is kept in `fuzz-<target>-<seed>-<number>` in the current folder; in
//! `tests/regressions` it is read by a test from then on.

#![allow(missing_docs)]

#[allow(dead_code)] // used by another example
#[path = "../bad_files/good.rs"]
mod good;
#[allow(dead_code)] // used by a test
#[path = "../../tests/sources/lab.rs"]
mod lab;
mod mutate;
#[path = "../bad_files/parquet_bytes.rs"]
mod parquet_bytes;
mod recordings;
mod target;
#[path = "../../tests/formats/ulog_file.rs"]
mod ulog_file;

use std::error::Error;
use std::process::ExitCode;

use target::Target;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let (mut count, mut seed, mut from, mut targets) = (1000, 1, 0, Target::ALL.to_vec());
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or("each option has a value")?;
        match name.as_str() {
            "--count" => count = value.parse()?,
            "--seed" => seed = value.parse()?,
            "--from" => from = value.parse()?,
            "--target" => targets.retain(|target| target.name() == value),
            _ => return Err(format!("{name} is no option").into()),
        }
    }
    let mut all = 0;
    for target in targets {
        let mut failed = 0;
        let corpus = target.corpus()?;
        for number in from..from + count {
            if number % 1000 == 0 {
                eprintln!("{} {number}", target.name());
            }
            let bytes = mutate::damaged(&corpus, seed, number);
            if let Some(what) = target.wrong(&bytes)? {
                failed += 1;
                let name = format!("fuzz-{}-{seed}-{number}", target.name());
                std::fs::write(&name, bytes)?;
                eprintln!("{name}: {what}");
            }
        }
        println!(
            "{}: {count} damaged files, each read or refused with a message but {failed}{}",
            target.name(),
            peak()
        );
        all += failed;
    }
    Ok(if all == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The most memory that this process has held so far, where the system tells it.
fn peak() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse::<f64>().ok());
    kilobytes.map_or(String::new(), |kilobytes| format!("; at most {:.0} MB of memory", kilobytes / 1000.0))
}
