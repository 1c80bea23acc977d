//! `acm-eval stream` on a run that is trained here. Oracle: the predictions that the run was scored with.

#[allow(dead_code)]
mod formulas;

use std::fs;

use acm_datasets::Campaign;
use acm_eval::run::predictions::{HELD_OUT, Predictions};
use acm_stream::{Estimator, Parts};
use acm_train::config::read;
use acm_train::run::evaluation::intervals::{self, Intervals};
use acm_train::run::progress::Progress;
use acm_train::run::stop::Stop;
use acm_train::schedule::job;
use acm_train::schedule::request::Request;
use acm_train::store::hashed;
use formulas::{HEADER, Robot, SAMPLES, TRIALS, row, table};
use serde_json::Value;

/// Cells of all answers to CSV; true is 1, and an empty cell is NaN.
fn cells(answers: &str) -> Vec<Vec<f64>> {
    let cell = |cell: &str| match cell {
        "true" => 1.0,
        "false" => 0.0,
        "" => f64::NAN,
        number => number.parse().unwrap(),
    };
    let row = |line: &str| line.split(',').map(cell).collect();
    answers.lines().skip(1).map(row).collect()
}

/// Answers over windows are what the run was scored with: at every target time stamp, in the unit of the manifest.
#[test]
fn windows_are_answered_as_they_were_scored() {
    for augmented in [false, true] {
        let robot = Robot::new();
        robot.save_model();
        let record = robot.learn(augmented).remove(0);
        let table_of = Predictions::read(&robot.path("run").join(&record.predictions), &record.outputs).unwrap();
        let (mut scored, mut parted, mut unseen) = (0, 0, 0);
        for (trial, rows) in table_of.trials(HELD_OUT).into_iter().map(|rows| (rows.trial.to_string(), rows.rows)) {
            let lines = table(TRIALS.iter().position(|name| *name == trial).unwrap());
            let (code, answers, told) = robot.stream(&["run", "--windows"], &lines);
            assert_eq!(code, 0, "{told}");
            assert!(
                answers.starts_with("t,x,y,nominal_x,nominal_y,history,in_range,low_x,high_x,low_y,high_y\n"),
                "{answers}"
            );
            let (answers, running) = (cells(&answers), cells(&robot.stream(&["run"], &lines).1));
            assert_eq!(answers.len(), SAMPLES);
            // Outside of the domain the nominal model answers alone.
            for cells in answers.iter().filter(|cells| cells[5] == 0.0) {
                assert_eq!(cells[1..3], cells[3..5]);
                unseen += 1;
            }
            for row in rows {
                let k = answers.iter().position(|cells| cells[0] == table_of.time()[row]).unwrap();
                for (o, output) in ["x", "y"].iter().enumerate() {
                    for (column, found) in [("predicted", answers[k][1 + o]), ("nominal", answers[k][3 + o])] {
                        let expected = 1e3 * table_of.column(column, output)[row];
                        let off = (found - expected).abs();
                        assert!(off < 1e-5 * 100.0, "{column}_{output} at {} s: off by {off} mm", answers[k][0]);
                    }
                }
                scored += 1;
                parted += usize::from(running[k][1] != answers[k][1]);
                // The first windows after a start hold all that there is: a state that runs on is as old.
                assert!(running[k][5] > 6.0 || (running[k][1] - answers[k][1]).abs() < 1e-3);
            }
        }
        assert!(scored > 100 && parted > scored / 2, "{scored} scored, {parted} parted");
        assert!(unseen > 10, "{unseen} outside of the domain");
    }
}

/// With a carried state an estimator answers every sample, from a trial's first on, as the run was scored: what the network adds to the bit,
/// and the sum with the nominal model's matrix product to double precision. A network's single precision is a billion times coarser.
#[test]
fn a_carried_state_is_answered_as_it_was_scored() {
    for kind in ["gru", "cfc", "mlp"] {
        let robot = Robot::new();
        let network = format!("network={{ kind = \"{kind}\" }}");
        let few = ["training.epochs=2", "training.epoch_steps=10", "inputs.domain_filter=\"none\""];
        let edits = [&["memory={ state = \"trial\", length = 40 }", network.as_str()], &few[..]].concat();
        let records = robot.learn_with(false, &edits);
        let record = records.iter().find(|record| record.id.starts_with("final")).unwrap();
        let (code, _, told) = robot.stream(&["run", "--save", "robot.json", "--network", &record.id], "");
        assert_eq!(code, 0, "{told}");
        let parts = Parts::from_json(&fs::read(robot.path("robot.json")).unwrap()).unwrap();
        assert!(!parts.straight.is_empty());
        let mut estimator = Estimator::new(parts).unwrap();
        let table_of = Predictions::read(&robot.path("run").join(&record.predictions), &record.outputs).unwrap();
        let campaign = Campaign::read(&robot.path("data"), None).unwrap();
        for (trial, rows) in table_of.trials(HELD_OUT).into_iter().map(|rows| (rows.trial.to_string(), rows.rows)) {
            let trial = campaign.trial(&trial).unwrap();
            assert_eq!(rows.len(), trial.samples());
            estimator.restart();
            for (k, row) in rows.enumerate() {
                let elapsed = if k > 0 { trial.time[k] - trial.time[k - 1] } else { 0.0 };
                let inputs: Vec<f64> = trial.actuators.row(k).iter().chain(&trial.context.row(k)).copied().collect();
                let tip = estimator.step(&inputs, elapsed).unwrap();
                for (tip, output) in tip.iter().zip(["x", "y"]) {
                    let scored = table_of.column("predicted", output)[row];
                    let off = (tip - scored).abs();
                    assert!(off < 8.0 * f64::EPSILON, "{kind}, sample {k} of {}: {output} off by {off} m", trial.name);
                }
            }
        }
    }
}

/// The ends of the interval stand beside an answer, at the half-width that the run found on trials left out; there are none
/// where the nominal model answers alone.
#[test]
fn intervals_stand_beside_the_answers() {
    let robot = Robot::new();
    let (experiment, source) = read(&robot.path("gru.toml"), &["protocol.seeds=[1, 2, 3]".into()]).unwrap();
    let (out, progress, stop) = (robot.path("run"), Progress::Quiet, Stop::default());
    job::run(experiment, &source, &Request::new(&out, &progress, &stop)).unwrap();
    let found: Intervals = hashed::read(&out.join(intervals::FILE), intervals::FORMAT).unwrap();
    let (code, answers, told) = robot.stream(&["run"], table(4));
    assert_eq!(code, 0, "{told}");
    let (header, answers) = answers.split_once('\n').unwrap();
    assert_eq!(header, "t,x,y,nominal_x,nominal_y,history,in_range,low_x,high_x,low_y,high_y");
    let mut alone = 0;
    for line in answers.lines() {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |place: usize| cells[place].parse::<f64>().unwrap();
        if cells[5] == "0" {
            assert_eq!(cells[7..], ["", "", "", ""], "{line}");
            alone += 1;
            continue;
        }
        for (o, of) in found.outputs.iter().enumerate() {
            let (answer, low, high) = (number(1 + o), number(7 + 2 * o), number(8 + 2 * o));
            assert!((answer - low - 1e3 * of.half_width).abs() < 1e-9 * answer.abs().max(1.0), "{line}");
            assert!((high - answer - 1e3 * of.half_width).abs() < 1e-9 * answer.abs().max(1.0), "{line}");
        }
    }
    assert!(alone > 3, "{alone} samples outside of the domain");
}

/// A model that reads its actuators later cannot be streamed, nor saved for a stream: in words, with what to do.
#[test]
fn a_clock_correction_is_refused() {
    let robot = Robot::new();
    robot.save_model_late(0.15);
    robot.learn(true);
    for arguments in [vec!["run"], vec!["run", "--save", "robot.json"]] {
        let (code, printed, told) = robot.stream(&arguments, table(4));
        assert_eq!((code, printed.as_str()), (3, ""), "{told}");
        assert!(told.contains("take 0.15 s off the actuators' time stamps before streaming"), "{told}");
    }
    assert!(!robot.path("robot.json").exists());
}

#[test]
fn lines_of_all_kinds() {
    let robot = Robot::new();
    robot.learn(false);
    let lines = table(4);
    let plain = cells(&robot.stream(&["run", "--everywhere"], &lines).1);
    // JSON, columns in another order, and what nobody asked for.
    let objects: String = lines
        .lines()
        .skip(1)
        .map(|line| {
            let c: Vec<&str> = line.split(',').collect();
            format!("{{\"w\": {}, \"t\": {}, \"note\": \"\", \"q2\": {}, \"q1\": {}}}\n", c[3], c[0], c[2], c[1])
        })
        .collect();
    let (code, answers, told) = robot.stream(&["run", "--everywhere"], &objects);
    assert_eq!(code, 0, "{told}");
    for (line, row) in answers.lines().zip(&plain) {
        let found: Value = serde_json::from_str(line).unwrap();
        let names = ["t", "x", "y", "nominal_x", "nominal_y", "history"];
        names.iter().zip(row).for_each(|(name, value)| assert_eq!(found[name].as_f64(), Some(*value), "{name}"));
        assert_eq!(found["in_range"].as_bool(), Some(row[6] == 1.0));
        assert!(line.contains(",\"in_range\":"), "{line}");
    }
    // An empty line begins a new trial.
    let twice = format!("{lines}\n{}", lines.split_once('\n').unwrap().1);
    let twice = cells(&robot.stream(&["run", "--everywhere"], &twice).1);
    assert_eq!((&twice[..SAMPLES], &twice[SAMPLES..]), (&plain[..], &plain[..]));
    // The gap is where it was put.
    let history: Vec<f64> = plain.iter().map(|row| row[5]).collect();
    assert_eq!((history[70], history[71], history[119]), (71.0, 1.0, 49.0));
}

/// A program of your own answers the same, from a saved file, in SI units.
#[test]
fn a_saved_estimator_answers_alike() {
    let robot = Robot::new();
    robot.learn(false);
    let (code, printed, told) = robot.stream(&["run", "--save", "robot.json"], "");
    assert_eq!((code, printed.trim()), (0, "robot.json"), "{told}");
    let mut saved = fs::read(robot.path("robot.json")).unwrap();
    let parts = Parts::from_json(&saved).unwrap();
    assert_eq!(parts.signals.contexts, ["w"]);
    let mut estimator = Estimator::new(parts).unwrap();
    let lines = table(4);
    let mut before = 0.0;
    for (line, answer) in lines.lines().skip(1).zip(cells(&robot.stream(&["run", "--everywhere"], &lines).1)) {
        let c: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let inputs = [c[1].to_radians(), c[2].to_radians(), 0.01 * c[3]];
        let tip = estimator.step(&inputs, c[0] - before).unwrap();
        assert!((1e3 * tip[0] - answer[1]).abs() < 1e-4 && (1e3 * tip[1] - answer[2]).abs() < 1e-4);
        before = c[0];
    }
    let digit = saved.iter().rposition(u8::is_ascii_digit).unwrap();
    saved[digit] ^= 1;
    assert!(Parts::from_json(&saved).unwrap_err().to_string().contains("was changed"));
    let other = acm_train::store::hashed::encode(&serde_json::json!({"laps": 3})).unwrap();
    assert!(Parts::from_json(&other).unwrap_err().to_string().contains("no estimator"));
}

#[test]
fn lines_that_are_no_sample() {
    let robot = Robot::new();
    robot.learn(false);
    let good: Vec<String> = (0..4).map(|k| row(4, k)).collect();
    let bad = "0.15,abc,1,2,0,0\n0.15,1,2\n0.15,1,,2,0,0\n0.15,nan,1,2,0,0\n0.05,1,2,3,0,0\n";
    let (code, answers, told) = robot.stream(&["run"], format!("{HEADER}{}{}{bad}{}", good[0], good[1], good[2]));
    assert_eq!(code, 3, "{told}");
    for part in [
        "line 4, column q1: \"abc\" is no number; write a number in deg",
        "line 5, column w: 3 cells where the header has 6",
        "line 6, column q2: \"\" is no number",
        "line 7, column q1: NaN is no finite number",
        "line 8, column t: 0.05 is",
        "empty line before a new trial",
        "5 of 8 lines were no sample",
    ] {
        assert!(told.contains(part), "no {part:?} in\n{told}");
    }
    let lines: Vec<&str> = answers.lines().collect();
    assert_eq!(lines[3..8], [",,,,,,,,,,"; 5]);
    let (_, clean, _) = robot.stream(&["run"], format!("{HEADER}{}", good[..3].concat()));
    assert_eq!(lines.last(), clean.lines().last().as_ref(), "refused lines change nothing");

    let (code, answers, told) = robot.stream(&["run"], "{\"t\": 0, \"q1\": 1, \"q2\": \"2\", \"w\": 1}\n{\"t\": 1\n");
    assert_eq!((code, answers.lines().count()), (3, 2), "{told}");
    assert!(told.contains("line 1, column q2: \"2\" is no number; write a number in deg"), "{told}");
    let refused: Value = serde_json::from_str(answers.lines().nth(1).unwrap()).unwrap();
    assert_eq!(refused["line"], 2);
    assert!(refused["error"].as_str().unwrap().contains("one JSON object a line"));

    for (arguments, lines, expected, part) in [
        (vec!["run"], "t,q1,w\n0,1,2\n", 3, "no column q2 [deg]"),
        (vec!["run", "--network", "final-seed9"], "", 2, "no network \"final-seed9\"; it has final-seed1"),
        (vec!["nowhere"], "", 4, "no such folder"),
        (vec!["data"], "", 2, "not a run folder"),
    ] {
        let (code, _, told) = robot.stream(&arguments, lines);
        assert!(code == expected && told.contains(part), "{arguments:?}: {code}: {told}");
    }
    let asked = fs::read_to_string(robot.path("run/experiment.toml")).unwrap();
    let other = asked.replacen("seeds = [1]", "seeds = [2]", 1);
    assert_ne!(asked, other);
    robot.write("run/experiment.toml", &other);
    let (code, _, told) = robot.stream(&["run"], HEADER);
    assert!(code == 3 && told.contains("experiment.toml is not what final-seed1 was run with"), "{told}");
    robot.write("run/experiment.toml", &asked);
    robot.write("data/h2.csv", &table(7));
    let (code, _, told) = robot.stream(&["run"], HEADER);
    assert!(code == 3 && told.contains("have changed: hash"), "{told}");
}

/// A JSON object of a sample of the fifth trial.
fn object(k: usize) -> String {
    let row = row(4, k);
    let c: Vec<&str> = row.trim().split(',').collect();
    format!("{{\"t\": {}, \"q1\": {}, \"q2\": {}, \"w\": {}}}\n", c[0], c[1], c[2], c[3])
}

/// Bytes that are no text, lines without end and numbers without bounds are bad lines like others.
#[test]
fn hostile_lines_change_nothing() {
    let robot = Robot::new();
    robot.learn(false);
    let good: Vec<Vec<u8>> = (0..4).map(|k| row(4, k).into_bytes()).collect();
    let endless = [vec![b'7'; 40 << 20], b"\n".to_vec()].concat();
    let bad: [&[u8]; 6] = [
        b"0.15,\xff,1,2,0,0\n",
        &endless,
        b"0.15,1e300,1,2,0,0\n",
        b"0.15,-1e308,1e308,2,0,0\n",
        b"0.15,1,2,1e308,0,0\n",
        b"1e999,1,2,3,0,0\n",
    ];
    let lines = [HEADER.as_bytes(), &good[0], &good[1], &bad.concat(), &good[2]].concat();
    let (code, answers, told) = robot.stream(&["run", "--everywhere"], lines);
    assert_eq!(code, 3, "{told}");
    for part in [
        "line 4: byte 6 is not UTF-8; send text in UTF-8",
        "line 5: it is longer than 1048576 bytes; send one sample a line",
        "line 6: the nominal model's output 0 comes out as",
        "line 7, column q1: it is -inf in SI units; write a number of the signal's size",
        "line 8: channel 2 comes out as inf, so large are the values; check their units",
        "line 9, column t: inf is no finite number",
        "6 of 9 lines were no sample",
    ] {
        assert!(told.contains(part), "no {part:?} in\n{told}");
    }
    let answers: Vec<&str> = answers.lines().collect();
    assert_eq!(answers[3..9], [",,,,,,,,,,"; 6]);
    let (_, clean, _) = robot.stream(&["run", "--everywhere"], [HEADER.as_bytes(), &good[..3].concat()].concat());
    assert_eq!(answers.last(), clean.lines().last().as_ref(), "refused lines change nothing");
    assert_eq!(answers.len(), 10);

    let others = ["[1,2]\n", "3\n", "null\n", "\"x\"\n", "{\"t\": 0.15, \"q1\": 1e308, \"q2\": 1, \"w\": 1}\n"];
    for first in ["", "[1,2]\n"] {
        let lines = format!("{first}{}{}{}", object(0), others.concat(), object(1));
        let (code, answers, told) = robot.stream(&["run", "--everywhere"], lines);
        assert_eq!(code, 3, "{told}");
        let (begin, answers) = (first.lines().count(), answers.lines().collect::<Vec<_>>());
        assert_eq!(answers.len(), begin + 7, "{told}");
        for (k, what) in ["a list", "a number", "null", "a text"].iter().enumerate() {
            let message = format!("line {}: it is {what}, no object; send one JSON object a line", begin + k + 2);
            assert!(told.contains(&message), "no {message:?} in\n{told}");
            let refused: Value = serde_json::from_str(answers[begin + k + 1]).unwrap();
            assert_eq!(refused["line"], begin + k + 2);
        }
        assert!(answers.iter().all(|answer| !answer.contains(":null")), "{answers:?}");
        let clean = robot.stream(&["run", "--everywhere"], object(0) + &object(1)).1;
        assert_eq!(answers.last(), clean.lines().last().as_ref(), "refused lines change nothing");
    }
    let (code, _, told) = robot.stream(&["run"], endless);
    assert!(code == 3 && told.contains("line 1: it is longer than"), "{told}");
    // Nobody needs the column whose name is in Latin-1.
    let (code, answers, told) = robot.stream(&["run"], [b"t,q1,q2,w,\xb0C,y\n", good[0].as_slice()].concat());
    assert_eq!((code, answers.lines().count()), (0, 2), "{told}");
}

/// Training saw a wind of 10 to 90 % and q1 of ±57 degrees, which change by less than 100 degrees a second.
#[test]
fn what_training_did_not_see_is_said() {
    let robot = Robot::new();
    robot.learn(false);
    let ask = |arguments: &[&str]| {
        let lines = "0,0,0,50\n0.1,0.5,0,50\n0.2,1,0,95\n0.3,1000,0,50\n0.4,1000,0,50\n9,1,0,50\n9.1,50,0,50\n";
        let (code, answers, told) = robot.stream(arguments, format!("t,q1,q2,w\n{lines}"));
        assert_eq!(code, 0, "{told}");
        cells(&answers).iter().map(|cells| cells[6] == 1.0).collect::<Vec<_>>()
    };
    // The wind, the angle, the angle again, and in the end its rate.
    assert_eq!(ask(&["run", "--everywhere"]), [true, true, false, false, false, true, false]);
    assert_eq!(ask(&["run"]), [true, true, false, false, false, true, false]);
    let (code, _, told) = robot.stream(&["run", "--save", "robot.json"], "");
    assert_eq!(code, 0, "{told}");
    let parts = Parts::from_json(&fs::read(robot.path("robot.json")).unwrap()).unwrap();
    let ranges = parts.ranges.expect("what was saved has ranges");
    assert_eq!(ranges.len(), 3);
    assert!(ranges[0].high < 57.1_f64.to_radians() && ranges[0].high > 50_f64.to_radians(), "{ranges:?}");
    assert!(ranges[1].high < 0.7 * 60_f64.to_radians() * 1.3 && ranges[1].low < -0.3, "{ranges:?}");
    assert!(ranges[2].low >= 0.1 && ranges[2].high <= 0.9, "{ranges:?}");
}
