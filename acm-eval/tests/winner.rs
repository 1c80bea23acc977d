//! `acm-eval stream` on the winner of a study of the best model, which is trained here. Oracle: the predictions that the winner
//! was scored with.

#[allow(dead_code)]
mod formulas;

use std::fs;

use acm_eval::run::predictions::{HELD_OUT, Predictions};
use acm_stream::{Average, AverageParts};
use acm_train::{
    run::{evaluation::intervals, progress::Progress, stop::Stop},
    schedule::{
        request::Request,
        study::{self, best},
    },
};
use formulas::{Robot, TRIALS, self_test, table};

const BEST: &str = r#"
study    = "best"
question = "Which model shall I use?"
[[base]]
name       = "wind"
experiment = "gru.toml"
set.inputs.channels = ["w"]
[[base]]
name       = "motion"
experiment = "gru.toml"
set.inputs.channels = ["q1", "rate(q1)", "q2"]
[set]
protocol.seeds = [1, 2]
training       = { epochs = 30, learning_rate = 1e-2, patience = 0 }
"#;

/// Cells of all answers to CSV; true is 1, an empty cell no number.
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

/// The winner of a study answers as it was scored: the mean over its members and seeds, networks of other channels among them, or the
/// loop's model alone.
#[test]
fn the_winner_of_a_study_is_answered_as_it_was_scored() {
    for (name, more) in [("best", ""), ("upon", "[best]\nloop = \"model.json\"\naverage = 1\n")] {
        let robot = Robot::new();
        robot.save_model();
        robot.write("best.toml", &format!("{BEST}{more}"));
        let source = acm_train::config::Source::read(&robot.path("best.toml"), &[]).unwrap();
        let (out, progress, stop) = (robot.path(name), Progress::Quiet, Stop::default());
        let request = Request::new(&out, &progress, &stop);
        let text = study::conduct(acm_train::config::Kind::Best, source, &request).unwrap();
        let record = best::record::read(&out).unwrap();
        println!("{text}");
        let intervals = intervals::read(&out).unwrap().unwrap();
        assert!(text.contains("prediction ± half-width"), "{text}");
        let (file, _) = record.winner.predictions.clone().unwrap();
        let table_of = Predictions::read(&out.join(file), &record.outputs).unwrap();
        let (mut scored, mut moved) = (0, 0.0_f64);
        for (trial, rows) in table_of.trials(HELD_OUT).into_iter().map(|rows| (rows.trial.to_string(), rows.rows)) {
            let lines = table(TRIALS.iter().position(|name| *name == trial).unwrap());
            let (code, answers, told) = robot.stream(&[name, "--windows"], &lines);
            assert_eq!(code, 0, "{told}");
            assert!(
                answers.starts_with("t,x,y,nominal_x,nominal_y,history,in_range,low_x,high_x,low_y,high_y\n"),
                "{answers}"
            );
            let answers = cells(&answers);
            for row in rows {
                let k = answers.iter().position(|cells| cells[0] == table_of.time()[row]).unwrap();
                for (o, output) in ["x", "y"].iter().enumerate() {
                    let expected = 1e3 * table_of.column("predicted", output)[row];
                    let off = (answers[k][1 + o] - expected).abs();
                    assert!(off < 1e-3, "predicted_{output} at {} s: off by {off} mm", answers[k][0]);
                    let [low, high] = [7, 8].map(|place| answers[k][place + 2 * o]);
                    let width = 1e3 * intervals.outputs[o].half_width;
                    assert!(
                        (high - answers[k][1 + o] - width).abs() < 1e-6
                            && (answers[k][1 + o] - low - width).abs() < 1e-6
                    );
                    moved = moved.max((expected - 1e3 * table_of.column("nominal", output)[row]).abs());
                }
                scored += 1;
            }
        }
        assert!(scored > 100 && moved > 0.1, "{scored} scored, at most {moved} mm beside the nominal model");
        let (code, printed, told) = robot.stream(&[name, "--save", "robot.json"], "");
        assert_eq!((code, printed.trim()), (0, "robot.json"), "{told}");
        let parts = AverageParts::from_json(&fs::read(robot.path("robot.json")).unwrap()).unwrap();
        let runs: usize = record.winner.members.iter().map(|member| if member.learned { 2 } else { 1 }).sum();
        assert_eq!(parts.members.len(), runs);
        let learned = parts.members.iter().filter(|member| member.parts.has_network()).count();
        Average::new(parts).unwrap();
        // It is exported as C from the study and from the file, and as ONNX one network at a time.
        for (given, c) in [(name, "c1"), ("robot.json", "c2")] {
            let (code, _, told) = robot.ask("export", &[given, "--c99", c, "--windows"], "");
            assert_eq!(code, 0, "{told}");
            self_test(&robot.path(c), "estimator");
        }
        let header = fs::read_to_string(robot.path("c1/estimator.h")).unwrap();
        assert!(header.contains("ESTIMATOR_OUTPUT_X = 0, /* x: m (manifest: mm;"), "{header}");
        assert_eq!(header.contains(&format!("average  of {runs} estimators")), runs > 1, "{header}");
        let (code, _, told) = robot.ask("export", &[name, "--onnx", "onnx"], "");
        assert_eq!(code, if runs == 1 && learned == 1 { 0 } else { 2 }, "{told}");
        assert_eq!(told.matches("acm-eval export").count(), if runs > 1 { learned } else { 0 }, "{told}");
        for command in told.split('`').filter(|part| part.starts_with("acm-eval export")) {
            let arguments: Vec<&str> = command.split(' ').skip(2).collect();
            let (code, _, told) = robot.ask("export", &arguments, "");
            assert_eq!(code, 0, "{command}: {told}");
        }
        let page = assert_cmd::Command::new(assert_cmd::cargo::cargo_bin!("acm-eval"))
            .current_dir(robot.folder.path())
            .args(["report", name, "--out", "page"])
            .output()
            .unwrap();
        assert_eq!(page.status.code(), Some(0), "{}", String::from_utf8_lossy(&page.stderr));
        let page = fs::read_to_string(robot.path("page/report.html")).unwrap();
        assert!(
            page.contains("Which model to use")
                && page.contains("How far off the winner may be")
                && page.contains(&record.chosen().name()),
            "{page}"
        );
    }
}
