//! Files that are damaged at random are read in part or refused with a message; some hundred of each here,
//! `cargo run -p acm-datasets --example fuzz_files -- --count 10000 --target ulog` for more.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use crate::ulog_file::Log;

/// Bytes replaced, left out, doubled or cut off.
fn damaged(whole: &[u8], number: u64) -> Vec<u8> {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    random.set_stream(number);
    let mut bytes = whole.to_vec();
    for _ in 0..1 << random.random_range(0..4) {
        if bytes.is_empty() {
            break;
        }
        let at = random.random_range(0..bytes.len());
        let end = (at + (1 << random.random_range(0..8))).min(bytes.len());
        match random.random_range(0..5) {
            0 => bytes[at] = random.random_range(0..=255),
            1 => bytes[at] ^= 1 << random.random_range(0..8),
            2 => drop(bytes.drain(at..end)),
            3 => {
                let piece = bytes[at..end].to_vec();
                bytes.splice(at..at, piece);
            }
            _ => bytes.truncate(at),
        }
    }
    bytes
}

#[test]
fn damaged_logs_and_takes_are_read_or_refused() {
    let (log, take) = (Log::of(40).0, super::motive::V123.as_bytes());
    let folder = tempfile::tempdir().expect("a folder");
    let (mut read, mut refused) = (0, 0);
    for number in 0..400 {
        for (whole, name) in [(log.as_slice(), "a.ulg"), (take, "a.csv")] {
            let path = folder.path().join(name);
            std::fs::write(&path, damaged(whole, number)).expect("written");
            let Some(format) = acm_datasets::formats::recognise(&path).expect("read") else { continue };
            if format.is_table() {
                continue;
            }
            match acm_datasets::formats::read(&path, format, acm_datasets::formats::Keep::All) {
                Ok(_) => read += 1,
                Err(error) => {
                    refused += 1;
                    assert!(error.to_string().contains(name), "{error}");
                }
            }
        }
    }
    assert!(read > 100 && refused > 100, "{read} read, {refused} refused");
}
