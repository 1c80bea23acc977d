//! Every column of the MCAP samples, compared with what rosbags finds in them (`scripts/mcap-reference`).

use std::collections::{BTreeMap, BTreeSet};

use acm_datasets::formats::{self, Format, Keep};
use serde::Deserialize;

use crate::samples::folder;

#[derive(Deserialize)]
struct Topic {
    samples: usize,
    /// Finite values, their sum, and the sum of value times place.
    columns: BTreeMap<String, (usize, f64, f64)>,
}

fn near(ours: f64, theirs: f64) -> bool {
    (ours - theirs).abs() <= 1e-9 * theirs.abs().max(1e-6)
}

/// Oracle: rosbags, which shares no code with the reader.
#[test]
fn every_column_is_what_rosbags_reads() {
    let Some(folder) = folder() else { return };
    let reference: BTreeMap<String, BTreeMap<String, Topic>> =
        serde_json::from_str(include_str!("mcap.json")).expect("mcap.json");
    let (mut compared, mut wrong) = (0, Vec::new());
    for (file, topics) in &reference {
        let take = formats::read(&folder.join(file), Format::Mcap, Keep::All).expect("read");
        assert_eq!(take.groups.len(), topics.len(), "{file}");
        for (name, topic) in topics {
            let Some(group) = take.groups.iter().find(|group| group.name == *name) else {
                wrong.push(format!("{file}: topic {name} is missing"));
                continue;
            };
            let own = |column: &&formats::Column| !column.name.ends_with(".log_time");
            let names: BTreeSet<&String> = group.columns.iter().filter(own).map(|column| &column.name).collect();
            let theirs: BTreeSet<&String> = topic.columns.keys().collect();
            if group.samples != topic.samples || names != theirs {
                let lacking: Vec<_> = theirs.symmetric_difference(&names).take(4).collect();
                wrong.push(format!("{file}: {name}: {} of {} samples, {lacking:?}", group.samples, topic.samples));
            }
            for (column, (finite, sum, moment)) in &topic.columns {
                let Some(found) = group.columns.iter().find(|own| own.name == *column) else { continue };
                let kept = found.values.iter().enumerate().filter(|(_, value)| value.is_finite());
                let (count, total, places) = kept.fold((0, 0.0, 0.0), |(n, sum, moment), (k, value)| {
                    (n + 1, sum + value, moment + (k + 1) as f64 * value)
                });
                compared += 1;
                if count != *finite || !near(total, *sum) || !near(places, *moment) {
                    wrong.push(format!("{column}: {count} {total} {places}, and rosbags has {finite} {sum} {moment}"));
                }
            }
        }
    }
    eprintln!("{compared} columns of {} recordings compared with rosbags", reference.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(compared > 1000, "{compared}");
}
