//! One spoiled set for each problem that reading can find, through `acm-data check`: the message names file, row,
//! column and value, and says what to do; the exit code is 3 for data, 2 for the manifest, 4 for the file system.

use assert_cmd::Command;

use super::set::{self, Set};

/// What spoils the set, the exit code, and what the message must contain.
type Case = (&'static str, fn(&Set), i32, &'static [&'static str]);

fn replace_row(set: &Set, row: usize, text: &str) {
    let file = std::fs::read_to_string(set.file("run_b.csv")).expect("read");
    let mut lines: Vec<&str> = file.lines().collect();
    lines[row - 1] = text;
    set.write("run_b.csv", &(lines.join("\n") + "\n"));
}

const CASES: &[Case] = &[
    (
        "missing column",
        |s| {
            s.edit("run_b.csv", "t,q,h,y", "t,q,height,y");
        },
        3,
        &["run_b.csv", "column `h` is missing", "`height`", "correct the name"],
    ),
    (
        "a table of no pattern beside a missing column",
        |s| {
            s.write("walk.csv", "t\n").edit("run_b.csv", "t,q,h,y", "t,q,height,y");
        },
        3,
        &["2 problems", "column `h` is missing", "warning: ", "no pattern matches walk.csv"],
    ),
    (
        "doubled column",
        |s| {
            s.edit("run_b.csv", "t,q,h,y", "t,q,y,y").edit(
                "manifest.toml",
                "column = \"h\"",
                "column = \"q\"\nname = \"g\"",
            );
        },
        3,
        &["run_b.csv", "column `y` is there 2 times", "rename or delete"],
    ),
    (
        "text in a number",
        |s| replace_row(s, 7, "500,3.5,13.5,broken"),
        3,
        &["run_b.csv, row 7, column `y`", "\"broken\" is not a number", "correct the cell or delete the row"],
    ),
    (
        "decimal comma",
        |s| replace_row(s, 7, "500,\"3,5\",13.5,4"),
        3,
        &["run_b.csv, row 7, column `q`", "\"3,5\" is not a number: it has a decimal comma;", "write a decimal point"],
    ),
    (
        "NaN",
        |s| replace_row(s, 9, "700,NaN,13.5,4"),
        3,
        &["run_b.csv, row 9, column `q`", "\"NaN\" is a missing value", "fill it or delete the row"],
    ),
    (
        "infinity",
        |s| replace_row(s, 9, "700,-inf,13.5,4"),
        3,
        &["run_b.csv, row 9, column `q`", "-inf is not finite", "correct the cell"],
    ),
    (
        "past the range of a float",
        |s| replace_row(s, 9, "700,1e999,13.5,4"),
        3,
        &["run_b.csv, row 9, column `q`", "1e999 is not finite"],
    ),
    (
        "empty actuator",
        |s| replace_row(s, 11, "900,,13.5,4"),
        3,
        &["run_b.csv, row 11, column `q`", "the cell is empty", "fill it or delete the row"],
    ),
    ("empty time", |s| replace_row(s, 11, ",3.5,13.5,4"), 3, &["run_b.csv, row 11, column `t`", "the cell is empty"]),
    (
        "time goes back",
        |s| replace_row(s, 12, "850,3.5,13.5,4"),
        3,
        &["run_b.csv, row 12, column `t`", "time goes back from 0.9 s to 0.85 s", "sort the file or split the trial"],
    ),
    (
        "time stands still",
        |s| replace_row(s, 12, "900,3.5,13.5,4"),
        3,
        &[
            "run_b.csv, row 12, column `t`",
            "time stands still, duplicate time stamp 0.9 s",
            "delete one of the two rows",
        ],
    ),
    (
        "duplicate row",
        |s| {
            let text = set::csv(&set::rows(1));
            let line = text.lines().nth(10).expect("row 11").to_string() + "\n";
            s.write("run_b.csv", &text.replacen(&line, &line.repeat(2), 1));
        },
        3,
        &["run_b.csv, row 12", "repeats row 11", "time 0.9 s", "delete one of them"],
    ),
    (
        "short row",
        |s| replace_row(s, 5, "300,3.5"),
        3,
        &["run_b.csv, row 5", "2 cells under 4 columns", "complete the row or delete it"],
    ),
    ("long row", |s| replace_row(s, 5, "300,3.5,13.5,4,5,6"), 3, &["run_b.csv, row 5", "6 cells under 4 columns"]),
    ("blank row", |s| replace_row(s, 5, ""), 3, &["run_b.csv, row 5", "0 cells under 4 columns", "delete it"]),
    (
        "open quotation mark",
        |s| replace_row(s, 5, "300,\"3.5,13.5,4"),
        3,
        &["run_b.csv, row 5", "opened in column `q` and never closed", "close or delete it"],
    ),
    (
        "no rows",
        |s| {
            s.write("run_b.csv", "t,q,h,y\n");
        },
        3,
        &["run_b.csv", "no rows below its header", "delete it, or record it again"],
    ),
    (
        "empty file",
        |s| {
            s.write("run_b.csv", "");
        },
        3,
        &["run_b.csv: the file is empty", "copy it again"],
    ),
    (
        "not UTF-8",
        |s| {
            std::fs::write(s.file("run_b.csv"), b"t,q,h,y\n0,1,2,3\n100,1,2,\xff\n").expect("write");
        },
        3,
        &["run_b.csv, row 3", "not UTF-8", "save the file as CSV in UTF-8"],
    ),
    ("zero byte", |s| replace_row(s, 6, "400,3.5,13.5,\0"), 3, &["run_b.csv, row 6", "zero byte", "copy it again"]),
    (
        "truncated Parquet",
        |s| {
            s.edit("manifest.toml", "[\"run_*.csv\"]", "[\"run_*.csv\", \"run_*.parquet\"]");
            std::fs::remove_file(s.file("run_b.csv")).expect("remove");
            set::parquet(&s.file("run_b.parquet"), &set::rows(1));
            let whole = std::fs::read(s.file("run_b.parquet")).expect("read");
            std::fs::write(s.file("run_b.parquet"), &whole[..whole.len() * 2 / 3]).expect("write");
        },
        3,
        &["run_b.parquet", "breaks off", "truncated or damaged", "copy it again"],
    ),
    (
        "infinity in Parquet",
        |s| {
            s.edit("manifest.toml", "[\"run_*.csv\"]", "[\"run_*.csv\", \"run_*.parquet\"]");
            std::fs::remove_file(s.file("run_b.csv")).expect("remove");
            let mut rows = set::rows(1);
            rows[2][3] = f64::INFINITY;
            set::parquet(&s.file("run_b.parquet"), &rows);
        },
        3,
        &["run_b.parquet, row 3, column `y`", "inf is not finite", "a lost marker is an empty cell"],
    ),
    (
        "text in Parquet",
        |s| {
            use acm_datasets::files::table::{Column, write_parquet};
            s.edit("manifest.toml", "[\"run_*.csv\"]", "[\"run_*.csv\", \"run_*.parquet\"]");
            std::fs::remove_file(s.file("run_b.csv")).expect("remove");
            let text = |c: &str| (c.to_string(), Column::Text(vec!["0".into(), "one".into()]));
            write_parquet(&s.file("run_b.parquet"), &["t", "q", "h", "y"].map(text)).expect("write");
        },
        3,
        &["run_b.parquet, row 2, column `q`", "\"one\" is not a number"],
    ),
    (
        "unknown extension",
        |s| {
            s.edit("manifest.toml", "[\"run_*.csv\"]", "[\"run_*\"]").write("run_e.xlsx", "x");
        },
        3,
        &["run_e.xlsx", "neither .csv nor .parquet", "convert the file"],
    ),
    (
        "pattern without a file",
        |s| {
            s.edit("manifest.toml", "[\"run_*.csv\"]", "[\"run_*.csv\", \"walk_*.csv\"]");
        },
        3,
        &["\"walk_*.csv\" matches no file", "correct `files`"],
    ),
    (
        "file name without a trial",
        |s| {
            s.edit("manifest.toml", "run_(.*)", "run_([abc])");
        },
        3,
        &["run_d.csv", "does not match the pattern \"run_([abc])\"", "rename the file"],
    ),
    (
        "trial in two files",
        |s| {
            s.edit("manifest.toml", "run_(.*)", "run_(.).*").write("run_a2.csv", &set::csv(&set::rows(9)));
        },
        3,
        &["trial `a`", "run_a.csv", "run_a2.csv", "different names"],
    ),
    (
        "the same trial twice",
        |s| {
            s.write("run_c.csv", &set::csv(&set::rows(0)));
        },
        0,
        &["trials `a` (run_a.csv) and `c` (run_c.csv) hold the same values", "held-out trial `c`", "tests nothing"],
    ),
    (
        "two trials at rest",
        |s| {
            let rest: Vec<[f64; 4]> = set::rows(0).into_iter().map(|[t, ..]| [t, 3.0, 12.0, 40.0]).collect();
            s.write("run_a.csv", &set::csv(&rest)).write("run_b.csv", &set::csv(&rest));
        },
        0,
        &["trials `a` (run_a.csv) and `b` (run_b.csv) hold the same values; if one is a copy"],
    ),
    (
        "a name for each row",
        |s| {
            let row = |i: usize| format!("p{i},{},{},12,{}\n", 100 * i, i % 7, 3 * i);
            s.write("poses.csv", &("name,t,q,h,y\n".to_string() + &(0..200).map(row).collect::<String>()));
            let names = (0..200).map(|i| format!("\"p{i}\", ")).collect::<String>();
            s.edit("manifest.toml", "run_*.csv", "poses.csv").edit(
                "manifest.toml",
                "file = \"run_(.*)\"",
                "column = \"name\"",
            );
            s.edit("manifest.toml", "[\"a\", \"b\"]", &format!("[{names}]"));
            s.edit("manifest.toml", "[\"c\"]", "[]").edit("manifest.toml", "[\"d\"]", "[]");
        },
        3,
        &["poses.csv, column `name`: 200 of the 200 trials", "leave `trial` out of [table]", "rate_hz"],
    ),
    (
        "trial without a role",
        |s| {
            s.write("run_e.csv", &set::csv(&set::rows(5)));
        },
        3,
        &["manifest.toml", "trial `e` (run_e.csv) has no role", "[roles]"],
    ),
    (
        "role of an unknown trial",
        |s| {
            s.edit("manifest.toml", "held_out = [\"c\"]", "held_out = [\"c\", \"z\"]");
        },
        3,
        &["manifest.toml:19:18", "[roles] names trial `z`", "the trials are a b c d", "correct the name"],
    ),
    (
        "fold of an unknown trial",
        |s| {
            s.edit("manifest.toml", "[roles]", "[folds]\nvalidation = [[\"a\"], [\"y\"]]\n[roles]");
        },
        3,
        &["manifest.toml:17:23", "[folds] names trial `y`", "correct the name"],
    ),
    (
        "fold of a held-out trial",
        |s| {
            s.edit("manifest.toml", "[roles]", "[folds]\nvalidation = [[\"a\"], [\"c\"]]\n[roles]");
        },
        3,
        &["manifest.toml:17:23", "fold 1 names trial `c`, whose role is held_out", "move or delete it"],
    ),
    (
        "trial in two folds",
        |s| {
            s.edit("manifest.toml", "[roles]", "[folds]\nvalidation = [[\"a\"], [\"a\", \"b\"]]\n[roles]");
        },
        3,
        &["manifest.toml:17:23", "trial `a` is in folds 0 and 1", "delete one"],
    ),
    (
        "condition of an unknown trial",
        |s| {
            s.edit("manifest.toml", "[roles]", "[conditions.x]\np = { value = 1, unit = \"N\" }\n[roles]");
        },
        3,
        &["manifest.toml:16", "[conditions] names trial `x`", "delete it"],
    ),
    (
        "cut of an unknown trial",
        |s| {
            s.edit("manifest.toml", "[roles]", "[cut.x]\np = { role = \"excluded\" }\n[roles]");
        },
        3,
        &["manifest.toml:16", "[cut] names trial `x`"],
    ),
    (
        "cut outside of the trial",
        |s| {
            s.edit("manifest.toml", "\"b\"]", "]").edit(
                "manifest.toml",
                "[roles]",
                "[cut.b]\nhead = { until = 105.0, role = \"development\" }\ntail = { role = \"held_out\" }\n[roles]",
            );
        },
        3,
        &["manifest.toml:18", "`b:tail` has 0 samples", "move `until`", "from 0 s to 5.9 s"],
    ),
    (
        "trial of one sample",
        |s| {
            s.write("run_b.csv", "t,q,h,y\n0,1,2,3\n");
        },
        3,
        &["run_b.csv", "trial `b` has 1 samples", "fewer than 2", "exclude it"],
    ),
    (
        "trial shorter than a window",
        |s| {
            s.write("run_b.csv", &set::csv(&set::rows(1)[..31]));
        },
        3,
        &["run_b.csv", "trial `b` has 31 samples", "fewer than 50 of a window", "shorter window"],
    ),
    (
        "a gap in a trial that is long enough without it",
        |s| {
            let mut rows = set::rows(1);
            rows[30..].iter_mut().for_each(|r| r[0] += 2000.0);
            s.write("run_b.csv", &set::csv(&rows));
        },
        3,
        &["run_b.csv", "trial `b` has 30 samples in one stretch without a gap over 0.5 s"],
    ),
    (
        "a file past the limit",
        |s| {
            let file = std::fs::File::create(s.file("run_b.csv")).expect("create");
            file.set_len(5 << 30).expect("a sparse file");
        },
        3,
        &["run_b.csv", "5368709120 bytes are past the limit", "one file per trial"],
    ),
    (
        "no data",
        |s| {
            for name in ["a", "b", "c", "d"] {
                std::fs::remove_file(s.file(&format!("run_{name}.csv"))).expect("remove");
            }
        },
        3,
        &["no data for `small`", "beside the manifest", "no file matches run_*.csv", "--data DIR"],
    ),
    (
        "no data, and where to get them",
        |s| {
            s.edit("manifest.toml", "name = \"small\"", "name = \"small\"\nobtain = \"ask the authors\"");
            s.edit("manifest.toml", "[table]", "[table]\nfolder = \"data/nowhere\"").edit(
                "manifest.toml",
                "run_*",
                "walk_*",
            );
        },
        3,
        &["beside the manifest", "../shared/data/nowhere", "no such folder", "to obtain them: ask the authors"],
    ),
    (
        "no manifest",
        |s| {
            std::fs::remove_file(s.file("manifest.toml")).expect("remove");
        },
        4,
        &["cannot read", "manifest.toml", "check the path"],
    ),
];

/// Runs `acm-data check`.
fn check(set: &Set) -> (i32, String) {
    let mut command = Command::cargo_bin("acm-data").expect("acm-data");
    let output = command.arg("check").arg(set.path()).output().expect("acm-data runs");
    (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn every_problem_names_its_place_and_its_remedy() {
    let mut failures = Vec::new();
    for (name, spoil, code, expected) in CASES {
        let set = Set::new();
        spoil(&set);
        let (found, mut message) = check(&set);
        if found == 0 {
            message = set.campaign().warnings.join("\n");
        }
        let missing: Vec<_> = expected.iter().filter(|e| !message.contains(**e)).collect();
        if found != *code || !missing.is_empty() || message.contains("panicked") {
            failures.push(format!("{name}: exit code {found}, without {missing:?}:\n{message}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn a_set_in_order_has_no_problems() {
    let (code, message) = check(&Set::new());
    assert_eq!((code, message.as_str()), (0, ""));
}

/// However the folder is written, also with characters that mean something in a pattern.
#[test]
fn a_folder_may_be_written_in_any_way() {
    let set = Set::new();
    let odd = set.file("a [set]*");
    std::fs::create_dir(&odd).expect("folder");
    for name in ["manifest.toml", "run_a.csv", "run_b.csv", "run_c.csv", "run_d.csv"] {
        std::fs::copy(set.file(name), odd.join(name)).expect("copy");
    }
    for folder in [".", "./", "a [set]*", "./a [set]*/", "a [set]*/..", "a [set]*/../."] {
        let mut command = Command::cargo_bin("acm-data").expect("acm-data");
        let output = command.arg("check").arg(folder).current_dir(set.path()).output().expect("runs");
        assert!(output.status.success(), "{folder}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

/// Three files with a problem each, in one of them twice, and a missing role: all are printed in one go.
#[test]
fn all_problems_are_printed_not_only_the_first() {
    let set = Set::new();
    set.edit("run_a.csv", "\n100,", "\n100,x").edit("run_a.csv", "\n300,", "\n300,y");
    set.edit("run_b.csv", "\n500,", "\n300,").edit("run_d.csv", "t,q,h,y", "t,q,h,z");
    set.write("run_e.csv", &set::csv(&set::rows(5)));
    let (code, message) = check(&set);
    assert_eq!(code, 3);
    assert!(message.contains("4 problems"), "{message}");
    for expected in ["run_a.csv, row 3", "likewise row 5", "run_b.csv, row 7", "run_d.csv: column `y`", "trial `e`"] {
        assert!(message.contains(expected), "{expected} in\n{message}");
    }
}

/// Layers do not hide one another: a bad cell, a lost column, a repeated row and a missing role of one file.
#[test]
fn all_layers_of_a_file_are_printed_at_once() {
    let set = Set::new();
    let text = set::csv(&set::rows(5)).replacen("t,q,h,y", "t,q,h,z", 1);
    let line = text.lines().nth(10).expect("row 11").to_string() + "\n";
    set.write("run_e.csv", &text.replacen(&line, &line.repeat(2), 1));
    set.edit("run_e.csv", "\n100,", "\n100,x").edit("run_e.csv", "\n300,", "\n300,NaN\n300,");
    set.edit("run_e.csv", "\n300,NaN\n", "\n");
    set.edit("run_a.csv", "\n100,", "\n100,NaN\n100,").edit("run_a.csv", "\n100,NaN\n", "\n");
    let nan = set::csv(&set::rows(0)).replacen("\n200,", "\n100,NaN,12.5,4\n200,", 1).replacen(
        "\n900,",
        "\n850,1,12.5,4\n840,1,12.5,4\n900,",
        1,
    );
    set.write("run_a.csv", &nan);
    let (code, message) = check(&set);
    assert_eq!(code, 3, "{message}");
    let expected = [
        "run_a.csv, row 4, column `q`: \"NaN\" is a missing value",
        "run_a.csv, row 4, column `t`: time stands still, duplicate time stamp 0.1 s",
        "time goes back from 0.85 s to 0.84 s",
        "run_e.csv: column `y` is missing",
        "run_e.csv, row 3, column `q`: \"x",
        "run_e.csv, row 12, column `t`: the row repeats row 11",
        "trial `e` (run_e.csv) has no role",
    ];
    for expected in expected {
        assert!(message.contains(expected), "{expected} in\n{message}");
    }
}

#[test]
fn many_bad_cells_are_one_message_with_their_number() {
    let set = Set::new();
    let text = set::csv(&set::rows(1)).lines().skip(1).map(|l| l.replacen(',', ",x", 1) + "\n").collect::<String>();
    set.write("run_b.csv", &("t,q,h,y\n".to_string() + &text));
    let (code, message) = check(&set);
    assert_eq!(code, 3);
    assert_eq!(message.matches("is not a number").count(), 1, "{message}");
    assert!(message.contains("run_b.csv, row 2, column `q`: \"x"), "{message}");
    assert!(message.contains("is not a number, likewise 59 more (rows 3 to 61); correct the cell"), "{message}");
}

#[test]
fn rows_of_a_wrong_length_are_one_message_for_each_length() {
    let set = Set::new();
    let text = set::csv(&set::rows(1)).replace(",13.5,", ",13,5,");
    set.write("run_b.csv", &text);
    let (_, message) = check(&set);
    assert_eq!(message.matches("5 cells under 4 columns").count(), 1, "{message}");
    assert!(message.contains("so cell 5 has no column, likewise 59 more (rows 3 to 61)"), "{message}");
}

/// Matched by a pattern, or beside the others; text that is compressed with gzip is read.
#[test]
fn compressed_tables_are_named() {
    for (name, how) in [("zst", "zstd"), ("zip", "zip"), ("xz", "xz")] {
        let set = Set::new();
        set.write(&format!("run_e.csv.{name}"), "x");
        let warnings = set.campaign().warnings;
        assert_eq!(warnings.len(), 1);
        assert!(
            warnings[0].contains(&format!("run_e.csv.{name} is compressed and not read; decompress")),
            "{warnings:?}"
        );
        set.edit("manifest.toml", "files =", "ignore = [\"*.csv.*\"]\nfiles =");
        assert_eq!(set.campaign().warnings, [""; 0]);
        set.edit("manifest.toml", "run_*.csv", "run_*");
        let (code, message) = check(&set);
        assert_eq!(code, 3);
        assert!(message.contains(&format!("run_e.csv.{name}: the file is compressed with {how}")), "{message}");
        assert!(message.contains("decompress it"), "{message}");
    }
}

#[cfg(unix)]
#[test]
fn a_file_that_may_not_be_read_is_a_problem_of_the_file_system() {
    use std::os::unix::fs::PermissionsExt;
    let set = Set::new();
    std::fs::set_permissions(set.file("run_b.csv"), std::fs::Permissions::from_mode(0o000)).expect("chmod");
    if std::fs::read(set.file("run_b.csv")).is_ok() {
        return eprintln!("skipped: this user may read every file");
    }
    let (code, message) = check(&set);
    assert_eq!(code, 4, "{message}");
    assert!(message.contains("run_b.csv") && message.contains("permissions"), "{message}");
}

#[test]
fn usage_is_code_two() {
    for arguments in [vec!["check"], vec!["check", ".", "--window", "0"], vec!["fly"]] {
        let output = Command::cargo_bin("acm-data").expect("acm-data").args(&arguments).output().expect("runs");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
}
