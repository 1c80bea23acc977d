//! `acm-eval score-loop`: a campaign end to end, and figures over rows that are made by hand.

use std::fs;

use acm_eval::scoring::Share;
use acm_eval::scoring::answer::{Alias, Answer, Claim, TrueCause};
use acm_eval::scoring::figures::Look;
use acm_eval::scoring::single::{ParameterRow, Row, Score, Top, line, table};
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
        without_noise: None,
    }
}

/// What is claimed is sure where the verdict names it; `actuator_lag` stands for creep to 0.985.
fn answer(truth: &[&str], found: &[&str], verdict: Verdict) -> Answer {
    let sure = matches!(verdict, Verdict::Named | Verdict::FormImperfect);
    let cause = |name: &&str| TrueCause {
        name: Some((*name).into()),
        signal: None,
        also: vec![Alias { name: "actuator_lag".into(), share: 0.985 }],
        absence_shows: true,
        missed: 9.0,
        imitated: 0.985,
    };
    Answer {
        kind: "creep".into(),
        causes: truth.iter().map(cause).collect(),
        claims: found
            .iter()
            .map(|name| Claim { name: (*name).into(), signal: None, sure, share: 0.97, doubts: vec![] })
            .collect(),
        intervals: vec![],
        removed: None,
        over_best: Some(if sure { 0.2 } else { 1.005 }),
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
        answer: answer(truth, found, verdict),
        size: 12.0,
        without_own: false,
        verdict,
        found: strings(found),
        equivalent: strings(found),
        top,
        top_share: match top {
            Top::Name => 1.0,
            Top::Alias => 0.985,
            Top::Wrong | Top::None => 0.0,
        },
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
        // An alias is no other cause.
        Row { without_own: true, ..row(rich, Inside, named, &["actuator_lag"], Top::Alias) },
        Row { without_own: true, ..row(rich, Inside, Verdict::Partial, &["scale"], Top::Wrong) },
    ];
    let score = Score::new(rows, Value::Null);
    let all = &score.all;
    let share = |count, of| Share { count, of };
    assert_eq!((all.top_by_name, all.top), (share(2, 4), share(3, 4)), "effects of the library, their own entry in it");
    assert_eq!((all.in_set_by_name, all.pairs_both, all.pairs_one), (share(3, 4), share(1, 1), share(1, 1)));
    assert_eq!(all.top_at, [share(3, 4), share(3, 4), share(2, 4)], "0.985 is an alias at 0.95 and 0.98");
    assert_eq!((all.false_names, all.spurious_partials, all.nulls_clean), (share(1, 3), share(1, 3), share(1, 3)));
    assert_eq!((all.any_name, all.any_name_first), (share(2, 3), share(2, 3)));
    assert_eq!((all.outside_abstained, all.outside_wrong), (share(1, 2), share(1, 2)));
    assert_eq!((all.without_own_abstained, all.without_own_wrong), (share(1, 3), share(1, 3)));
    let unsure = 5;
    assert_eq!((all.not_worse, all.hardly_worse, all.worst), (share(12 - unsure, 12), share(12, 12), Some(1.005)));
    assert_eq!((all.removed_almost_all, all.removed[0], all.removed[4]), (share(2, 4), Some(0.5), Some(0.745)));
    assert_eq!(
        (all.within_tolerance, all.covered, all.covered_within_tolerance),
        (share(3, 6), share(3, 6), share(6, 6))
    );
    assert_eq!(all.set_size, Some((1.0 + 1.0 + 2.0 + 2.0) / 4.0));
    let [(first, of_rich), (second, of_paper)] = &score.designs[..] else { panic!("two designs") };
    assert_eq!((*first, *second), (rich, paper));
    assert_eq!((of_rich.top, of_paper.top), (share(3, 3), share(0, 1)));
    let shown = table(&score, Look::Terminal);
    assert!(shown.contains("3/4 = 75.0 %") && shown.contains("paper"), "{shown}");
    assert!(table(&score, Look::Markdown).lines().nth(1).unwrap().starts_with("|--"), "Markdown");
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
    let rows = fs::read_to_string(out.path().join("single.jsonl")).unwrap();
    assert_eq!(rows.lines().count(), 1 + 2, "what made them, and two campaigns");
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
    let figure = out.path().join("reliability");
    let pooled = program()
        .args(["score-loop", "--markdown", "--pool", &out.path().display().to_string()])
        .args(["--figure", &figure.display().to_string()])
        .assert()
        .success();
    let pooled = String::from_utf8_lossy(&pooled.get_output().stdout).into_owned();
    let tried = pooled.lines().find(|line| line.starts_with("| campaigns and rigs")).unwrap();
    assert_eq!(tried.split_whitespace().nth_back(1), Some("8"), "{pooled}");
    assert!(fs::read_to_string(figure.with_extension("svg")).unwrap().contains("8 campaigns and rigs"));
    png::Decoder::new(std::io::BufReader::new(fs::File::open(figure.with_extension("png")).unwrap()))
        .read_info()
        .unwrap();
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

#[test]
fn an_unknown_criterion_is_refused_with_the_known_ones() {
    let done = program().args(["score-loop", "--criterion", "prize=0.1"]).assert().failure().code(2);
    let message = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert!(message.contains("prize") && message.contains("family_wise"), "{message}");
    program().args(["score-loop", "--criterion", "beam=1.5"]).assert().failure().code(2);
}

/// Rows of one configuration are no rows of another; more seeds than a list has would run into the other list.
#[test]
fn rows_of_another_configuration_and_too_many_seeds_are_refused() {
    let out = tempfile::tempdir().unwrap();
    fs::write(
        out.path().join("single.jsonl"),
        "{\"format\":2,\"version\":\"0\",\"program\":\"\",\"configuration\":{}}\n",
    )
    .unwrap();
    let out = out.path().display().to_string();
    let done = program().args(["score-loop", "--kind", "white", "--seeds", "1", "--out", &out]).assert().code(2);
    assert!(String::from_utf8_lossy(&done.get_output().stderr).contains("another program or configuration"));
    program().args(["score-loop", "--seeds", "1", "--nulls", "1000"]).assert().code(2);
    program().args(["score-loop", "--pool", "no-such-folder"]).assert().code(4);
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

/// The command refuses to replace foreign files, before it starts its work.
#[test]
fn results_replace_results_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for name in ["score.json", "several.json", "aliases.json", "mine.svg", "other.png"] {
        fs::write(path(name), "of somebody").unwrap();
        let place = path(name);
        let arguments = match name {
            "aliases.json" => vec!["--aliases".as_ref(), place.as_os_str()],
            "mine.svg" | "other.png" => vec!["--seeds".as_ref(), "1".as_ref(), "--figure".as_ref(), place.as_os_str()],
            _ => vec!["--seeds".as_ref(), "1".as_ref(), "--out".as_ref(), folder.path().as_os_str()],
        };
        let output =
            Command::new(assert_cmd::cargo::cargo_bin!("acm-eval")).arg("score-loop").args(arguments).output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && told.contains(name), "{name}: {told}");
        assert_eq!(fs::read_to_string(&place).unwrap(), "of somebody");
        fs::remove_file(&place).unwrap();
    }
}
