//! `acm-eval score-loop`: a campaign end to end, and figures over rows that are made by hand.

use std::fs;

use acm_eval::scoring::{ParameterRow, Row, Score, Share, Top, line, table};
use acm_sim::twin::undeclared::{Class, Design};
use acm_trace::finding::Verdict;
use assert_cmd::Command;
use serde_json::Value;

fn parameter(error: f64, covered: bool) -> ParameterRow {
    ParameterRow {
        effect: "creep".into(),
        name: "share".into(),
        unit: "1".into(),
        truth: 0.2,
        tolerance: 0.02,
        value: 0.2 + 0.02 * error,
        interval: [0.1, 0.3],
        error,
        covered,
        covered_within_tolerance: true,
    }
}

fn row(design: Design, class: Class, verdict: Verdict, found: &[&str], top: Top) -> Row {
    let strings = |names: &[&str]| names.iter().map(|name| (*name).to_string()).collect::<Vec<String>>();
    let truth: &[&str] = match class {
        Class::Inside => &["creep"],
        Class::Pair | Class::Several => &["creep", "backlash"],
        Class::Null | Class::Outside => &[],
    };
    let right = truth.iter().filter(|name| found.contains(name)).count();
    Row {
        seed: 7,
        design,
        kind: "creep".into(),
        class,
        since: None,
        truth: strings(truth),
        also: vec![],
        size: 12.0,
        without_own: false,
        verdict,
        found: strings(found),
        equivalent: strings(found),
        top,
        in_set_by_name: right,
        in_set: right,
        right,
        before: [20.0, 18.0, 15.0],
        after: 3.0,
        floor: 2.6,
        true_floor: 2.6,
        removed: truth.first().map(|_| if top == Top::Name { 0.99 } else { 0.5 }),
        removed_over_true_floor: None,
        parameters: if right > 0 { vec![parameter(0.5, true), parameter(2.0, false)] } else { vec![] },
        parameters_true: 2,
        probe: None,
        at_bound: vec![],
        steps: vec![],
        symbolic: None,
        seconds: 4.0,
    }
}

/// Oracle: counted by hand.
#[test]
fn figures_count_what_they_say() {
    use Class::{Inside, Null, Outside, Pair};
    let (rich, paper) = (Design::Rich, Design::Paper);
    let named = Verdict::Named;
    let rows = vec![
        row(rich, Inside, named, &["creep"], Top::Name),
        row(rich, Inside, named, &["actuator_lag"], Top::Alias),
        row(paper, Inside, Verdict::Partial, &["scale", "creep"], Top::Wrong),
        row(rich, Pair, named, &["creep", "backlash"], Top::Name),
        row(rich, Null, Verdict::NoEffect, &[], Top::None),
        row(rich, Null, named, &["scale"], Top::Wrong),
        row(paper, Null, Verdict::Partial, &["scale"], Top::Wrong),
        row(rich, Outside, Verdict::UnknownStructure, &["scale"], Top::Wrong),
        row(rich, Outside, Verdict::FormImperfect, &["scale"], Top::Wrong),
        Row { without_own: true, ..row(rich, Inside, named, &["scale"], Top::Wrong) },
        // The data cannot tell its equal from the truth.
        Row {
            without_own: true,
            also: vec!["bouc_wen".into()],
            equivalent: vec!["backlash".into(), "bouc_wen".into()],
            ..row(rich, Inside, named, &["backlash"], Top::Wrong)
        },
        Row { without_own: true, ..row(rich, Inside, Verdict::Partial, &["scale"], Top::Wrong) },
    ];
    let score = Score::new(rows, Value::Null);
    let all = &score.all;
    let share = |count, of| Share { count, of };
    assert_eq!((all.top_by_name, all.top), (share(2, 4), share(3, 4)), "effects of the library, their own entry in it");
    assert_eq!((all.in_set_by_name, all.pairs_both, all.pairs_one), (share(3, 4), share(1, 1), share(1, 1)));
    assert_eq!((all.false_names, all.spurious_partials, all.nulls_clean), (share(1, 3), share(1, 3), share(1, 3)));
    assert_eq!(all.outside_abstained, share(1, 2));
    let without_own = (all.without_own_abstained, all.without_own_alias, all.without_own_wrong);
    assert_eq!(without_own, (share(1, 3), share(1, 3), share(1, 3)));
    assert_eq!((all.removed_almost_all, all.removed[0], all.removed[4]), (share(2, 4), Some(0.5), Some(0.745)));
    assert_eq!(
        (all.within_tolerance, all.covered, all.covered_within_tolerance),
        (share(3, 6), share(3, 6), share(6, 6))
    );
    assert_eq!(all.set_size, Some((1.0 + 1.0 + 2.0 + 2.0) / 4.0));
    let [(first, of_rich), (second, of_paper)] = &score.designs[..] else { panic!("two designs") };
    assert_eq!((*first, *second), (rich, paper));
    assert_eq!((of_rich.top, of_paper.top), (share(3, 3), share(0, 1)));
    let shown = table(&score);
    assert!(shown.contains("3/4 = 75.0 %") && shown.contains("paper"), "{shown}");
    assert!(line(&score.rows[5]).contains("FALSE") && line(&score.rows[2]).contains("WRONG"));
}

fn program() -> Command {
    Command::new(assert_cmd::cargo::cargo_bin!("acm-eval"))
}

/// One campaign with a dead time, of which the library is all that there is, and one with nothing.
#[test]
fn a_campaign_is_made_traced_and_compared() {
    let out = tempfile::tempdir().unwrap();
    let done = program()
        .args(["score-loop", "--design", "rich", "--kind", "dead_time", "--seeds", "1", "--nulls", "1"])
        .args(["--set", "effects.only=[\"dead_time\"]", "--set", "search.samples=1500"])
        .args(["--out", &out.path().display().to_string()])
        .assert()
        .success();
    let printed = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
    assert!(printed.contains("top-1: true name") && printed.contains("1/1 = 100.0 %"), "{printed}");
    let score: Value = serde_json::from_str(&fs::read_to_string(out.path().join("score.json")).unwrap()).unwrap();
    let row = &score["rows"][0];
    assert_eq!((row["kind"].as_str(), row["top"].as_str()), (Some("dead_time"), Some("name")), "{row}");
    assert!(row["parameters"][0]["name"].is_string(), "the delay has a counterpart: {row}");
    let null = &score["rows"][1];
    assert_eq!((null["class"].as_str(), null["kind"].as_str()), (Some("null"), Some("white")));
    assert_eq!(score["configuration"]["search"]["samples"], 1500);
}

/// Campaigns of several causes and a rig of each kind, end to end, with a library of a few effects.
#[test]
fn several_causes_and_small_rigs_are_scored() {
    let out = tempfile::tempdir().unwrap();
    let done = program()
        .args(["score-loop", "--design", "rich", "--several", "1", "--small-rigs", "1"])
        .args(["--set", "effects.only=[\"dead_time\",\"actuator_lag\"]", "--set", "search.samples=1000"])
        .args(["--out", &out.path().display().to_string()])
        .assert()
        .success();
    let printed = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
    assert!(
        printed.contains("separable causes named for sure (recall)") && printed.contains("1.05 oracle"),
        "{printed}"
    );
    let read =
        |name: &str| -> Value { serde_json::from_str(&fs::read_to_string(out.path().join(name)).unwrap()).unwrap() };
    let (several, rigs) = (read("several.json"), read("small_rigs.json"));
    assert_eq!((several["seeds"].as_str(), several["rows"][0]["seed"].as_u64()), (Some("development"), Some(14_001)));
    assert_eq!(several["rows"][0]["answer"]["kind"], "several2");
    assert_eq!(rigs["rows"].as_array().map(Vec::len), Some(7));
    for row in rigs["rows"].as_array().unwrap() {
        let value = |key: &str| row[key].as_f64().unwrap();
        // Whoever knows the structure is better than a static map; the loop is not better than that by much.
        assert!(value("oracle") < 1.1 * value("before") && value("error") > 0.8 * value("noise"), "{row}");
    }
}

#[test]
fn an_unknown_kind_is_refused_with_the_known_ones() {
    let done = program().args(["score-loop", "--kind", "backlach"]).assert().failure().code(2);
    let message = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert!(message.contains("backlach") && message.contains("backlash+creep"), "{message}");
}

/// A campaign on which adding one effect made another superfluous, which was then added again, and so on for ever.
#[test]
fn a_search_that_goes_in_circles_ends() {
    program()
        .args(["score-loop", "--design", "paper", "--kind", "marker_offset", "--first-seed", "8022", "--seeds", "1"])
        .arg("--without-own")
        .timeout(std::time::Duration::from_secs(600))
        .assert()
        .success();
}

/// As with `| head`: whoever reads goes away before the first line.
#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let mut running = std::process::Command::new(assert_cmd::cargo::cargo_bin!("acm-eval"))
        .args(["score-loop", "--design", "rich", "--kind", "white", "--seeds", "1"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(running.stdout.take());
    let done = running.wait_with_output().unwrap();
    assert!(!String::from_utf8_lossy(&done.stderr).contains("panicked"), "{done:?}");
}
