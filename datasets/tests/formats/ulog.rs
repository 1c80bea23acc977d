//! ULog: topics, damage and what is told of it.

use acm_datasets::formats::{self, Format, Keep, Take};

use crate::ulog_file::Log;

pub fn read(bytes: &[u8]) -> Result<Take, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("log.ulg");
    std::fs::write(&path, bytes).expect("written");
    formats::read(&path, Format::Ulog, Keep::All).map_err(|e| e.to_string())
}

/// Oracle: the file was written byte by byte.
#[test]
fn topics_have_their_own_times_and_instances() {
    let take = read(&Log::of(25).0).expect("read");
    let names: Vec<&str> = take.groups.iter().map(|g| g.name.as_str()).collect();
    assert_eq!((names, take.lost.len()), (vec!["pose", "pose[1]", "power"], 0), "{:?}", take.lost);
    let (group, y) = take.column("pose[1].p[1]").expect("a column");
    assert_eq!((group.time.len(), group.time[24], y.values[24]), (25, 1.2405, -48.0));
    let (group, volt) = take.column("power.volt").expect("a column");
    assert_eq!((&group.time[..], &volt.values[..]), (&[1.0, 1.1, 1.2][..], &[12.0, 17.0, 22.0][..]));
    assert_eq!(take.column("pose.ok").map(|(_, c)| c.values[0]), Some(1.0));
    assert!(take.column("pose._padding0[0]").is_none());
}

/// A record that claims to be longer than it is takes what follows with it, up to the next mark.
#[test]
fn behind_damage_the_log_goes_on_at_the_next_mark() {
    let whole = Log::of(100);
    let mut log = Log::of(30);
    log.0.extend([0xff, 0xff, b'D', 1, 2, 3]);
    let rest = Log::of(100).0[Log::of(31).0.len() - 8..].to_vec();
    log.0.extend(rest);
    let take = read(&log.0).expect("read");
    let found = take.column("pose.p[0]").map(|(g, _)| g.samples).unwrap_or_default();
    let all = read(&whole.0).expect("read").column("pose.p[0]").map(|(g, _)| g.samples).unwrap_or_default();
    assert!(all == 100 && (85..100).contains(&found), "{found} of {all}");
    assert!(take.lost.iter().any(|what| what.contains("damaged bytes")), "{:?}", take.lost);
}

#[test]
fn a_log_that_was_cut_off_keeps_what_came_before() {
    let bytes = Log::of(50).0;
    let take = read(&bytes[..bytes.len() - 40]).expect("read");
    assert!(take.lost.iter().any(|what| what.contains("ends in a record")), "{:?}", take.lost);
    assert!(take.column("pose.p[0]").is_some_and(|(g, _)| g.samples >= 48));
    for length in [0, 10, 16, 40, 90] {
        let message = read(&bytes[..length]).expect_err("refused");
        assert!(message.contains("log.ulg") && message.contains("copy it again"), "{message}");
    }
}

/// Records that panic the decoder are refused before it: a subscription and a parameter that are too short.
#[test]
fn records_that_are_too_short_are_damage() {
    for short in [(b'A', vec![]), (b'A', vec![0, 1]), (b'P', vec![]), (b'P', vec![200, 1]), (b'Q', vec![0])] {
        let mut log = Log::of(5);
        log.record(short.0, &short.1);
        log.sync();
        log.pose(3, 9_000_000, 1.0);
        let take = read(&log.0).expect("read");
        assert_eq!(take.groups[0].span.1, 9.0, "{short:?}");
        assert_eq!(take.lost.len(), 1, "{short:?}: {:?}", take.lost);
    }
}

/// Two seconds of a log that tells more than anybody holds: 2 GB of arrays in its definitions.
#[test]
fn definitions_that_grow_without_bound_are_refused() {
    let mut log = Log(b"ULog\x01\x12\x35\x01\0\0\0\0\0\0\0\0".to_vec());
    log.record(b'B', &[0; 40]);
    for i in 0..200 {
        log.record(b'F', format!("t{i}:uint64_t timestamp;uint8_t[32000] a;uint8_t[32000] b;").as_bytes());
    }
    log.record(b'A', b"\0\0\0t199");
    let message = read(&log.0).expect_err("refused");
    assert!(message.contains("damaged"), "{message}");
}
