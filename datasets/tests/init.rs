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

/// Parts of the draft; those behind `!` it must not have.
type Draft = &'static [&'static str];

/// Trials, and what an opened set holds, as actuators > outputs; or a part of the message.
type Opened = Result<(&'static [&'static str], &'static str), &'static str>;

/// A folder: what it is, its files, the draft, and what an opened set holds.
type Case = (&'static str, fn(&Path), Draft, Opened);

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
            let (z, [tx, ty, tz]) = (x * x, [1000.0 * x, 100.0 * q, 30.0 * q * x]);
            let _ = writeln!(text, "{}\t{t}\t{q}\t0.5\t{z}\t{tx}\t{ty}\t{tz}", row + 1);
        }
        write(folder, &format!("{name}.trc"), &text);
    }
}

const CASES: &[Case] = &[
    (
        "trials with a decimal comma and a row of units",
        german,
        &["[table]\nfiles  = [\"run_*.csv\"]\n", "time   = { column = \"Zeit\", unit = \"ms\" }\n", "![[source]]"],
        Ok((&["a", "b", "c", "d", "e"], "Winkel rad > Weg mm")),
    ),
    (
        "one Parquet file with a column of trials",
        one_parquet,
        &[
            "trial  = { column = \"take\" }   # does it name the trials?",
            "# not used: \"mode\", always 4",
            "held_out    = [\"take2\"]",
            "# column = \"load\"",
            "!file = ",
        ],
        Ok((&["take0", "take1", "take2"], "cmd 1 > tip_mm mm")),
    ),
    (
        "episodes as LeRobot writes them",
        lerobot,
        &[
            "files  = [\"data/chunk-000/episode_*.parquet\"]",
            "trial  = { file = \"episode_(.*)\" }",
            "# not used: \"frame_index\", it counts",
            "time   = { column = \"timestamp\", unit = \"s\" }   # is this its unit?",
        ],
        Ok((&["000000", "000001", "000002"], "action 1 > observation.state 1")),
    ),
    (
        "types of Parquet",
        stamps,
        &["trial  = { column = \"run_text\" }"],
        Err("types.parquet: trial `a` has 30 samples in one stretch"),
    ),
    (
        "one log of all trials",
        shared_log,
        &["shared = true   # does this one file hold all trials?", "trial  = { file = \"marker_(.*)\" }"],
        Ok((&["1", "2", "3"], "log.motor_1 1, log.pwm 1 > marker.x 1, marker.z 1")),
    ),
    (
        "markers as TRC",
        trc,
        &[
            "format = \"trc\"",
            "clock  = \"reference\"   # its samples are those of the trials",
            "# not used: \"trc.Base.Y\", always 0.5",
            "!time ",
        ],
        Ok((&["walk1", "walk2"], "trc.Base.X mm, trc.Base.Z mm > trc.Tip.X mm, trc.Tip.Y mm, trc.Tip.Z mm")),
    ),
    (
        "stray files",
        |folder| {
            plain(folder, &["run_a.csv", "run_b.csv", "run_c.csv"]);
            write(folder, "README.md", "# What this is");
            write(folder, "notes.txt", "nothing, of interest\nhere, at all\n");
            write(folder, "photo.png", "\u{1}\u{2}");
            write(folder, "gains.csv", "joint,kp\n1,2.5\n2,3.5\n");
            write(folder, "run_d.csv", "t,q,x\n");
            write(folder, "run_e.csv", "t,q,x\n0,1,\"2\n");
        },
        &[
            "files  = [\"run_a.csv\", \"run_b.csv\", \"run_c.csv\"]",
            "ignore = [\"gains.csv\", \"run_d.csv\", \"run_e.csv\"]",
            "# \"run_d.csv\" is left out: it has no rows of data",
            "# \"run_e.csv\" is left out: row 2: a quotation mark is opened in column",
            "!README",
            "!png",
        ],
        Ok((&["a", "b", "c"], "q 1 > x 1")),
    ),
    (
        "names with digits, blanks, dots and quotes",
        |folder| {
            plain(
                folder,
                &["1.csv", "2.csv", "10.csv", "my [first] run.v2.csv", "the \"last\" one.csv", "a:b.csv", "~c.csv"],
            );
        },
        &["files  = [\"*.csv\"]", "held_out    = [\"~c\"]"],
        Ok((&["1", "2", "10", "a:b", "my [first] run.v2", "the \"last\" one", "~c"], "q 1 > x 1")),
    ),
    (
        "one more column in one file",
        |folder| {
            plain(folder, &["run_a.csv", "run_b.csv"]);
            write(folder, "run_c.csv", &csv("t,q,x,hall", 2, |_, [t, q, x]| format!("{t},{q},{x},{q}")));
        },
        &["files  = [\"run_*.csv\"]", "# not used: \"hall\", 1 of 3 files have it"],
        Ok((&["a", "b", "c"], "q 1 > x 1")),
    ),
];

/// One file: header and rows, the draft, and what an opened set holds.
type File = (&'static str, fn(usize, [f64; 3]) -> String, Draft, Opened);

const FILES: &[File] = &[
    (
        "Zeit,q,x", // in ms
        |_, [t, q, x]| format!("{},{q},{x}", 1000.0 * t),
        &["time   = { column = \"Zeit\", unit = \"ms\" }   # is this its unit?", "!trial  ="],
        Ok((&["a"], "q 1 > x 1")),
    ),
    (
        "t,motor angle,motor ticks,x",
        |k, [t, q, x]| format!("{t},{},{},{x}", (360.0 * t + 90.0 * q).rem_euclid(360.0) - 180.0, (k * 2000) % 65536),
        &[
            "angles = [\"motor angle\"]   # each jumps by a full turn",
            "counters = { \"motor ticks\" = 65536 }   # each starts again after so many",
        ],
        Ok((&["a"], "motor angle deg, motor ticks 1 > x 1")),
    ),
    (
        "ref,meas",
        |_, [_, q, x]| format!("{q},{x}"),
        &["time   = { rate_hz = 100.0 }   # no column looks like time: what is the rate?"],
        Ok((&["a"], "ref 1 > meas 1")),
    ),
    (
        "col1,col2,col3",
        |_, [t, q, x]| format!("{t},{q},{x}"),
        &["time   = { column = \"col1\", unit = \"s\" }   # is this its unit?"],
        Ok((&["a"], "col2 1 > col3 1")),
    ),
    (
        "t,q,x", // it stands still
        |k, [_, q, x]| format!("{},{q},{x}", k - k % 10 / 9),
        &["time   = { column = \"t\", unit = \"s\" }   # is this its unit?"],
        Err("a.csv, row 11, column `t`"),
    ),
    (
        "n,clock [s],u [V],x (mm),T", // a temperature
        |k, [t, q, x]| format!("{k},{t},{q},{x},{}", 20.0 + q),
        &[
            "time   = { column = \"clock [s]\", unit = \"s\" }",
            "# column = \"T\"",
            "# not used: \"n\", it counts",
            "name   = \"x\"",
            "!\"T\", unit",
        ],
        Ok((&["a"], "u [V] V > x (mm) mm")),
    ),
    (
        "t,\"a, 'b'\",x[0],,x,x,note\u{7}",
        |_, [t, q, x]| format!("{t},{q},{x},{q},{x},{q},{x}"),
        &[
            "# not used: \"\", a column without a name: give it one in the header",
            "# not used: \"x\", the header has it twice: rename one",
            "# not used: \"note\\u0007\", its name has control characters: rename it",
        ],
        Ok((&["a"], "a, 'b' 1 > x[0] 1")),
    ),
];

/// What does not hold.
fn wrong(name: &str, make: &dyn Fn(&Path), parts: Draft, expected: &Opened) -> Option<String> {
    let folder = tempfile::tempdir().expect("a folder");
    make(folder.path());
    let draft = match init::manifest(folder.path()) {
        Ok(draft) => draft,
        Err(error) => return Some(format!("no draft: {error}")),
    };
    let holds = |part: &&&str| part.strip_prefix('!').map_or(draft.contains(**part), |absent| !draft.contains(absent));
    let failed: Vec<_> = parts.iter().filter(|part| !holds(part)).collect();
    std::fs::write(folder.path().join("manifest.toml"), &draft).expect("written");
    let opened = Recordings::open(folder.path(), None, &Options { window: Some(50), ..Options::default() });
    let opened = match (opened.map(|set| summary(&set)), expected) {
        (Ok(found), Ok((trials, signals))) if found.0 == *trials && found.1 == *signals => None,
        (Err(error), Err(part)) if error.to_string().contains(part) => None,
        (Ok(found), _) => Some(format!("holds {found:?}")),
        (Err(error), _) => Some(format!("refused: {error}")),
    };
    let is_right = failed.is_empty() && opened.is_none();
    (!is_right).then(|| format!("{name}: {failed:?}, {}\n{draft}", opened.unwrap_or_default()))
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
    let of_case = |(name, make, draft, opened): &Case| wrong(name, make, draft, opened);
    let of_file = |(header, row, draft, opened): &File| {
        wrong(header, &|folder| write(folder, "a.csv", &csv(header, 0, row)), draft, opened)
    };
    let failures = CASES.iter().filter_map(of_case).chain(FILES.iter().filter_map(of_file)).collect::<Vec<String>>();
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
