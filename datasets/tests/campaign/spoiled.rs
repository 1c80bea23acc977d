//! Recordings that can be read and look spoiled: `acm-data check` warns with file, rows, columns, value and remedy, and what
//! is only unusual has no warning.

use std::ops::Range;

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
    let cell = |value: f64| if value.is_nan() { String::new() } else { value.to_string() };
    let line = |row: &Row| row.map(cell).join(",") + "\n";
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

/// Keeps the first of some samples in all of them, in some columns.
fn hold(rows: &mut [Row], samples: Range<usize>, columns: Range<usize>) {
    let held = rows[samples.start];
    rows[samples].iter_mut().for_each(|row| row[columns.clone()].copy_from_slice(&held[columns.clone()]));
}

/// What spoils trial `a`, and for each warning what it contains.
type Case = (&'static str, fn(&mut Vec<Row>), &'static [&'static [&'static str]]);

const CASES: &[Case] = &[
    (
        "an outlier",
        |rows| rows[310][4] += 5000.0,
        &[&[
            "run_a.csv, row 312, column `y` of trial `a`",
            " m stands alone, 4.99",
            " m away from the samples around",
            "correct the cell",
        ]],
    ),
    (
        "an outlier of all columns",
        |rows| (3..6).for_each(|axis| rows[100][axis] -= 700.0),
        &[&["row 102, columns `x`, `y`, `z` of trial `a`"]],
    ),
    (
        "three outliers",
        |rows| [20, 21, 400].into_iter().for_each(|i| rows[i][3] = 2000.0),
        &[&["run_a.csv, rows 22, 23, 402, column `x`", "2.0000 m and others stand alone"]],
    ),
    (
        "a frozen marker",
        |rows| hold(rows, 200..350, 3..6),
        &[&[
            "run_a.csv, rows 202 to 351, columns `x`, `y`, `z` of trial `a`",
            "150 samples in a row are exactly",
            "while the actuators move",
            "leave these cells empty",
        ]],
    ),
    (
        "a frozen axis",
        |rows| hold(rows, 200..350, 5..6),
        &[&["run_a.csv, rows 202 to 351, column `z` of trial `a`: 150 samples in a row are exactly -0."]],
    ),
    (
        "a lost marker written as 0",
        |rows| [60, 61, 62, 63, 64, 420].into_iter().for_each(|i| rows[i][3..].fill(0.0)),
        &[&[
            "run_a.csv, rows 62 to 66, 422, columns `x`, `y`, `z` of trial `a`",
            "exactly 0 in 6 samples, and 0.",
            "if the marker was lost, leave these cells empty",
        ]],
    ),
    (
        "a marker lost for long and written as 0",
        |rows| rows[100..250].iter_mut().for_each(|row| row[3..].fill(0.0)),
        &[&["rows 102 to 251", "exactly 0 in 150 samples"]],
    ),
    // rows of lost markers are counted
    (
        "all at once, below a lost marker",
        |rows| {
            rows[10][5] = f64::NAN;
            rows[50][4] += 5000.0;
            rows[100][3..].fill(0.0);
            hold(rows, 300..450, 3..6);
        },
        &[&["row 102, columns"], &["rows 302 to 451, columns"], &["row 52, column `y`"]],
    ),
    ("nothing", |_| (), &[]),
    (
        "coarse quanta",
        |rows| rows.iter_mut().flat_map(|row| &mut row[3..]).for_each(|v| *v = (*v / 10.0).round() * 10.0),
        &[],
    ),
    (
        "steps of the actuators",
        |rows| rows.iter_mut().for_each(|row| row[1] = if row[1] > 5.0 { 20.0 } else { -20.0 }),
        &[],
    ),
    ("a step of the output", |rows| rows[300..].iter_mut().for_each(|row| row[3] += 200.0), &[]),
    ("a robot at rest", |rows| hold(rows, 200..350, 1..6), &[]),
    (
        "an output at rest in every second second",
        |rows| [10, 100, 300, 500].into_iter().for_each(|start| hold(rows, start..start + 60, 3..6)),
        &[],
    ),
    (
        "a marker that passes its origin",
        |rows| rows.iter_mut().for_each(|row| (row[3], row[4], row[5]) = (row[3].round(), 0.0, 0.0)),
        &[],
    ),
];

#[track_caller]
fn warned(name: &str, set: &Set, expected: &[&[&str]]) {
    let (code, warnings, text) = check(set);
    assert_eq!((code, warnings.len()), (0, expected.len()), "{name}: {text}");
    for (warning, parts) in warnings.iter().zip(expected) {
        for part in *parts {
            assert!(warning.contains(part), "{name}: {part:?} in\n{warning}");
        }
    }
}

#[test]
fn what_looks_spoiled_has_a_warning_and_what_is_only_unusual_has_none() {
    for (name, spoil, expected) in CASES {
        warned(name, &spoiled(spoil), expected);
    }
}

/// Each part of a trial that is cut has the rows of the file; what is excluded has no warning.
#[test]
fn roles_decide_which_samples_are_checked() {
    let (outlier, development) =
        (|rows: &mut Vec<Row>| rows[310][4] += 5000.0, "development = [\"a\"]\nheld_out = [\"b\"]");
    let set = spoiled(outlier);
    set.edit("manifest.toml", development, "development = [\"b\"]\nexcluded = [\"a\"]");
    warned("an excluded trial", &set, &[]);
    let set = spoiled(outlier);
    let cut =
        "held_out = [\"b\"]\n[cut.a]\nhead = { until = 2.0, role = \"excluded\" }\ntail = { role = \"development\" }";
    set.edit("manifest.toml", development, cut);
    warned("a cut", &set, &[&["run_a.csv, row 312, column `y` of trial `a:tail`"]]);
}

/// No byte of a set from somebody else moves the cursor: names of files and of trials are shown as they are not printed.
#[cfg(unix)]
#[test]
fn no_control_character_reaches_the_terminal() {
    let shown = |set: &Set, code: i32, words: &str| {
        let (found, _, text) = check(set);
        assert!(found == code && text.contains(words), "{found}: {text}");
        assert!(!text.contains(|c: char| c.is_control() && c != '\n'), "{text:?}");
    };
    let set = spoiled(|_| ());
    std::fs::copy(set.file("run_b.csv"), set.file("run_c\u{1b}[31m.csv")).expect("copied");
    shown(&set, 3, "the name of the file `run_c\\u{1b}[31m.csv` has control characters; rename the file");
    std::fs::rename(set.file("run_c\u{1b}[31m.csv"), set.file("other\u{1b}[31m.csv")).expect("renamed");
    shown(&set, 0, "no pattern matches other\\u{1b}[31m.csv");
    let named = spoiled(|_| ());
    named.edit("manifest.toml", "{ file = \"run_(.*)\" }", "{ column = \"run\" }");
    named.edit("manifest.toml", "run_*", "run_a*");
    let text = csv(&rows(0)).replace('\n', ",a\u{1b}]0;x\u{7}\n").replacen("a\u{1b}]0;x\u{7}", "run", 1);
    named.write("run_a.csv", &text);
    let place =
        "run_a.csv, row 2: the trial's name `a\\u{1b}]0;x\\u{7}` in column `run` has control characters; give it";
    shown(&named, 3, place);
    let header = spoiled(|_| ());
    header.edit("run_a.csv", "t,q1,q2,x,y,z", "t,q1,q2,x,y,z\u{1b}[2J");
    shown(&header, 3, "column `z` is missing");
}
