//! Recordings that can be read and look spoiled: `acm-data check` warns with file, rows, columns, value and remedy, and what
//! is only unusual has no warning.

use assert_cmd::Command;

use super::set::Set;

const MANIFEST: &str = r#"
name = "arm"
[table]
files = ["run_*.csv"]
trial = { file = "run_(.*)" }
time = { column = "t", unit = "s" }
[[actuator]]
column = "q1"
unit = "deg"
[[actuator]]
column = "q2"
unit = "deg"
[[measured]]
column = "x"
unit = "mm"
[[measured]]
column = "y"
unit = "mm"
[[measured]]
column = "z"
unit = "mm"
[arm]
length = { value = 400, unit = "mm" }
[roles]
development = ["a"]
held_out = ["b"]
"#;

/// Samples of a trial.
const COUNT: usize = 600;

/// Columns t, q1, q2, x, y, z.
type Row = [f64; 6];

/// Even noise in −0.5 to 0.5.
fn noise(k: usize) -> f64 {
    ((k as u64 * 2_654_435_761 + 12_345) % 10_007) as f64 / 10_007.0 - 0.5
}

/// An arm that two actuators move, under a motion capture of 0.1 mm.
fn rows(seed: usize) -> Vec<Row> {
    let one = |i: usize| {
        let t = 0.01 * i as f64;
        let (a, b) = ((1.9 * t + seed as f64).sin(), (1.3 * t + 2.0 * seed as f64).cos());
        let marker = |axis: usize, at: f64| at + 0.1 * noise(3 * i + axis + 5000 * seed);
        [t, 20.0 * a, 30.0 * b, marker(0, 90.0 * a), marker(1, 120.0 * b), marker(2, -380.0 + 30.0 * a * b)]
    };
    (0..COUNT).map(one).collect()
}

fn csv(rows: &[Row]) -> String {
    let line = |row: &Row| row.map(|value| value.to_string()).join(",") + "\n";
    "t,q1,q2,x,y,z\n".to_string() + &rows.iter().map(line).collect::<String>()
}

/// The set with trial `a` spoiled.
fn spoiled(spoil: impl FnOnce(&mut Vec<Row>)) -> Set {
    let set = Set::new();
    for name in ["a", "b", "c", "d"] {
        std::fs::remove_file(set.file(&format!("run_{name}.csv"))).expect("removed");
    }
    let mut all = rows(0);
    spoil(&mut all);
    set.write("manifest.toml", MANIFEST).write("run_a.csv", &csv(&all)).write("run_b.csv", &csv(&rows(1)));
    set
}

/// Exit code, warnings and everything that was printed.
fn check(set: &Set) -> (i32, Vec<String>, String) {
    let output = Command::cargo_bin("acm-data").expect("acm-data").arg("check").arg(set.path()).output().expect("runs");
    let text = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
    let warnings = text.lines().filter(|line| line.starts_with("warning: ")).map(str::to_string).collect();
    (output.status.code().unwrap_or(-1), warnings, text)
}

#[track_caller]
fn warned(set: &Set, expected: &[&str]) {
    let (code, warnings, text) = check(set);
    assert_eq!((code, warnings.len()), (0, 1), "{text}");
    for part in expected {
        assert!(warnings[0].contains(part), "{part:?} in\n{}", warnings[0]);
    }
}

#[track_caller]
fn silent(what: &str, set: &Set) {
    let (code, warnings, text) = check(set);
    assert_eq!((code, warnings.len()), (0, 0), "{what}: {text}");
}

#[test]
fn a_single_outlier_is_told_in_its_row() {
    let one = spoiled(|rows| rows[310][4] += 5000.0);
    let expected = [
        "run_a.csv, row 312, column `y` of trial `a`",
        "m stands alone, ",
        "m away from the samples around",
        "correct the cell",
    ];
    warned(&one, &expected);
    let (_, warnings, _) = check(&one);
    let away: f64 = warnings[0]
        .split("stands alone, ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next())
        .map_or(0.0, |v| v.parse().unwrap_or(0.0));
    assert!((away - 5.0).abs() < 0.05, "{warnings:?}");
    let jump = spoiled(|rows| (3..6).for_each(|axis| rows[100][axis] -= 700.0));
    warned(&jump, &["row 102, columns `x`, `y`, `z` of trial `a`"]);
    let three = spoiled(|rows| [20, 21, 400].into_iter().for_each(|i| rows[i][3] = 2000.0));
    warned(&three, &["run_a.csv, rows 22, 23, 402, column `x`", "2.0000 m and others stand alone"]);
}

#[test]
fn a_frozen_stretch_is_told_with_its_rows() {
    let marker = spoiled(|rows| {
        let held = rows[200];
        rows[200..350].iter_mut().for_each(|row| row[3..].copy_from_slice(&held[3..]));
    });
    let expected = [
        "run_a.csv, rows 202 to 351, columns `x`, `y`, `z` of trial `a`",
        "150 samples in a row are exactly",
        "while the actuators move",
        "leave these cells empty",
    ];
    warned(&marker, &expected);
    let axis = spoiled(|rows| {
        let held = rows[200][5];
        rows[200..350].iter_mut().for_each(|row| row[5] = held);
    });
    warned(&axis, &["run_a.csv, rows 202 to 351, column `z` of trial `a`: 150 samples in a row are exactly -0."]);
}

#[test]
fn markers_that_are_written_as_0_are_told() {
    let lost = spoiled(|rows| [60, 61, 62, 63, 64, 420].into_iter().for_each(|i| rows[i][3..].fill(0.0)));
    let expected = [
        "run_a.csv, rows 62 to 66, 422, columns `x`, `y`, `z` of trial `a`",
        "exactly 0 in 6 samples, and 0.",
        "if the marker was lost, leave these cells empty",
    ];
    warned(&lost, &expected);
    let long = spoiled(|rows| rows[100..250].iter_mut().for_each(|row| row[3..].fill(0.0)));
    warned(&long, &["rows 102 to 251", "exactly 0 in 150 samples"]);
}

/// Everything at once, and the rows of lost markers are skipped in the count.
#[test]
fn all_that_looks_spoiled_is_told_at_once() {
    let set = spoiled(|rows| {
        rows[50][4] += 5000.0;
        rows[100][3..].fill(0.0);
        let held = rows[300];
        rows[300..450].iter_mut().for_each(|row| row[3..].copy_from_slice(&held[3..]));
    });
    let text = std::fs::read_to_string(set.file("run_a.csv")).expect("read");
    let line = text.lines().nth(11).expect("row 12");
    set.edit("run_a.csv", line, &(line[..line.rfind(',').expect("a comma")].to_string() + ","));
    let (_, warnings, text) = check(&set);
    assert_eq!(warnings.len(), 3, "{text}");
    for (warning, place) in warnings.iter().zip(["row 102, columns", "rows 302 to 451, columns", "row 52, column `y`"])
    {
        assert!(warning.contains(place), "{place} in {warning}");
    }
}

#[test]
fn what_is_only_unusual_has_no_warning() {
    silent("as it is", &spoiled(|_| ()));
    silent(
        "coarse quanta",
        &spoiled(|rows| {
            rows.iter_mut().for_each(|row| row[3..].iter_mut().for_each(|v| *v = (*v / 10.0).round() * 10.0));
        }),
    );
    silent(
        "steps of the actuators",
        &spoiled(|rows| rows.iter_mut().for_each(|row| row[1] = if row[1] > 5.0 { 20.0 } else { -20.0 })),
    );
    silent("a step of the output", &spoiled(|rows| rows[300..].iter_mut().for_each(|row| row[3] += 200.0)));
    silent(
        "a robot at rest",
        &spoiled(|rows| {
            let rest = rows[200];
            for row in &mut rows[200..350] {
                row[1..].copy_from_slice(&rest[1..]);
            }
        }),
    );
    silent(
        "an output at rest in every second second",
        &spoiled(|rows| {
            for start in [100, 300, 500] {
                let rest = rows[start];
                rows[start..start + 60].iter_mut().for_each(|row| row[3..].copy_from_slice(&rest[3..]));
            }
            let rest = rows[10];
            rows[10..70].iter_mut().for_each(|row| row[3..].copy_from_slice(&rest[3..]));
        }),
    );
    silent(
        "a marker that passes its origin",
        &spoiled(|rows| {
            rows.iter_mut().for_each(|row| {
                row[4] = 0.0;
                row[5] = 0.0;
                row[3] = row[3].round();
            });
        }),
    );
    let excluded = spoiled(|rows| rows[310][4] += 5000.0);
    excluded.edit("manifest.toml", "development = [\"a\"]", "development = [\"b\"]").edit(
        "manifest.toml",
        "held_out = [\"b\"]",
        "excluded = [\"a\"]",
    );
    silent("an excluded trial", &excluded);
}

/// Of a trial that is cut, each part has its own rows.
#[test]
fn a_part_of_a_trial_has_the_rows_of_the_file() {
    let set = spoiled(|rows| rows[310][4] += 5000.0);
    set.edit("manifest.toml", "development = [\"a\"]\n", "").edit(
        "manifest.toml",
        "[roles]",
        "[cut.a]\nhead = { until = 2.0, role = \"excluded\" }\ntail = { role = \"development\" }\n[roles]",
    );
    warned(&set, &["run_a.csv, row 312, column `y` of trial `a:tail`"]);
}

/// No byte of a set from somebody else moves the cursor: names of files and of trials are shown as they are not printed.
#[cfg(unix)]
#[test]
fn no_control_character_reaches_the_terminal() {
    let clean = |text: &str| assert!(!text.contains(|c: char| c.is_control() && c != '\n'), "{text:?}");
    let set = spoiled(|_| ());
    std::fs::copy(set.file("run_b.csv"), set.file("run_c\u{1b}[31m.csv")).expect("copied");
    let (code, _, text) = check(&set);
    assert_eq!(code, 3, "{text}");
    assert!(
        text.contains("the name of the file `run_c\\u{1b}[31m.csv` has control characters; rename the file"),
        "{text}"
    );
    clean(&text);
    std::fs::rename(set.file("run_c\u{1b}[31m.csv"), set.file("other\u{1b}[31m.csv")).expect("renamed");
    let (code, _, text) = check(&set);
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("no pattern matches other\\u{1b}[31m.csv"), "{text}");
    clean(&text);
    let named = spoiled(|_| ());
    named.edit("manifest.toml", "{ file = \"run_(.*)\" }", "{ column = \"run\" }").edit(
        "manifest.toml",
        "run_*",
        "run_a*",
    );
    let text = csv(&rows(0))
        .lines()
        .enumerate()
        .map(|(i, line)| format!("{line},{}\n", if i == 0 { "run" } else { "a\u{1b}]0;x\u{7}" }))
        .collect::<String>();
    named.write("run_a.csv", &text);
    let (code, _, text) = check(&named);
    assert_eq!(code, 3, "{text}");
    assert!(
        text.contains(
            "run_a.csv, row 2: the trial's name `a\\u{1b}]0;x\\u{7}` in column `run` has control characters; give it"
        ),
        "{text}"
    );
    clean(&text);
    let header = spoiled(|_| ());
    header.edit("run_a.csv", "t,q1,q2,x,y,z", "t,q1,q2,x,y,z\u{1b}[2J");
    clean(&check(&header).2);
}
