//! Sets of several sources: a Motive export, a CSV of commands and one ULog of all takes, each with a clock of its own.

#![allow(missing_docs)]

mod dated;
mod lab;
#[allow(dead_code)] // used by another test
#[path = "../formats/ulog_file.rs"]
mod ulog_file;

use acm_datasets::join::How;
use acm_datasets::recordings::Options;
use acm_datasets::{DropReason, Recordings};
use assert_cmd::Command;
use lab::Lab;

fn open(lab: &Lab) -> Result<Recordings, String> {
    Recordings::open(&lab.path(), None, &Options::default()).map_err(|e| e.to_string())
}

/// Oracle: planted clocks and the motion itself.
#[test]
fn three_clocks_become_one() {
    let lab = Lab::new();
    let data = open(&lab).expect("opened");
    assert_eq!((data.entries.len(), data.alignments.len()), (3, 9));
    for (k, trial) in ["a", "b", "c"].iter().enumerate() {
        let of = |source: &str| {
            data.alignments.iter().find(|a| a.trial == *trial && a.source == source).cloned().expect("aligned")
        };
        assert_eq!(of("mocap").how, How::Same);
        for (source, planted) in [("motors", lab::motors_offset(k)), ("log", lab::log_offset(k))] {
            let found = of(source);
            let error = (found.offset - planted).abs();
            assert!(error <= 3.0 * found.interval && error < 0.005, "{trial} {planted}: {found}");
        }
    }
    for (k, trial) in data.all().map(|trial| trial.expect("read").into_owned()).enumerate() {
        let worst = |column: &dyn Fn(usize) -> f64| {
            (0..trial.samples()).map(|i| (column(i) - lab::motion(k, trial.time[i])).abs()).fold(0.0, f64::max)
        };
        assert!(worst(&|i| trial.actuators[(i, 0)]) < 0.02, "{}", worst(&|i| trial.actuators[(i, 0)]));
        assert!(worst(&|i| trial.measured[(i, 0)] * 10.0) < 1e-4, "{}", worst(&|i| trial.measured[(i, 0)] * 10.0));
        assert!((0..trial.samples()).all(|i| (trial.context[(i, 0)] - lab::volt(k, trial.time[i])).abs() < 0.01));
        assert_eq!(trial.dropped.get(&DropReason::MissingMarker), Some(&lab::OCCLUDED));
        // the commands end two seconds before the take, and pause for half a second
        let lacking = trial.dropped.get(&DropReason::MissingSource).copied().unwrap_or_default();
        assert!((280..=330).contains(&lacking), "{lacking}");
    }
}

/// A set that is read again whenever it is asked for has the same bits as one in memory.
#[test]
fn a_large_set_is_joined_again_to_the_same_bits() {
    let lab = Lab::new();
    let held = open(&lab).expect("opened");
    let streamed = Recordings::open(&lab.path(), None, &Options { hold: 0, ..Options::default() }).expect("opened");
    assert!(held.is_held() && !streamed.is_held());
    assert_eq!((&held.hash, &held.alignments), (&streamed.hash, &streamed.alignments));
    for (a, b) in held.all().zip(streamed.all()) {
        assert_eq!(a.expect("held").into_owned(), b.expect("read").into_owned());
    }
}

fn run(arguments: &[&std::ffi::OsStr]) -> (i32, String) {
    let output = Command::cargo_bin("acm-data").expect("acm-data").args(arguments).output().expect("runs");
    let text = [output.stdout, output.stderr].concat();
    (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&text).into_owned())
}

/// What `join` writes is a set of its own, with the same samples.
#[test]
fn joined_trials_are_a_set_of_plain_tables() {
    let lab = Lab::new();
    let (folder, out) = (lab.path(), lab.path().join("joined"));
    let (code, text) = run(&["join".as_ref(), folder.as_ref(), "--out".as_ref(), out.as_ref()]);
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("trial `b` · motors: t +") && text.contains("b.parquet"), "{text}");
    let (code, text) = run(&["check".as_ref(), out.as_ref()]);
    assert!(code == 0 && text.contains("no problems"), "{text}");
    let (joined, direct) =
        (Recordings::open(&out, None, &Options::default()).expect("opened"), open(&lab).expect("opened"));
    for (a, b) in joined.all().zip(direct.all()) {
        let (a, b) = (a.expect("read").into_owned(), b.expect("read").into_owned());
        assert_eq!((a.name, a.time, a.actuators, a.measured), (b.name, b.time, b.actuators, b.measured));
    }
}

/// What is wrong is told with its place and what to do.
#[test]
fn what_does_not_fit_together_is_refused() {
    let cases: &[(&str, &str, &[&str])] = &[
        ("offset = \"estimate\"\ndrift", "drift", &["manifest.toml", "its clock is not known", "clock = \"same\""]),
        ("clock  = \"reference\"\n", "", &["0 sources are the reference"]),
        (
            "mocap.Tip.Position.X",
            "mocap.Tip.Position.Q",
            &["column `Tip.Position.Q` is missing", "did you mean `Tip.Position."],
        ),
        ("\"motors.q1\"", "\"motor.q1\"", &["column \"motor.q1\" names no source", "motors.…"]),
        ("\"(.*)_motors\"", "\"(.*)_mot\"", &[]),
        (
            "files  = [\"*_motors.csv\"]",
            "files  = [\"[ab]_motors.csv\"]",
            &["trial `c`, source `motors`", "no file of this trial"],
        ),
        (
            "offset = \"estimate\"\ndrift",
            "offset = { value = 900.0, unit = \"s\" }\ndrift",
            &["trial `a`, source `motors`", "does not overlap"],
        ),
        (
            "offset = \"estimate\"\ndrift",
            "offset = { value = { a = 0.7, b = 0.713 }, unit = \"s\" }\ndrift",
            &["trial `c`, source `motors`: `value` in `offset` lacks this trial"],
        ),
        (
            "offset = \"estimate\"\ndrift",
            "offset = { estimate = \"estimate\", around = { a = 0.7, d = 0.7 }, within = 0.1 }\ndrift",
            &["manifest.toml:16:59", "names trial `d`", "the trials are a b c"],
        ),
        (
            "offset = \"estimate\"\ndrift",
            "offset = { value = { a = nan }, unit = \"s\" }\ndrift",
            &["manifest.toml:16:26", "the offset is NaN"],
        ),
        (
            "offset = \"estimate\"\ndrift",
            "offset = \"guess\"\ndrift",
            &["unknown variant `guess`", "estimate", "manifest.toml:"],
        ),
        (
            "offset = \"estimate\"\ndrift",
            "offset = { valeu = 1.0 }\ndrift",
            &["unknown field `valeu`", "did you mean `value`"],
        ),
        (
            "[[source]]\nname   = \"mocap\"",
            "[table]\nfiles = [\"*.csv\"]\n[[source]]\nname   = \"mocap\"",
            &["[table] and [[source]]"],
        ),
        ("name   = \"motors\"", "name   = \"mo.tors\"", &["a name without dots"]),
        ("resample = \"linear\"", "resample = \"cubic\"", &["unknown variant `cubic`", "`linear`"]),
        ("time   = { column = \"t\", unit = \"s\" }\n", "", &["a_motors.csv", "its time is not declared", "rate_hz"]),
    ];
    for (from, to, said) in cases {
        let lab = Lab::new();
        assert!(Lab::manifest().contains(from), "{from:?}");
        lab.write("manifest.toml", &Lab::manifest().replacen(from, to, 1));
        match open(&lab) {
            Ok(_) => assert!(said.is_empty(), "{to:?} was accepted"),
            Err(message) => {
                said.iter().for_each(|part| assert!(message.contains(part), "{to:?}: {part:?} in {message}"));
            }
        }
    }
}

/// A time that goes back, and a cell that is no number, in one of the sources.
#[test]
fn what_is_wrong_in_a_file_is_told_with_its_row() {
    let lab = Lab::new();
    let text = lab.read("b_motors.csv");
    let lines: Vec<&str> = text.lines().collect();
    let (first, second) = (lines[100], lines[101]);
    lab.write("b_motors.csv", &text.replace(&format!("{first}\n{second}"), &format!("{second}\n{first}")));
    let message = open(&lab).map(|_| ()).expect_err("refused");
    assert!(message.contains("b_motors.csv, row 102, column `t`: time goes back from"), "{message}");
    lab.write("b_motors.csv", &text.replace(second, "1,98; 0,5"));
    let message = open(&lab).map(|_| ()).expect_err("refused");
    assert!(message.contains("b_motors.csv") && message.contains("row 102"), "{message}");
    for (at, stamp) in [(102, "1764411111"), (102, "-1e5"), (2, "1e4"), (1476, "1e6")] {
        let lines = text.lines().enumerate().map(|(i, line)| match (i + 1 == at, line.split_once(',')) {
            (true, Some((_, rest))) => format!("{stamp},{rest}\n"),
            _ => format!("{line}\n"),
        });
        lab.write("b_motors.csv", &lines.collect::<String>());
        let (code, said) = run(&["check".as_ref(), lab.path().as_ref()]);
        let expected =
            format!("b_motors.csv, row {at}: the time of source `motors` jumps to {}", stamp.parse::<f64>().unwrap());
        assert!(code == 3 && said.replace(['\n', '│'], " ").contains(&expected), "{expected} in {said}");
    }
}

/// An excluded trial is not checked.
#[test]
fn an_excluded_trial_blocks_nothing() {
    let spoil: [&dyn Fn(&Lab); 4] = [
        &|lab| std::fs::remove_file(lab.path().join("c_motors.csv")).expect("removed"),
        &|lab| lab.write("c_motors.csv", &lab.read("c_motors.csv").replacen("\n-1.", "\n1764411111.", 1)),
        &|lab| lab.write("c_motors.csv", "t,q1,q2\n0,1,2\n1,1,2\n"),
        &|lab| lab.write("c_mocap.csv", "no take"),
    ];
    for (i, spoil) in spoil.iter().enumerate() {
        let lab = Lab::new();
        spoil(&lab);
        assert!(open(&lab).is_err(), "{i}");
        let roles = "[\"a\", \"b\"]\nexcluded = [\"c\"]";
        lab.write("manifest.toml", &Lab::manifest().replace("[\"a\", \"b\", \"c\"]", roles));
        let data = open(&lab).expect("opened");
        assert_eq!((data.entries.len(), data.alignments.len()), (2, 6), "{i}");
        let warned = data.warnings.iter().any(|warning| warning.contains("trial `c` is excluded, and left out: "));
        assert!(warned, "{i}: {:?}", data.warnings);
    }
}

/// One offset for all trials, an event, a given one, and one for each trial.
#[test]
fn an_offset_may_be_common_given_or_an_event() {
    let lab = Lab::new();
    let given = "offset = { value = 700.0, unit = \"ms\" }\n";
    lab.write("manifest.toml", &Lab::manifest().replacen("offset = \"estimate\"\ndrift  = { ppm = 0.0 }\n", given, 1));
    let data = open(&lab).expect("opened");
    let motors: Vec<_> = data.alignments.iter().filter(|a| a.source == "motors").collect();
    assert!(motors.iter().all(|a| a.offset == 0.7 && a.interval == 0.0 && a.how == How::Given), "{motors:?}");
    for offset in [
        "{ value = { a = 0.7, b = 0.713, c = -0.4 }, unit = \"s\" }",
        "{ estimate = \"estimate\", around = { a = 0.7, b = 0.713, c = -0.4 }, within = 0.01 }",
    ] {
        lab.write("manifest.toml", &Lab::manifest().replacen("\"estimate\"", offset, 1));
        let data = open(&lab).expect("opened");
        for (k, motors) in data.alignments.iter().filter(|a| a.source == "motors").enumerate() {
            assert!((motors.offset - lab::motors_offset(k)).abs() < 0.005, "{motors}");
        }
    }
    let common = Lab::manifest().replacen("offset = \"estimate\"", "offset = \"common\"", 1);
    lab.write("manifest.toml", &common);
    let data = open(&lab).expect("opened");
    let motors: Vec<_> = data.alignments.iter().filter(|a| a.source == "motors").collect();
    assert!(motors.iter().all(|a| a.how == How::Common(3) && a.offset == motors[0].offset), "{motors:?}");
    let planted = lab::motors_offset(0);
    assert!((motors[0].offset - planted).abs() < 0.005, "the median of three: {} and {planted}", motors[0].offset);
    let event =
        "offset = { event = \"motors.q1\", above = 0.3, reference = \"mocap.Tip.Position.X\", reference_above = 30.0 }";
    lab.write("manifest.toml", &Lab::manifest().replacen("offset = \"estimate\"\ndrift  = { ppm = 0.0 }", event, 1));
    // positions are in millimetres in the file, a hundred to a radian
    let data = open(&lab).expect("opened");
    for alignment in data.alignments.iter().filter(|a| a.source == "motors") {
        assert_eq!(alignment.how, How::Event);
        // half a frame and half a command
        assert!((alignment.interval - (1.0 / 120.0 + 1.0 / 50.0) / 2.0).abs() < 1e-3, "{alignment}");
    }
}

/// The draft of `init` finds the sources of the laboratory, and `check` reads it.
#[test]
fn a_first_manifest_is_accepted_or_questioned() {
    let lab = Lab::new();
    std::fs::remove_file(lab.path().join("manifest.toml")).expect("removed");
    let folder = lab.path();
    let (code, text) = run(&["init".as_ref(), folder.as_ref()]);
    assert_eq!(code, 0, "{text}");
    let draft = lab.read("manifest.toml");
    for part in [
        "files  = [\"*_mocap.csv\"]\nformat = \"motive\"\ntrial  = { file = \"(.*)_mocap\" }\nclock  = \"reference\"",
        "files  = [\"*_motors.csv\"]\nformat = \"csv\"",
        "time   = { column = \"t\", unit = \"s\" }",
        "files  = [\"flight.ulg\"]\nformat = \"ulog\"\nshared = true",
        "column = \"mocap.Tip.Position.X\"\nunit   = \"mm\"",
        "[[actuator]]\ncolumn = \"motors.q1\"",
        "development = [\"a\", \"b\"]",
    ] {
        assert!(draft.contains(part), "{part:?} in\n{draft}");
    }
    let (code, text) = run(&["check".as_ref(), folder.as_ref()]);
    assert!(code == 0 || code == 3, "the manifest itself is in order: {text}");
    let (code, text) = run(&["init".as_ref(), folder.as_ref()]);
    assert!(code == 2 && text.contains("there is a manifest already"), "{text}");
}

/// One take beside a log of another name: the log holds the take. Without that, `check` says how to tell it so.
#[test]
fn a_log_beside_a_single_take_is_shared() {
    let lab = Lab::new();
    for name in ["b_mocap.csv", "c_mocap.csv", "b_motors.csv", "c_motors.csv", "manifest.toml"] {
        std::fs::remove_file(lab.path().join(name)).expect("removed");
    }
    let folder = lab.path();
    let (code, text) = run(&["init".as_ref(), folder.as_ref()]);
    assert_eq!(code, 0, "{text}");
    let draft = lab.read("manifest.toml");
    assert!(draft.contains("files  = [\"flight.ulg\"]\nformat = \"ulog\"\nshared = true"), "{draft}");
    assert!(draft.contains("files  = [\"a_motors.csv\"]"), "{draft}");
    lab.write("manifest.toml", &draft.replace("shared = true", "# shared = true"));
    let (code, text) = run(&["check".as_ref(), folder.as_ref()]);
    assert!(code == 3 && text.contains("set `shared = true`"), "{text}");
}

/// Commands as a spreadsheet of another country saves them: the same trials.
#[test]
fn a_table_of_another_hand_is_the_same_table() {
    let (plain, other) = (Lab::new(), Lab::new());
    for name in ["a", "b", "c"] {
        let file = format!("{name}_motors.csv");
        let text = other.read(&file).replace(',', ";").replace('.', ",").replacen('\n', "\n[s];[rad];[1]\n", 1);
        let wide: Vec<u8> = text.replace('\n', "\r\n").encode_utf16().flat_map(u16::to_le_bytes).collect();
        std::fs::write(other.path().join(file), [&[0xff, 0xfe], wide.as_slice()].concat()).expect("written");
    }
    let (plain, read) = (open(&plain).expect("opened"), open(&other).expect("opened"));
    assert_eq!(plain.alignments, read.alignments);
    for part in ["the text is UTF-16", "separated by ';'", "decimal comma", "the row below the header has the units"] {
        assert!(read.notes.iter().any(|note| note.contains(part)), "{part:?} in {:?}", read.notes);
    }
    let text = Lab::manifest().replace("unit   = \"rad\"", "unit   = \"deg\"");
    other.write("manifest.toml", &text);
    let message = open(&other).map(|_| ()).expect_err("refused");
    assert!(message.contains("column `q1`: the file has the unit \"rad\", and the manifest \"deg\""), "{message}");
}

/// Oracle: the laboratory's clocks, rates, and its occlusion of 24 frames at 120 Hz; the picture has a line for each signal.
#[test]
fn clocks_are_described_and_drawn() {
    let lab = Lab::new();
    let (folder, picture) = (lab.path(), lab.path().join("clocks.svg"));
    let (code, text) = run(&["describe".as_ref(), folder.as_ref(), "--picture".as_ref(), picture.as_ref()]);
    assert_eq!(code, 0, "{text}");
    let row = |start: &str| {
        let line = text
            .lines()
            .map(|line| line.trim_matches(['│', ' ']))
            .find(|line| line.split_whitespace().take(3).collect::<Vec<_>>().join(" ") == start);
        let cells = line.unwrap_or_else(|| panic!("{start} in\n{text}")).split_whitespace();
        cells.map(str::to_string).collect::<Vec<String>>()
    };
    let motors = row("a motors estimated");
    let offset: f64 = motors[3].parse().expect("an offset");
    assert!((offset - lab::motors_offset(0)).abs() < 0.005, "{motors:?}");
    assert_eq!((motors[6].as_str(), motors[9].as_str()), ("50.00", "0"), "{motors:?}");
    let mocap = row("b mocap reference's");
    assert_eq!((mocap[3].as_str(), mocap[6].as_str(), mocap[9].as_str()), ("–", "120.00", "1"), "{mocap:?}");
    assert_eq!(mocap[10], format!("{:.3}", (lab::OCCLUDED + 1) as f64 / 120.0));
    let drawn = lab.read("clocks.svg");
    assert!(drawn.starts_with("<svg ") && drawn.trim_end().ends_with("</svg>"));
    for (name, panels) in
        [(">mocap.Tip.Position.X<", 9), (">log.pose.p[0]<", 6), (">log.power.volt<", 3), (">motors.q1<", 6)]
    {
        assert_eq!(drawn.matches(name).count(), panels, "{name}");
    }
    for (file, code) in [("clocks.svg", 0), ("manifest.toml", 2)] {
        let before = lab.read(file);
        let (ended, text) =
            run(&["describe".as_ref(), folder.as_ref(), "--picture".as_ref(), folder.join(file).as_ref()]);
        assert!(ended == code && lab.read(file) == before, "{file}: {text}");
    }
    assert!(drawn.matches("<polyline").count() >= 3 * 7, "{}", drawn.matches("<polyline").count());
    let (code, text) = run(&[
        "describe".as_ref(),
        std::path::absolute("acm-twin").unwrap().as_ref(),
        "--picture".as_ref(),
        picture.as_ref(),
    ]);
    assert!(code == 2 && text.contains("leave --picture out"), "{text}");
}
