//! Oracles: by hand.

use std::collections::BTreeMap;

use super::*;
use crate::levels::Level;
use crate::manifest::{FoldTable, Signal};

/// Trials with the means of some context signals, each with its spread within trials.
fn trials(signals: &[(&str, f64, &[f64])]) -> (Manifest, Vec<Entry>) {
    let signal = |(name, ..): &(&str, f64, &[f64])| Signal { column: name.to_string(), ..Signal::default() };
    let manifest = Manifest { context: signals.iter().map(signal).collect(), ..Manifest::default() };
    let count = signals.first().map_or(0, |(.., means)| means.len());
    let of = |trial: usize| Entry {
        name: (trial + 1).to_string(),
        role: Role::Development,
        samples: 100,
        longest: 100,
        max_gap: 0.5,
        levels: signals.iter().map(|(_, sd, means)| Level { mean: means[trial], variance: sd * sd }).collect(),
        increments: vec![],
        conditions: BTreeMap::new(),
        dropped: BTreeMap::new(),
        file: "f".into(),
        place: crate::entry::Place::default(),
    };
    (manifest, (0..count).map(of).collect())
}

fn made(signals: &[(&str, f64, &[f64])], held_out: usize) -> (String, Vec<Vec<String>>) {
    let (manifest, entries) = trials(signals);
    let all: Vec<&Entry> = entries.iter().collect();
    let (learned, held_out) = all.split_at(all.len() - held_out);
    let folds = folds(&manifest, &LeaveOut::Rule, learned, held_out, 10).unwrap();
    (folds.to_string(), folds.validation)
}

const ALTITUDES: [f64; 6] = [2.0, 1.0, 3.01, 1.01, 2.02, 3.0];

#[test]
fn the_values_of_a_signal_that_is_constant_within_trials_are_left_out_in_turn() {
    let (said, folds) = made(&[("altitude", 0.02, &ALTITUDES)], 0);
    assert_eq!(said, "one altitude left out at a time (3 folds)");
    assert_eq!(folds, [["2", "4"], ["1", "5"], ["3", "6"]]);
}

/// The spread of these means is 0.82: a tenth of it is 0.082.
#[test]
fn a_signal_that_varies_within_trials_tells_none_apart() {
    assert!(made(&[("altitude", 0.081, &ALTITUDES)], 0).0.starts_with("one altitude"));
    assert_eq!(made(&[("altitude", 0.083, &ALTITUDES)], 0).0, "some trials left out at a time (5 folds)");
}

#[test]
fn two_values_or_nine_or_one_a_trial_make_no_folds() {
    assert!(made(&[("a", 0.0, &[1.0, 1.0, 2.0, 2.0])], 0).0.starts_with("one trial"));
    assert!(made(&[("a", 0.0, &[1.0, 2.0, 3.0, 4.0])], 0).0.starts_with("one trial"));
    let nine: Vec<f64> = (0..18).map(|trial| f64::from(trial / 2)).collect();
    assert!(made(&[("a", 0.0, &nine)], 0).0.starts_with("some trials"));
    assert!(made(&[("a", 0.0, &nine[..16])], 0).0.starts_with("one a left out"));
}

/// The last trial is held out: at a payload of before, at an altitude that is new.
#[test]
fn of_several_signals_the_one_that_held_out_trials_leave_goes_first_and_then_the_fewest_values() {
    let payload = ("payload", 0.0, &[0.0, 1.0, 2.0, 0.0, 1.0, 2.0, 0.0, 1.0, 1.0][..]);
    let altitude = ("altitude", 0.0, &[1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 5.0][..]);
    assert!(made(&[payload, altitude], 1).0.starts_with("one altitude left out at a time (4 folds)"));
    let at_known = ("altitude", 0.0, &[1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0][..]);
    assert!(made(&[at_known, payload], 1).0.starts_with("one payload left out at a time (3 folds)"));
}

#[test]
fn few_trials_are_cut_in_blocks_of_time_if_they_are_long_enough() {
    let (manifest, mut entries) = trials(&[("a", 1.0, &[1.0, 2.0])]);
    let made = |entries: &[Entry], room| {
        folds(&manifest, &LeaveOut::Rule, &entries.iter().collect::<Vec<_>>(), &[], room).unwrap()
    };
    assert_eq!(made(&entries, 19).validation[1], ["1:block2", "2:block2"]);
    assert_eq!(made(&entries, 19).to_string(), "one block of time left out of each trial at a time (5 folds)");
    assert_eq!(made(&entries, 20).validation, [["1"], ["2"]]);
    entries.clear();
    assert!(made(&entries, 1).validation.is_empty());
}

#[test]
fn a_few_trials_are_left_out_one_by_one_and_more_are_dealt_out() {
    let dealt = made(&[("a", 1.0, &[1.0; 7])], 0).1;
    assert_eq!(dealt, [vec!["1", "6"], vec!["2", "7"], vec!["3"], vec!["4"], vec!["5"]]);
    assert_eq!(made(&[("a", 1.0, &[1.0; 3])], 0).1, [["1"], ["2"], ["3"]]);
}

#[test]
fn the_manifest_goes_first_unless_something_else_is_asked() {
    let (mut manifest, entries) = trials(&[("altitude", 0.02, &ALTITUDES)]);
    let validation = vec![vec!["2".to_string()]];
    manifest.folds = FoldTable { validation: validation.clone() };
    let learned: Vec<&Entry> = entries.iter().collect();
    let made = |asked: LeaveOut| folds(&manifest, &asked, &learned, &[], 10);
    assert_eq!(made(LeaveOut::Rule).unwrap(), Folds::listed(validation));
    assert_eq!(made(LeaveOut::Value("altitude".into())).unwrap().validation.len(), 3);
    assert_eq!(made(LeaveOut::Trial).unwrap().by, By::Trial);
    assert_eq!(made(LeaveOut::Value("payload".into())), None);
}
