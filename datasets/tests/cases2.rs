//! Small recordings of kinds that were once read wrongly, misunderstood or refused. They lie in `../shared/data/cases2`, whose
//! README says what is right. Oracle: that table.

#![allow(missing_docs)]

use std::path::{Path, PathBuf};

use acm_datasets::Recordings;
use acm_datasets::recordings::Options;
use acm_datasets::sequences::Asked;
use acm_datasets::sequences::table::{Rules, Tables, read};

/// What becomes of a case.
enum Outcome {
    /// Read, with so many samples; notes and warnings have these words.
    Read(usize, &'static [&'static str]),
    /// Refused with these words, and without those behind.
    Refused(&'static [&'static str], &'static [&'static str]),
}

use Outcome::{Read, Refused};

const DAMAGED: &[&str] = &["truncated or damaged"];

const CASES: &[(&str, Outcome)] = &[
    ("01-trailing-comma-rows", Read(360, &[])),
    ("03c-us-thousands-quoted-told", Read(360, &[])),
    ("04-python-logging-comma-ms", Read(360, &["dates without a zone"])),
    ("04c-german-date", Refused(&["row 2, column `t`", "a date of another form", "ISO 8601"], &[])),
    ("05-dst-fall-back-local", Refused(&["set back by one hour at 02:59:59.980"], &["sort the file"])),
    ("07-00-missing", Read(351, &["missing values are written \"-nan(ind)\" (3 times)"])),
    ("08d-preamble", Read(360, &["the header is row 4"])),
    ("08k-whitespace-separated", Read(360, &["separated by blanks"])),
    ("08l-escaped-quotes-header", Read(360, &[])),
    ("11b-duplicate-stamps", Refused(&["time stands still", "row 3"], &["sort the file"])),
    (
        "11f-uint32-ms-rollover",
        Refused(&["starts again at 0 after 4294967295 (2^32 - 1)", "counters = "], &["sort the file"]),
    ),
    ("12b-sep-line-bom-upper", Read(360, &["separated by ';'", "decimal comma"])),
    ("22-motive-semicolon-decimal-comma", Read(360, &["decimal comma"])),
    ("24b-motive-one-row-shifted", Refused(&["run_a.csv, row 68", "11 cells under 10 columns"], &[])),
    ("27-motive-inches", Read(360, &["Length Units: Inches is not known"])),
    ("31-trc-NaN", Read(330, &["\"NaN\" ("])),
    ("32-trc-spaces", Read(360, &[])),
    ("41-vicon-events-first", Read(360, &["section `Events` is skipped"])),
    ("43-vicon-tab", Read(360, &[])),
    ("45-vicon-decimal-comma", Refused(&["row 6", "cells under"], &[])),
    ("55-ulog-resubscribed", Read(360, &[])),
    ("58-ulog-uint32-stamp", Refused(&["not supported", "`timestamp`"], DAMAGED)),
    ("66-ulog-format-with-spaces", Refused(&["not supported"], DAMAGED)),
    ("71d-float16-bss", Refused(&["not supported", "ByteStreamSplit"], DAMAGED)),
    ("72e-ts-s", Read(360, &[])),
    ("73b-nan-in-output", Read(330, &["\"NaN\" (10 times)"])),
    (
        "89-actuator-wraps-pi",
        Read(6000, &["column `q` of trial `d1` jumps by a full turn", "angles = [\"q\"] in [table]"]),
    ),
    (
        "89b-output-wraps-pi",
        Read(6000, &["column `y` of trial `d1` jumps by a full turn", "angles = [\"y\"] in [table]"]),
    ),
    ("94-context-slow-empty-cells", Refused(&["column `u`: the cell is empty", "fill = \"previous\""], &[])),
    (
        "98-lerobot-lists",
        Refused(&["column `action`: values of type list", "name one of them, as in `action[0]`"], &[]),
    ),
    ("s03h-all-ints-german-thousands", Refused(&["row 2", "\"-14.013\"", "decimal = "], &[])),
    ("s04b-clock-comma-decimal-comma", Read(360, &["times of day", "decimal comma"])),
    ("s12b-SEP-told", Read(360, &["decimal comma"])),
    ("t20-motive-NaN", Read(330, &["\"NaN\" ("])),
    ("u1-parquet-encrypted", Refused(&["not supported", "encrypted"], DAMAGED)),
    #[cfg(feature = "mcap")]
    ("a3-mcap-json", Refused(&["not supported", "json"], &["the file has :"])),
    #[cfg(feature = "mcap")]
    ("a8-mcap-two-channels-one-topic", Read(360, &[])),
];

fn folder() -> PathBuf {
    let shared = std::env::var_os("ACM_SHARED").map_or_else(|| "../../shared".into(), PathBuf::from);
    shared.join("data/cases2")
}

/// What differs from the outcome.
fn wrong(folder: &Path, outcome: &Outcome) -> Option<String> {
    let options = Options { window: Some(50), ..Options::default() };
    match (Recordings::open(folder, None, &options), outcome) {
        (Ok(data), Read(samples, words)) => {
            let said = [data.notes.join("\n"), data.warnings.join("\n")].concat();
            let lacking: Vec<&&str> = words.iter().filter(|word| !said.contains(**word)).collect();
            (data.samples() != *samples || !lacking.is_empty())
                .then(|| format!("{} samples, lacks {lacking:?} in {said}", data.samples()))
        }
        (Err(error), Refused(words, others)) => {
            let message = error.to_string();
            let lacking: Vec<&&str> = words.iter().filter(|word| !message.contains(**word)).collect();
            let there: Vec<&&str> = others.iter().filter(|word| message.contains(**word)).collect();
            (!lacking.is_empty() || !there.is_empty()).then(|| format!("lacks {lacking:?}, has {there:?}: {message}"))
        }
        (Ok(data), Refused(..)) => Some(format!("was read, with {} samples: {:?}", data.samples(), data.warnings)),
        (Err(error), Read(..)) => Some(error.to_string()),
    }
}

#[test]
#[ignore = "needs ../shared/data/cases2"]
fn cases2_are_read_or_refused_as_their_table_says() {
    let of = |(case, outcome): &(&str, Outcome)| Some(format!("{case}: {}", wrong(&folder().join(case), outcome)?));
    let failures: Vec<String> = CASES.iter().filter_map(of).collect();
    assert!(failures.is_empty(), "{} of {}:\n{}", failures.len(), CASES.len(), failures.join("\n"));
}

/// A slow signal is held or interpolated on request, an angle unwrapped.
#[test]
#[ignore = "needs ../shared/data/cases2"]
fn cases2_are_read_with_the_keys_that_the_messages_name() {
    for (case, from, to) in [
        ("94-context-slow-empty-cells", "unit = \"V\"", "unit = \"V\"\nfill = \"previous\""),
        ("94-context-slow-empty-cells", "unit = \"V\"", "unit = \"V\"\nfill = \"linear\""),
        ("89-actuator-wraps-pi", "files =", "angles = [\"q\"]\nfiles ="),
        ("98-lerobot-lists", "\"action\"", "\"action[0]\""),
        ("11f-uint32-ms-rollover", "clock =", "counters = { t = 4294967296 }\nclock ="),
    ] {
        let (source, copy) = (folder().join(case), tempfile::tempdir().expect("a folder"));
        for file in std::fs::read_dir(&source).expect("a case").flatten() {
            std::fs::copy(file.path(), copy.path().join(file.file_name())).expect("copied");
        }
        let manifest = std::fs::read_to_string(source.join("manifest.toml")).expect("a manifest");
        assert!(manifest.contains(from), "{case}");
        let edited = manifest.replacen(from, to, 1).replace("\"observation.state\"", "\"observation.state[0]\"");
        std::fs::write(copy.path().join("manifest.toml"), edited).expect("written");
        let data = Recordings::open(copy.path(), None, &Options::default());
        let data = data.unwrap_or_else(|error| panic!("{case}, {to:?}: {error}"));
        assert!(data.samples() > 300 && !data.warnings.iter().any(|w| w.contains("jumps by")), "{:?}", data.warnings);
    }
}

#[test]
#[ignore = "needs ../shared/data/cases2"]
fn cases2_of_sequences_are_read() {
    for (case, file) in [("b20-seq-parquet-timestamps", "table.parquet"), ("b21-seq-semicolon-comma", "table.csv")] {
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_string()).collect::<Vec<String>>();
        let tables = Tables {
            files: names(&[file]),
            sequence: Some("run".into()),
            part: Some("part".into()),
            time: Some("t".into()),
            inputs: names(&["x", "v"]),
            targets: names(&["x", "v"]),
            ahead: 1,
            ..Tables::default()
        };
        let set = read(&tables, &folder().join(case), Rules { asked: Asked::Every, labels: false });
        let set = set.unwrap_or_else(|error| panic!("{case}: {error}"));
        assert!(
            set.training.len() > 3 && set.training[0].elapsed.iter().all(|step| (0.0..2.0).contains(step)),
            "{case}"
        );
    }
}
