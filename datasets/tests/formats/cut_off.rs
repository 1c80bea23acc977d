//! Recordings that end too early: what was lost is told.

use std::path::Path;

use acm_datasets::formats::{self, Format, Keep, Take};

use crate::recordings;

fn read(folder: &Path, format: Format, bytes: &[u8]) -> Result<Take, String> {
    let path = folder.join("recording");
    std::fs::write(&path, bytes).expect("written");
    formats::read(&path, format, Keep::All).map_err(|e| e.to_string())
}

fn samples(take: &Take) -> usize {
    take.groups.iter().map(|group| group.samples).sum()
}

/// Ends of the records of a ULog: there nothing shows that more was to come. Size (u16), type, payload.
fn ends(log: &[u8]) -> Vec<usize> {
    let mut ends = vec![16];
    while let Some([low, high]) = log.get(ends[ends.len() - 1]..ends[ends.len() - 1] + 2) {
        ends.push(ends[ends.len() - 1] + 3 + u16::from_le_bytes([*low, *high]) as usize);
    }
    ends
}

/// Every length of a recording that is shorter than the whole gives a message, or all samples, or says what it has lost.
fn cut_off(format: Format, whole: &[u8], silent: &[usize]) {
    let folder = tempfile::tempdir().expect("a folder");
    let all = samples(&read(folder.path(), format, whole).expect("in order"));
    let mut told = 0;
    for length in (0..whole.len()).filter(|length| !silent.contains(length)) {
        match read(folder.path(), format, &whole[..length]) {
            Err(message) => assert!(message.contains("recording") && message.len() < 4096, "{length}: {message}"),
            Ok(take) => {
                let found = samples(&take);
                assert!(found <= all, "{length}: {found} of {all}");
                // a line end that is missing, or a mark at the end, is no loss
                assert!(
                    found == all || !take.lost.is_empty(),
                    "{length}: {found} of {all} samples, and nothing is told"
                );
                told += usize::from(found < all);
            }
        }
    }
    eprintln!("{}: cut off at {} lengths; {told} of them were read in part, and told it", format.name(), whole.len());
    assert!(told > 100, "{told}");
}

#[test]
fn a_log_that_is_cut_off_says_so() {
    let log = &recordings::ulog()[0];
    cut_off(Format::Ulog, log, &ends(log));
}

#[test]
fn a_take_that_is_cut_off_says_so() {
    cut_off(Format::Motive, &recordings::motive()[0], &[]);
}

#[cfg(feature = "mcap")]
#[test]
fn a_recording_of_ros_that_is_cut_off_says_so() {
    for whole in recordings::mcap() {
        cut_off(Format::Mcap, &whole, &[]);
    }
}
