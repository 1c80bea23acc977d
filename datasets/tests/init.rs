//! Folders as people have them, each through `init` and then opened with its draft. Oracle: the folder as it was made, by hand.

#![allow(missing_docs)]

#[path = "../examples/own_recordings.rs"]
#[allow(dead_code)] // the example's main
mod own_recordings;

use std::fmt::Write;
use std::path::Path;

use acm_datasets::recordings::{Options, Recordings};
use acm_datasets::{DataError, init};
use own_recordings::{ROWS, csv, german, motion, numbers, one_parquet, parquet, write};

/// What a folder is, and what its draft must be.
struct Case {
    name: &'static str,
    make: fn(&Path),
    /// Lines of the draft, and parts of lines that it must not have.
    draft: &'static [&'static str],
    not: &'static [&'static str],
    /// Trials, and what an opened set holds, as actuators > outputs; or parts of the message.
    opened: Result<(&'static [&'static str], &'static str), &'static [&'static str]>,
}

/// Plain trials `t`, `q`, `x`.
fn plain(folder: &Path, names: &[&str]) {
    for (trial, name) in names.iter().enumerate() {
        write(folder, name, &csv("t,q,x", trial, |_, [t, q, x]| format!("{t},{q},{x}")));
    }
}

fn lerobot(folder: &Path) {
    for trial in 0..3 {
        let columns = vec![
            ("timestamp", numbers(trial..trial + 1, |trial, row| motion(trial, row)[0])),
            ("frame_index", numbers(trial..trial + 1, |_, row| row as f64)),
            ("episode_index", numbers(trial..trial + 1, |trial, _| trial as f64)),
            ("task_index", numbers(trial..trial + 1, |_, _| 0.0)),
            ("action", numbers(trial..trial + 1, |trial, row| motion(trial, row)[1])),
            ("observation.state", numbers(trial..trial + 1, |trial, row| motion(trial, row)[2])),
        ];
        parquet(folder, &format!("data/chunk-000/episode_{trial:06}.parquet"), columns);
    }
    write(folder, "meta/info.json", "{}");
}

/// A column of dates that Parquet has a type for.
fn stamps(folder: &Path) {
    let _ = std::fs::copy("tests/parquet/types.parquet", folder.join("types.parquet")).expect("copied");
}

fn motive(trial: usize) -> String {
    let mut text = String::from(
        "Format Version,1.23,Take Name,x,Capture Frame Rate,50,Export Frame Rate,50,Rotation Type,Quaternion,Length Units,Millimeters\n\n\
         ,,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body\n\
         ,,Tip,Tip,Tip,Tip,Tip,Tip,Tip\n,,1,1,1,1,1,1,1\n\
         ,,Rotation,Rotation,Rotation,Rotation,Position,Position,Position\n\
         Frame,Time (Seconds),X,Y,Z,W,X,Y,Z\n",
    );
    for row in 0..3 * ROWS {
        let [t, q, x] = motion(trial, row);
        let _ = writeln!(text, "{row},{t},0,0,0,1,{},{},{}", 1000.0 * x, 300.0 - 40.0 * q * q, 5.0);
    }
    text
}

fn two_clocks(folder: &Path) {
    for (trial, name) in ["a", "b", "c"].iter().enumerate() {
        write(folder, &format!("{name}_mocap.csv"), &motive(trial));
        let rows: String =
            (0..3 * ROWS).map(|k| motion(trial, k)).map(|[t, q, _]| format!("{},{q}\n", t + 7.25)).collect();
        write(folder, &format!("{name}_motors.csv"), &format!("time_s,q_rad\n{rows}"));
    }
}

fn shared_log(folder: &Path) {
    let mut log = String::from("t;motor_1;pwm\n");
    for (trial, name) in ["1", "2", "3"].iter().enumerate() {
        let rows: String =
            (0..3 * ROWS).map(|k| motion(trial, k)).map(|[t, _, x]| format!("{t},{x},{}\n", x * x)).collect();
        write(folder, &format!("marker_{name}.csv"), &format!("t,x,z\n{rows}"));
        for row in 0..3 * ROWS {
            let [t, q, _] = motion(trial, row);
            let _ = writeln!(log, "{:.3};{q};{}", 30.0 * trial as f64 + t + 5.0, 12.0 + 0.1 * t.sin());
        }
    }
    write(folder, "log.csv", &log);
}

fn trc(folder: &Path) {
    for (trial, name) in ["walk1", "walk2"].iter().enumerate() {
        let mut text = String::from(
            "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n50\t50\t250\t2\tmm\n\
             Frame#\tTime\tBase\t\t\tTip\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n",
        );
        for row in 0..ROWS {
            let [t, q, x] = motion(trial, row);
            let _ = writeln!(
                text,
                "{}\t{t}\t{q}\t0.5\t{}\t{}\t{}\t{}",
                row + 1,
                x * x,
                1000.0 * x,
                100.0 * q,
                30.0 * q * x
            );
        }
        write(folder, &format!("{name}.trc"), &text);
    }
}

fn cases() -> Vec<Case> {
    vec![
        Case {
            name: "trials with a decimal comma and a row of units",
            make: german,
            draft: &[
                "[table]",
                "files  = [\"run_*.csv\"]",
                "trial  = { file = \"run_(.*)\" }",
                "time   = { column = \"Zeit\", unit = \"ms\" }",
            ],
            not: &["[[source]]", "# is this its unit"],
            opened: Ok((&["a", "b", "c", "d", "e"], "Winkel rad > Weg mm")),
        },
        Case {
            name: "one Parquet file with a column of trials",
            make: one_parquet,
            draft: &[
                "trial  = { column = \"take\" }   # does it name the trials?",
                "# not used: \"mode\", always 4",
                "held_out    = [\"take2\"]",
                "# column = \"load\"",
            ],
            not: &["file = "],
            opened: Ok((&["take0", "take1", "take2"], "cmd 1 > tip_mm mm")),
        },
        Case {
            name: "episodes as LeRobot writes them",
            make: lerobot,
            draft: &[
                "files  = [\"data/chunk-000/episode_*.parquet\"]",
                "trial  = { file = \"episode_(.*)\" }",
                "# not used: \"frame_index\", it counts",
                "time   = { column = \"timestamp\", unit = \"s\" }   # is this its unit?",
            ],
            not: &[],
            opened: Ok((&["000000", "000001", "000002"], "action 1 > observation.state 1")),
        },
        Case {
            name: "types of Parquet",
            make: stamps,
            draft: &["trial  = { column = \"run_text\" }"],
            not: &[],
            opened: Err(&["types.parquet: trial `a` has 30 samples in one stretch"]),
        },
        Case {
            name: "two files with two clocks",
            make: two_clocks,
            draft: &[
                "name   = \"mocap\"",
                "name   = \"motors\"",
                "trial  = { file = \"(.*)_mocap\" }",
                "time   = { column = \"time_s\", unit = \"s\" }",
                "by = [\"mocap.Tip.Position.X\", \"motors.q_rad\"]",
            ],
            not: &["[table]"],
            opened: Ok((&["a", "b", "c"], "motors.q_rad rad > mocap.Tip.Position.X mm, mocap.Tip.Position.Y mm")),
        },
        Case {
            name: "one log of all trials",
            make: shared_log,
            draft: &["shared = true   # does this one file hold all trials?", "trial  = { file = \"marker_(.*)\" }"],
            not: &[],
            opened: Ok((&["1", "2", "3"], "log.motor_1 1, log.pwm 1 > marker.x 1, marker.z 1")),
        },
        Case {
            name: "markers as TRC",
            make: trc,
            draft: &[
                "format = \"trc\"",
                "clock  = \"reference\"   # its samples are those of the trials",
                "# not used: \"trc.Base.Y\", always 0.5",
            ],
            not: &["time "],
            opened: Ok((
                &["walk1", "walk2"],
                "trc.Base.X mm, trc.Base.Z mm > trc.Tip.X mm, trc.Tip.Y mm, trc.Tip.Z mm",
            )),
        },
        Case {
            name: "Zeit in ms without a unit",
            make: |folder| {
                for name in ["a", "b"] {
                    let trial = usize::from(name == "b");
                    write(
                        folder,
                        &format!("{name}.csv"),
                        &csv("Zeit,q,x", trial, |_, [t, q, x]| format!("{},{q},{x}", 1000.0 * t)),
                    );
                }
            },
            draft: &["time   = { column = \"Zeit\", unit = \"ms\" }   # is this its unit?", "files  = [\"*.csv\"]"],
            not: &["trial  ="],
            opened: Ok((&["a", "b"], "q 1 > x 1")),
        },
        Case {
            name: "T is a temperature",
            make: |folder| {
                let row = |k: usize, [t, q, x]: [f64; 3]| format!("{},{t},{q},{x},{}", k, 20.0 + q);
                write(folder, "run.csv", &csv("n,clock [s],u [V],x (mm),T", 0, row));
            },
            draft: &[
                "time   = { column = \"clock [s]\", unit = \"s\" }",
                "# column = \"T\"",
                "# not used: \"n\", it counts",
                "name   = \"x\"",
            ],
            not: &["\"T\", unit"],
            opened: Ok((&["run"], "u [V] V > x (mm) mm")),
        },
        Case {
            name: "no column of time",
            make: |folder| write(folder, "a.csv", &csv("ref,meas", 0, |_, [_, q, x]| format!("{q},{x}"))),
            draft: &["time   = { rate_hz = 100.0 }   # no column looks like time: what is the rate?"],
            not: &[],
            opened: Ok((&["a"], "ref 1 > meas 1")),
        },
        Case {
            name: "time by its even steps alone",
            make: |folder| write(folder, "a.csv", &csv("col1,col2,col3", 0, |_, [t, q, x]| format!("{t},{q},{x}"))),
            draft: &["time   = { column = \"col1\", unit = \"s\" }   # is this its unit?"],
            not: &[],
            opened: Ok((&["a"], "col2 1 > col3 1")),
        },
        Case {
            name: "time that stands still",
            make: |folder| {
                write(folder, "a.csv", &csv("t,q,x", 0, |k, [_, q, x]| format!("{},{q},{x}", k - k % 10 / 9)));
            },
            draft: &["time   = { column = \"t\", unit = \"s\" }   # is this its unit?"],
            not: &[],
            opened: Err(&["a.csv, row 11, column `t`"]),
        },
        Case {
            name: "stray files",
            make: |folder| {
                plain(folder, &["run_a.csv", "run_b.csv", "run_c.csv"]);
                write(folder, "README.md", "# What this is");
                write(folder, "notes.txt", "nothing, of interest\nhere, at all\n");
                write(folder, "photo.png", "\u{1}\u{2}");
                write(folder, "gains.csv", "joint,kp\n1,2.5\n2,3.5\n");
                write(folder, "run_d.csv", "t,q,x\n");
                write(folder, "run_e.csv", "t,q,x\n0,1,\"2\n");
            },
            draft: &[
                "files  = [\"run_a.csv\", \"run_b.csv\", \"run_c.csv\"]",
                "ignore = [\"gains.csv\", \"run_d.csv\", \"run_e.csv\"]",
                "# \"run_d.csv\" is left out: it has no rows of data",
                "# \"run_e.csv\" is left out: row 2: a quotation mark is opened in column",
            ],
            not: &["README", "png"],
            opened: Ok((&["a", "b", "c"], "q 1 > x 1")),
        },
        Case {
            name: "names with digits, blanks, dots and quotes",
            make: |folder| {
                plain(
                    folder,
                    &["1.csv", "2.csv", "10.csv", "my [first] run.v2.csv", "the \"last\" one.csv", "a:b.csv", "~c.csv"],
                );
            },
            draft: &["held_out    = [\"~c\"]"],
            not: &[],
            opened: Ok((&["1", "2", "10", "a:b", "my [first] run.v2", "the \"last\" one", "~c"], "q 1 > x 1")),
        },
        Case {
            name: "hostile columns",
            make: |folder| {
                let header = "t,\"a, 'b'\",x[0],,x,x,note\u{7}";
                write(folder, "a.csv", &csv(header, 0, |_, [t, q, x]| format!("{t},{q},{x},{q},{x},{q},{x}")));
            },
            draft: &[
                "# not used: \"\", a column without a name: give it one in the header",
                "# not used: \"x\", the header has it twice: rename one",
                "# not used: \"note\\u0007\", its name has control characters: rename it",
            ],
            not: &[],
            opened: Ok((&["a"], "a, 'b' 1 > x[0] 1")),
        },
        Case {
            name: "one more column in one file",
            make: |folder| {
                plain(folder, &["run_a.csv", "run_b.csv"]);
                write(folder, "run_c.csv", &csv("t,q,x,hall", 2, |_, [t, q, x]| format!("{t},{q},{x},{q}")));
            },
            draft: &["files  = [\"run_*.csv\"]", "# not used: \"hall\", 1 of 3 files have it"],
            not: &[],
            opened: Ok((&["a", "b", "c"], "q 1 > x 1")),
        },
        Case {
            name: "angles and counters",
            make: |folder| {
                let row = |k: usize, [t, q, x]: [f64; 3]| {
                    let turn = 360.0 * t + 90.0 * q;
                    format!("{t},{},{},{x}", (turn + 180.0).rem_euclid(360.0) - 180.0, (k * 2000) % 65536)
                };
                for name in ["run_a.csv", "run_b.csv"] {
                    write(folder, name, &csv("t,motor angle,motor ticks,x", usize::from(name == "run_b.csv"), row));
                }
            },
            draft: &[
                "angles = [\"motor angle\"]   # each jumps by a full turn",
                "counters = { \"motor ticks\" = 65536 }   # each starts again after so many",
            ],
            not: &[],
            opened: Ok((&["a", "b"], "motor angle deg, motor ticks 1 > x 1")),
        },
    ]
}

/// What does not hold.
fn wrong(case: &Case) -> Option<String> {
    let folder = tempfile::tempdir().expect("a folder");
    (case.make)(folder.path());
    let draft = match init::manifest(folder.path()) {
        Ok(draft) => draft,
        Err(error) => return Some(format!("no draft: {error}")),
    };
    let lacking: Vec<_> = case.draft.iter().filter(|line| !draft.contains(**line)).collect();
    let surplus: Vec<_> = case.not.iter().filter(|part| draft.contains(**part)).collect();
    std::fs::write(folder.path().join("manifest.toml"), &draft).expect("written");
    let opened = Recordings::open(folder.path(), None, &Options { window: Some(50), ..Options::default() });
    let opened = match (opened.map(|set| summary(&set)), &case.opened) {
        (Ok(found), Ok((trials, signals))) if found.0 == *trials && found.1 == *signals => None,
        (Err(error), Err(parts)) if parts.iter().all(|part| error.to_string().contains(part)) => None,
        (Ok(found), _) => Some(format!("holds {found:?}")),
        (Err(error), _) => Some(format!("refused: {error}")),
    };
    let right = lacking.is_empty() && surplus.is_empty() && opened.is_none();
    (!right)
        .then(|| format!("{}: lacks {lacking:?}, has {surplus:?}, {}\n{draft}", case.name, opened.unwrap_or_default()))
}

/// Trials, and actuators > outputs with their units.
fn summary(set: &Recordings) -> (Vec<String>, String) {
    let of =
        |list: Vec<(&String, &String)>| list.iter().map(|(c, u)| format!("{c} {u}")).collect::<Vec<_>>().join(", ");
    let actuators = of(set.manifest.actuator.iter().map(|signal| (&signal.column, &signal.unit)).collect());
    let measured = of(set.manifest.measured.iter().map(|signal| (&signal.column, &signal.unit)).collect());
    (set.entries.iter().map(|entry| entry.name.clone()).collect(), format!("{actuators} > {measured}"))
}

#[test]
fn each_folder_has_a_draft_that_is_accepted_or_says_what_is_wrong() {
    let failures: Vec<String> = cases().iter().filter_map(wrong).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n---\n"));
}

#[test]
fn a_folder_without_recordings_is_refused_with_the_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), "run_a.csv", "t,q,x\n");
    let error = init::manifest(folder.path()).map(|_| ()).expect_err("nothing to read");
    assert!(matches!(error, DataError::Usage(_)), "{error}");
    assert!(error.to_string().contains("run_a.csv: it has no rows of data"), "{error}");
    assert_eq!(init::manifest(&folder.path().join("none")).map(|_| ()).expect_err("no folder").exit_code(), 4);
}

#[test]
fn the_recordings_of_the_tutorial_are_those_of_the_example() {
    let folder = tempfile::tempdir().expect("a folder");
    german(&folder.path().join("csv"));
    one_parquet(&folder.path().join("parquet"));
    for name in ["csv/run_a.csv", "csv/run_e.csv", "parquet/log.parquet"] {
        let (made, kept) =
            (std::fs::read(folder.path().join(name)), std::fs::read(Path::new("own-recordings").join(name)));
        assert_eq!(made.expect("made"), kept.expect("kept"), "{name}: make it again by the example own_recordings");
    }
}
