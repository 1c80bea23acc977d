//! Spoiled manifests: paths that leave the data folder, keys that are unknown or doubled, roles and folds that contradict.

use super::case::{Case, Said};
use super::good::{MANIFEST, Set, csv, rows};

/// Every case.
pub fn all() -> Vec<Case> {
    [edits(), sizes(), links()].into_iter().flatten().collect()
}

/// What is replaced by what, the line of the message, and its words. Code 2, or 3 where manifest and data do not agree.
type Edit = (&'static str, &'static str, usize, &'static [&'static str], i32);

const EDITS: &[Edit] = &[
    ("\"run_*.csv\"", "\"../run_*.csv\"", 4, &["leaves the data folder", "make it relative"], 2),
    ("\"run_*.csv\"", "\"/etc/passwd\"", 4, &["leaves the data folder"], 2),
    ("\"run_*.csv\"", "\"a/../../run_*.csv\"", 4, &["leaves the data folder"], 2),
    ("\"run_*.csv\"", "\"C:\\\\run.csv\"", 4, &["leaves the data folder"], 2),
    ("\"run_*.csv\"", "\"~/run.csv\"", 4, &["leaves the data folder"], 2),
    ("\"run_*.csv\"", "\"\\\\\\\\server\\\\run.csv\"", 4, &["leaves the data folder"], 2),
    ("\"run_*.csv\"", "\"run_[.csv\"", 4, &["is malformed", "correct it"], 2),
    ("[\"run_*.csv\", \"run_*.parquet\"]", "[]", 3, &["`files` is missing", "name the data files"], 2),
    ("[\"run_*.csv\", \"run_*.parquet\"]", "\"run_*.csv\"", 4, &["expected a list"], 2),
    ("files =", "fiels =", 4, &["unknown field `fiels`", "did you mean `files`?"], 2),
    ("files =", "folder = \"../../etc\"\nfiles =", 4, &["leaves the shared data"], 2),
    ("files =", "folder = \"/etc\"\nfiles =", 4, &["leaves the shared data"], 2),
    ("files =", "separator = \"::\"\nfiles =", 4, &["cannot be used"], 2),
    ("run_(.*)", "run_(", 5, &["no regular expression"], 2),
    ("run_(.*)", "run_.*", 5, &["has no group"], 2),
    ("run_(.*)", "(a{1000}){1000}", 5, &["no regular expression"], 2),
    ("unit = \"ms\"", "unit = \"fortnight\"", 6, &["unknown unit \"fortnight\"", "known units"], 2),
    ("unit = \"ms\"", "unit = \"ms\", rate_hz = nan", 6, &["rate_hz is NaN"], 2),
    ("unit = \"ms\"", "unit = \"ms\", rate_hz = inf", 6, &["rate_hz is inf"], 2),
    ("unit = \"ms\"", "rate_hz = -20.0", 6, &["rate_hz is -20"], 2),
    (
        "{ column = \"t\", unit = \"ms\" }",
        "{ rate_hz = 1e308 }",
        6,
        &["rate_hz is 1e308", "give the samples per second"],
        2,
    ),
    ("column = \"y\"", "column = \"t\"", 13, &["column \"t\" is the time", "cannot be an output"], 2),
    ("column = \"q\"", "column = \"t\"", 7, &["column \"t\" is the time", "cannot be an actuator"], 2),
    ("name = \"small\"", "name = \"sm\\u001b[31mall\"", 2, &["the control character \\u{1b}", "delete it"], 2),
    ("name = \"small\"", "name = \"sm\u{1b}[31mall\"", 2, &["sm?[31mall"], 2),
    ("unit = \"deg\"", "unit = \"degrees\"", 9, &["did you mean \"deg\"?"], 2),
    ("unit = \"deg\"", "unit = \"Deg\"", 9, &["did you mean \"deg\"?"], 2),
    ("unit = \"deg\"", "unit = \"deg\"\nunit = \"rad\"", 10, &["the key is there twice", "delete one of the two"], 2),
    ("unit = \"deg\"", "unit = 1", 9, &["expected a text in quotes"], 2),
    ("unit = \"deg\"", "unit = deg", 9, &["at `actuator.unit`", "text needs quotes"], 2),
    ("unit = \"deg\"", "unit = \"deg", 9, &["at `actuator.unit`"], 2),
    ("unit = \"deg\"", "unit = \u{201c}deg\u{201d}", 9, &["at `actuator.unit`"], 2),
    ("column = \"q\"", "colunm = \"q\"", 8, &["did you mean `column`?"], 2),
    ("column = \"h\"", "column = \"y\"", 10, &["an output cannot be an input"], 2),
    ("column = \"h\"", "column = \"q\"", 10, &["is taken by [[actuator]] already"], 2),
    ("[[actuator]]", "[[actuators]]", 7, &["unknown field `actuators`", "did you mean `actuator`?"], 2),
    ("[[actuator]]", "[actuator]", 7, &["expected a list"], 2),
    ("[table]", "[table", 3, &["mend the TOML"], 2),
    ("[table]", "[tabel]", 3, &["unknown field `tabel`", "did you mean `table`?"], 2),
    ("name = \"small\"", "name = \"small\"\nname = \"large\"", 3, &["the key is there twice"], 2),
    ("name = \"small\"", "name = 'small", 2, &["mend the TOML"], 2),
    ("name = \"small\"", "synthetic = \"yes\"", 2, &["expected true or false"], 2),
    ("held_out = [\"c\"]", "held_out = [\"c\", \"a\"]", 19, &["is in development already", "exactly one role"], 2),
    ("held_out = [\"c\"]", "held_out = [\"c\", \"c\"]", 19, &["is in held_out already"], 2),
    ("held_out = [\"c\"]", "held-out = [\"c\"]", 19, &["unknown field `held-out`", "did you mean `held_out`?"], 2),
    ("held_out = [\"c\"]", "held_out = [\"c\", \"z\"]", 19, &["names trial `z`", "the trials are a b c d"], 3),
    ("held_out = [\"c\"]", "held_out = [\"\u{441}\"]", 19, &["names trial", "the trials are a b c d"], 3),
    (
        "[roles]",
        "[folds]\nvalidation = [[\"a\"], [\"y\"]]\n[roles]",
        17,
        &["[folds] names trial `y`", "correct the name"],
        3,
    ),
    (
        "[roles]",
        "[folds]\nvalidation = [[\"a\"], []]\n[roles]",
        17,
        &["fold 1 has no trials", "name its validation trials"],
        3,
    ),
    ("[roles]", "[folds]\nvalidation = [[\"a\"], [\"a\", \"b\"]]\n[roles]", 17, &["is in folds 0 and 1"], 3),
    ("[roles]", "[folds]\nvalidation = [[\"c\"]]\n[roles]", 17, &["whose role is held_out"], 3),
    ("[roles]", "[folds]\nvalidation = [\"a\"]\n[roles]", 17, &["expected a list"], 2),
    ("[roles]", "[cut.a]\nhead = { until = 1.0 }\n[roles]", 17, &["no role"], 2),
    (
        "[roles]",
        "[cut.b]\nhead = { until = nan, role = \"excluded\" }\ntail = { role = \"excluded\" }\n[roles]",
        17,
        &["until = NaN"],
        2,
    ),
    ("[roles]", "[cut.z]\nhead = { role = \"excluded\" }\n[roles]", 16, &["[cut] names trial `z`"], 3),
    ("[roles]", "[conditions.a]\nload = { value = inf, unit = \"kg\" }\n[roles]", 17, &["the value is inf"], 2),
    (
        "[roles]",
        "[conditions.a]\nload = { value = 1.0, unit = \"stone\" }\n[roles]",
        17,
        &["unknown unit \"stone\""],
        2,
    ),
    (
        "[roles]",
        "[conditions.z]\nload = { value = 1.0, unit = \"kg\" }\n[roles]",
        16,
        &["[conditions] names trial `z`"],
        3,
    ),
    ("[roles]", "[vehicle]\nposition = [\"h\", \"h\"]\nunit = \"m\"\n[roles]", 17, &["2 columns of position"], 2),
    (
        "[roles]",
        "[arm]\nlength = { value = 620.0, unit = \"m\" }\n[roles]",
        17,
        &["the arm is 620 m long", "correct its unit"],
        2,
    ),
    ("[roles]", "[arm]\nlength = { value = nan, unit = \"m\" }\n[roles]", 17, &["the value is NaN"], 2),
];

fn edits() -> Vec<Case> {
    let case = |(from, to, line, words, code): &Edit| {
        let (from, to, code) = (*from, *to, *code);
        Case {
            name: format!("manifest: {}", to.replace('\n', " ")),
            spoil: Box::new(move |set| {
                let text = String::from_utf8_lossy(&set.read("data/manifest.toml")?).into_owned();
                assert!(text.contains(from), "{from}");
                set.write("data/manifest.toml", text.replacen(from, to, 1))
            }),
            // in the set, trial p stands in a line of its own below [roles]
            said: Said::of(
                code,
                &format!("manifest.toml:{}:", line + usize::from(*line > 16 && from.starts_with("held"))),
                words,
            ),
        }
    };
    EDITS.iter().map(case).collect()
}

fn sizes() -> Vec<Case> {
    let text = |name: &str, text: String, place: &str, words: &[&str]| Case {
        name: format!("manifest: {name}"),
        spoil: Box::new(move |set| set.write("data/manifest.toml", &text)),
        said: Said::of(2, &format!("manifest.toml{place}"), words),
    };
    vec![
        text("10,000 brackets", format!("name = {}", "[".repeat(10_000)), ":1:", &["brackets"]),
        text("10,000 tables in one another", format!("name = {}", "{ a = ".repeat(10_000)), ":1:", &["brackets"]),
        text("a key of 10,000 parts", format!("{} = 1\n", vec!["a"; 10_000].join(".")), ":1:", &["brackets"]),
        text("10 MB", "# filler\n".repeat(10 << 17), ":1:1", &["larger than 1048576 bytes"]),
        text(
            "a line of 200 kB",
            format!("name = \"{}\"\nunit = 5\n", "x".repeat(200_000)),
            ":2:1",
            &["unknown field `unit`"],
        ),
        text("a key of 200 kB", format!("{} = 5\n", "x".repeat(200_000)), ":1:1", &["unknown field"]),
        text(
            "a unit of 200 kB",
            MANIFEST.replace("\"deg\"", &format!("\"{}\"", "x".repeat(200_000))),
            ":9:",
            &["unknown unit"],
        ),
        text(
            "20,000 trials of two roles",
            MANIFEST.replace("held_out = [", &format!("held_out = [{}", "\"a\", ".repeat(20_000))),
            ":19:",
            &["more; mend these first"],
        ),
        text(
            "20,000 unknown trials",
            MANIFEST.replace(
                "held_out = [",
                &format!("held_out = [{}", (0..20_000).map(|i| format!("\"x{i}\", ")).collect::<String>()),
            ),
            ":19:",
            &["more; mend these first"],
        )
        .of_data(),
        text(
            "a column of 200 kB",
            MANIFEST.replace("\"q\"", &format!("\"{}\"", "x".repeat(200_000))),
            "",
            &["column `xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx…` is missing"],
        )
        .of_data_in("run_a.csv"),
        text(
            "no text",
            "\u{feff}\n \n".into(),
            ":1:1",
            &["the file is empty", "write at least one key", "manifest.md"],
        ),
        text("comments alone", "# name = 1\n\n# x".into(), ":1:1", &["nothing but comments"]),
        text("a zero byte", "name = \u{0}".into(), ":1:", &["mend the TOML"]),
    ]
}

impl Case {
    /// What manifest and data do not agree on.
    fn of_data(self) -> Case {
        Case { said: Said { code: 3, ..self.said }, ..self }
    }

    /// The same, told of a file.
    fn of_data_in(self, file: &str) -> Case {
        let case = self.of_data();
        Case { said: Said { file: file.into(), ..case.said }, ..case }
    }
}

fn links() -> Vec<Case> {
    let case = |name: &str, said: Said, spoil: fn(&Set) -> std::io::Result<()>| Case {
        name: format!("manifest: {name}"),
        spoil: Box::new(spoil),
        said,
    };
    let mut cases = vec![case(
        "no file of a pattern",
        Said::of(3, "data", &["\"walk_*.csv\" matches no file", "correct `files`"]),
        |set| set.write("data/manifest.toml", MANIFEST.replace("[\"run_*.csv\"", "[\"walk_*.csv\", \"run_*.csv\"")),
    )];
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;
        let leaves = |words: &[&str]| Said::of(3, "run_b.csv", words);
        cases.push(case(
            "a link that leaves the data folder",
            leaves(&["leads to", "outside of the data folder", "--data DIR"]),
            |set| {
                set.write("elsewhere/run_b.csv", csv(&rows(1)))?;
                std::fs::remove_file(set.file("data/run_b.csv"))?;
                symlink(set.file("elsewhere/run_b.csv"), set.file("data/run_b.csv"))
            },
        ));
        cases.push(case(
            "a link to a file of the system",
            leaves(&["leads to", "passwd", "outside of the data folder"]),
            |set| {
                std::fs::remove_file(set.file("data/run_b.csv"))?;
                symlink("/etc/passwd", set.file("data/run_b.csv"))
            },
        ));
        cases.push(case("a folder that is a link and leaves", leaves(&["outside of the data folder"]), |set| {
            set.write("elsewhere/run_b.csv", csv(&rows(1)))?;
            std::fs::remove_file(set.file("data/run_b.csv"))?;
            symlink(set.file("elsewhere"), set.file("data/more"))?;
            let text = MANIFEST.replace("[\"run_*.csv\"", "[\"more/run_*.csv\", \"run_*.csv\"");
            set.write("data/manifest.toml", text)
        }));
        cases.push(case(
            "a link that leads nowhere",
            Said::of(4, "run_b.csv", &["cannot read", "check the path"]),
            |set| {
                std::fs::remove_file(set.file("data/run_b.csv"))?;
                symlink("nowhere.csv", set.file("data/run_b.csv"))
            },
        ));
        cases.push(case(
            "a device in the place of a file",
            Said::of(3, "manifest.toml", &["names trial `b`"]),
            |set| {
                std::fs::remove_file(set.file("data/run_b.csv"))?;
                symlink("/dev/zero", set.file("data/run_b.csv"))
            },
        ));
        cases.push(case(
            "a device in the place of the manifest",
            Said::of(2, "manifest.toml", &["not a file"]),
            |set| {
                std::fs::remove_file(set.file("data/manifest.toml"))?;
                symlink("/dev/zero", set.file("data/manifest.toml"))
            },
        ));
    }
    cases
}
