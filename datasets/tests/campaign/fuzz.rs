//! Damaged files: reading returns a set or a message.
//!
//! The damage is the same in every run. More kinds of it, and what was found by longer runs, are in `tests/fuzz.rs`.

use acm_datasets::DataError;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::set::{self, Set};

/// Bytes that matter to a CSV file, and any others.
fn byte() -> impl Strategy<Value = u8> {
    prop_oneof![Just(b','), Just(b'"'), Just(b'\n'), Just(b'\r'), Just(b'-'), Just(b'e'), any::<u8>()]
}

/// Places (as parts of the file) and what is put there; nothing deletes the byte.
fn edits() -> impl Strategy<Value = Vec<(f64, Option<u8>)>> {
    proptest::collection::vec((0.0..1.0f64, proptest::option::of(byte())), 1..12)
}

fn damage(mut bytes: Vec<u8>, edits: &[(f64, Option<u8>)]) -> Vec<u8> {
    for (place, edit) in edits {
        let at = (place * bytes.len() as f64) as usize;
        match edit {
            Some(byte) if at < bytes.len() => bytes[at] = *byte,
            None if at < bytes.len() => drop(bytes.remove(at)),
            _ => {}
        }
    }
    bytes
}

fn fine(read: Result<acm_datasets::Campaign, DataError>) -> bool {
    match read {
        Ok(campaign) => campaign.trials.iter().all(|t| t.measured.iter().all(|v| v.is_finite())),
        Err(error) => error.exit_code() == 3 && !error.to_string().is_empty(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn a_damaged_csv_is_read_or_refused(edits in edits()) {
        let set = Set::new();
        std::fs::write(set.file("run_b.csv"), damage(set::csv(&set::rows(1)).into_bytes(), &edits)).expect("write");
        prop_assert!(fine(set.read()));
    }

    #[test]
    fn a_damaged_parquet_is_read_or_refused(edits in edits(), length in 0.0..1.5f64) {
        let set = Set::new();
        set.edit("manifest.toml", "[\"run_*.csv\"]", "[\"run_*.csv\", \"run_*.parquet\"]");
        std::fs::remove_file(set.file("run_b.csv")).expect("remove");
        let path = set.file("run_b.parquet");
        set::parquet(&path, &set::rows(1));
        let mut bytes = damage(std::fs::read(&path).expect("read"), &edits);
        bytes.truncate((length * bytes.len() as f64) as usize);
        std::fs::write(&path, bytes).expect("write");
        prop_assert!(fine(set.read()));
    }

    #[test]
    fn a_damaged_manifest_is_read_or_refused(edits in edits()) {
        let set = Set::new();
        std::fs::write(set.file("manifest.toml"), damage(set::MANIFEST.as_bytes().to_vec(), &edits)).expect("write");
        let read = set.read();
        prop_assert!(read.map_or_else(|e| matches!(e.exit_code(), 2 | 3) && !e.to_string().is_empty(), |_| true));
    }
}
