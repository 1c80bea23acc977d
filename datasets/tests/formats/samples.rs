//! The samples of `../shared/data/recordings`, compared with what other readers find in them (`reference.py`).

use std::collections::BTreeMap;
use std::path::PathBuf;

use acm_datasets::formats::{self, Format, Keep, Take};
use serde::Deserialize;

#[derive(Deserialize)]
struct Group {
    name: String,
    samples: usize,
    span: (f64, f64),
    width: Option<usize>,
    columns: Vec<Column>,
}

#[derive(Deserialize)]
struct Column {
    name: String,
    finite: usize,
    sum: f64,
    squares: f64,
}

/// The folder of the samples; says so where there is none.
pub fn folder() -> Option<PathBuf> {
    let shared = std::env::var_os("ACM_SHARED").map(PathBuf::from);
    let beside = [PathBuf::from("../shared"), PathBuf::from("../../shared")];
    let found = shared.into_iter().chain(beside).map(|s| s.join("data/recordings")).find(|folder| folder.is_dir());
    if found.is_none() {
        eprintln!("SKIPPED: there is no folder data/recordings in $ACM_SHARED or ../shared");
    }
    found
}

fn near(ours: f64, theirs: f64) -> bool {
    (ours - theirs).abs() <= 1e-9 * theirs.abs().max(1e-6)
}

/// What of a take differs from what another reader finds.
fn differences(take: &Take, groups: &[Group], wrong: &mut Vec<String>) {
    for group in groups {
        let Some(ours) = take.groups.iter().find(|g| g.name == group.name) else {
            wrong.push(format!("group {:?} is missing", group.name));
            continue;
        };
        let of = format!("group {:?}", group.name);
        if ours.samples != group.samples || group.width.is_some_and(|width| width != ours.columns.len()) {
            wrong.push(format!("{of}: {} samples, {} columns", ours.samples, ours.columns.len()));
        }
        if !near(ours.span.0, group.span.0) || !near(ours.span.1, group.span.1) {
            wrong.push(format!("{of}: {:?} and {:?}", ours.span, group.span));
        }
        for column in &group.columns {
            let Some(found) = ours.columns.iter().find(|c| c.name == column.name) else {
                wrong.push(format!("{of}: {:?} is missing", column.name));
                continue;
            };
            let finite: Vec<f64> = found.values.iter().copied().filter(|value| value.is_finite()).collect();
            let (sum, squares) = (finite.iter().sum::<f64>(), finite.iter().map(|v| v * v).sum::<f64>());
            if finite.len() != column.finite || !near(sum, column.sum) || !near(squares, column.squares) {
                wrong.push(format!("{:?}: {} {sum} {squares}", column.name, finite.len()));
            }
        }
    }
}

/// Oracle: pyulog, pyomeca, pandas and rosbags.
#[test]
fn every_sample_holds_what_other_readers_find_in_it() {
    let Some(folder) = folder() else { return };
    let reference: BTreeMap<String, Vec<Group>> =
        serde_json::from_str(include_str!("reference.json")).expect("reference.json");
    let mut wrong = vec![];
    for (file, groups) in &reference {
        let path = folder.join(file);
        let format = formats::recognise(&path).expect("read").expect("known");
        if format == Format::Mcap && !cfg!(feature = "mcap") {
            let message = formats::read(&path, format, Keep::All).expect_err("built without").to_string();
            assert!(message.contains("--features mcap"), "{message}");
            continue;
        }
        let take = formats::read(&path, format, Keep::All).expect("a sample is read");
        let before = wrong.len();
        differences(&take, groups, &mut wrong);
        wrong[before..].iter_mut().for_each(|what| *what = format!("{file}: {what}"));
        assert_eq!(take.groups.len(), groups.len(), "{file}");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Without values, the same counts; of one column, its values alone.
#[test]
fn what_is_not_asked_for_is_counted_and_not_kept() {
    let Some(folder) = folder() else { return };
    for (file, column) in [
        ("esc_status_log.ulg", "vehicle_attitude.q[0]"),
        ("markers.trc", "ASISl.X"),
        ("vicon-markers.csv", "boite.gauche_ext.Z"),
        ("motive-1.21.csv", "Rigid Body 1.Position.Y"),
    ] {
        let path = folder.join(file);
        let format = formats::recognise(&path).expect("read").expect("known");
        let [all, none] = [Keep::All, Keep::Nothing].map(|keep| formats::read(&path, format, keep).expect("read"));
        let names = [column.to_string()].into();
        let one = formats::read(&path, format, Keep::Named(&names)).expect("read");
        for ((all, none), one) in all.groups.iter().zip(&none.groups).zip(&one.groups) {
            assert_eq!((all.samples, all.span, all.samples), (none.samples, one.span, all.time.len()), "{file}");
            assert!(none.time.is_empty() && none.columns.iter().all(|c| c.values.is_empty()), "{file}");
            for (a, b) in all.columns.iter().zip(&one.columns) {
                let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
                let kept = if a.name == column { bits(&a.values) } else { vec![] };
                assert_eq!(kept, bits(&b.values), "{file}: {}", a.name);
            }
        }
        assert!(one.column(column).is_some_and(|(group, c)| c.values.len() == group.time.len()), "{file}");
    }
}
