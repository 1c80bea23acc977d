//! Damaged files are read or refused with a message: some at random, the same in every run, and all that once were not.
//!
//! `cargo run -p acm-datasets --example fuzz_files -- --count N` damages as many as wanted.

#![allow(missing_docs)]

#[allow(dead_code)] // used by another test
#[path = "../examples/bad_files/good.rs"]
mod good;
#[allow(dead_code)] // used by another test
#[path = "sources/lab.rs"]
mod lab;
#[path = "../examples/fuzz_files/mutate.rs"]
mod mutate;
#[path = "../examples/bad_files/parquet_bytes.rs"]
mod parquet_bytes;
#[path = "../examples/fuzz_files/recordings.rs"]
mod recordings;
#[path = "../examples/fuzz_files/target.rs"]
mod target;
#[path = "formats/ulog_file.rs"]
mod ulog_file;

use target::Target;

#[test]
fn files_in_order_are_read() {
    let read = acm_datasets::Campaign::read(&lab::Lab::of(2, 8.0).path(), None).expect("read");
    assert_eq!((read.trials.len(), read.alignments.len()), (2, 6));
    for target in [Target::Csv, Target::Parquet] {
        for (i, bytes) in target.corpus().expect("a corpus").iter().enumerate() {
            let set = good::Set::new().expect("a folder");
            let file = if target == Target::Csv { "data/run_b.csv" } else { "data/run_p.parquet" };
            set.write(file, bytes).expect("written");
            let read = acm_datasets::Campaign::read(&set.path(), None);
            // the file with one value for all has one time stamp
            let message = read.err().map_or(String::new(), |e| e.to_string());
            assert!(message.is_empty() || message.contains("repeats row"), "{} {i}: {message}", target.name());
        }
    }
}

#[test]
fn damaged_files_are_read_or_refused() {
    for target in Target::ALL {
        let corpus = target.corpus().expect("a corpus");
        for number in 0..150 {
            let bytes = mutate::damaged(&corpus, 1, number);
            let wrong = target.wrong(&bytes).expect("a folder");
            assert_eq!(wrong, None, "{} {number}", target.name());
        }
    }
}

/// What was found by longer runs: `tests/regressions/<target>-<what it did>`.
#[test]
fn what_once_failed_is_read_or_refused() {
    let folder = std::path::absolute("tests/regressions").unwrap();
    for entry in std::fs::read_dir(folder).expect("the folder") {
        let path = entry.expect("a file").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let Some(target) = Target::ALL.into_iter().find(|target| name.starts_with(target.name())) else { continue };
        let wrong = target.wrong(&std::fs::read(&path).expect("a file")).expect("a folder");
        assert_eq!(wrong, None, "{name}");
    }
}
