//! Spoiled manifests: paths that leave the data folder, keys that are unknown or doubled, roles and folds that contradict.

use super::case::{Case, Said};
use super::good::{MANIFEST, csv, rows};

const FILE: &str = "data/manifest.toml";

/// Every case.
pub fn all() -> Vec<Case> {
    [edits(), sizes(), files()].into_iter().flatten().collect()
}

/// What is replaced by what, where the message is (line and column), and its words.
type Edit = (&'static str, &'static str, &'static str, &'static [&'static str]);

const EDITS: &[Edit] = &[
    ("\"run_*.csv\"", "\"../run_*.csv\"", "4:10", &["leaves the data folder", "make it relative"]),
    ("\"run_*.csv\"", "\"/etc/passwd\"", "4:10", &["leaves the data folder"]),
    ("\"run_*.csv\"", "\"a/../../run_*.csv\"", "4:10", &["leaves the data folder"]),
    ("\"run_*.csv\"", "\"C:\\\\run.csv\"", "4:10", &["leaves the data folder"]),
    ("\"run_*.csv\"", "\"~/run.csv\"", "4:10", &["leaves the data folder"]),
    ("\"run_*.csv\"", "\"\\\\\\\\server\\\\run.csv\"", "4:10", &["leaves the data folder"]),
    ("\"run_*.csv\"", "\"run_[.csv\"", "4:10", &["is malformed", "correct it"]),
    ("[\"run_*.csv\", \"run_*.parquet\"]", "[]", "3:", &["`files` is missing", "name the data files"]),
    ("[\"run_*.csv\", \"run_*.parquet\"]", "\"run_*.csv\"", "4:", &["expected a list"]),
    ("files = [\"run_*.csv\", \"run_*.parquet\"]", "", "3:", &["`files` is missing"]),
    ("files =", "fiels =", "4:", &["unknown field `fiels`", "did you mean `files`?"]),
    ("files =", "folder = \"../../etc\"\nfiles =", "4:", &["leaves the shared data"]),
    ("files =", "folder = \"/etc\"\nfiles =", "4:", &["leaves the shared data"]),
    ("files =", "separator = \"::\"\nfiles =", "4:", &["cannot be used"]),
    ("run_(.*)", "run_(", "5:", &["no regular expression"]),
    ("run_(.*)", "run_.*", "5:", &["has no group"]),
    ("run_(.*)", "(a{1000}){1000}", "5:", &["no regular expression"]),
    ("file = \"run_(.*)\"", "file = \"(.)\", column = \"c\"", "5:", &["delete one of them"]),
    ("time = { column = \"t\", unit = \"ms\" }", "", "3:", &["`time` is missing", "rate_hz = 20.0"]),
    ("unit = \"ms\"", "unit = \"fortnight\"", "6:", &["unknown unit \"fortnight\"", "known units"]),
    ("unit = \"ms\"", "unit = \"mm\"", "6:", &["\"mm\" is no unit of time"]),
    ("unit = \"ms\"", "unit = \"sample\"", "6:", &["counts samples; add rate_hz"]),
    ("unit = \"ms\"", "unit = \"sample\", rate_hz = 2e6", "6:", &["rate_hz is 2e6"]),
    ("unit = \"ms\"", "unit = \"ms\", rate_hz = nan", "6:", &["rate_hz is NaN", "above 0"]),
    ("unit = \"ms\"", "unit = \"ms\", rate_hz = inf", "6:", &["rate_hz is inf"]),
    ("unit = \"ms\"", "unit = \"ms\", rate_hz = 20.0", "6:", &["delete rate_hz"]),
    ("unit = \"ms\"", "rate_hz = -20.0", "6:", &["rate_hz is -20"]),
    ("unit = \"ms\"", "rate_hz = 20.0", "6:", &["without `unit`"]),
    ("column = \"t\", unit = \"ms\"", "rate_hz = 1e308", "6:20", &["rate_hz is 1e308", "give the samples per second"]),
    ("column = \"t\", unit = \"ms\"", "rate_hz = 1e-300", "6:20", &["rate_hz is 1e-300"]),
    ("column = \"y\"", "column = \"t\"", "13:", &["column \"t\" is the time", "cannot be an output"]),
    ("column = \"q\"", "column = \"t\"", "7:", &["column \"t\" is the time", "cannot be an actuator"]),
    ("name = \"small\"", "name = \"sm\\u001b[31mall\"", "2:8", &["has the control character \\u{1b}; delete it"]),
    ("name = \"small\"", "title = \"a\\u0007\"", "2:9", &["control character \\u{7}"]),
    ("name = \"small\"", "\"na\\u001bme\" = \"small\"", "2:1", &["control character \\u{1b}"]),
    ("name = \"small\"", "name = \"sm\u{1b}[31mall\"", "2:", &["sm?[31mall"]),
    (
        "\"deg\"\n[[context]]\ncolumn = \"h\"\nunit = \"cm\"",
        "\"degrees\"\n[[context]]\ncolumn = \"h\"\nunit = \"miles\"",
        "9:8",
        &["2 problems", "unknown unit \"degrees\"", "did you mean \"deg\"?", "rad", "bar", "\"miles\""],
    ),
    ("unit = \"deg\"", "unit = \"Deg\"", "9:8", &["did you mean \"deg\"?"]),
    ("unit = \"deg\"", "unit = \"deg\"\nunit = \"rad\"", "10:", &["the key is there twice", "delete one of the two"]),
    ("unit = \"deg\"", "unit = 5", "9:8", &["actuator[0].unit", "integer `5`, expected a text in quotes"]),
    ("unit = \"deg\"", "unit = deg", "9:", &["at `actuator.unit`", "text needs quotes"]),
    ("unit = \"deg\"", "unit = \"deg", "9:", &["at `actuator.unit`"]),
    ("unit = \"deg\"", "unit = \u{201c}deg\u{201d}", "9:", &["at `actuator.unit`"]),
    ("unit = \"deg\"", "", "7:", &["`unit` of \"q\" is missing", "\"1\" for a plain number"]),
    ("unit = \"deg\"", "unit = \"deg\"\nquantity = \"payload\"", "10:12", &["belongs to a [[context]]"]),
    ("unit = \"cm\"", "unit = \"cm\"\nquantity = \"lift\"", "13:12", &["unknown variant `lift`", "`altitude`"]),
    ("\"cm\"", "\"cm\"\nquantity = \"throttle\"", "13:12", &["\"cm\" is no unit of throttle", "delete `quantity`"]),
    (
        "\"cm\"",
        "\"cm\"\nquantity = \"altitude\"\n[[context]]\ncolumn = \"g\"\nunit = \"m\"\nquantity = \"altitude\"",
        "17:12",
        &["\"h\" is the altitude already"],
    ),
    ("unit = \"mm\"", "unit = \"mm\"\nat = 1.5", "16:6", &["at = 1.5", "up to 1 (the tip)"]),
    ("column = \"q\"", "colum = \"q\"", "8:1", &["field `colum`", "did you mean `column`?", "colum = \"q\"", "─────"]),
    ("column = \"h\"", "column = \"y\"", "10:", &["an output cannot be an input"]),
    ("column = \"h\"", "column = \"q\"", "10:", &["the name \"q\" is taken by [[actuator]] already", "add `name"]),
    ("[[actuator]]", "[[actuators]]", "7:", &["unknown field `actuators`", "did you mean `actuator`?"]),
    ("[[actuator]]", "[actuator]", "7:", &["expected a list"]),
    ("[table]", "[table", "3:", &["mend the TOML"]),
    ("[table]", "[tabel]", "3:", &["unknown field `tabel`", "did you mean `table`?"]),
    ("name = \"small\"", "name = \"small\"\nname = \"large\"", "3:", &["the key is there twice"]),
    ("name = \"small\"", "name = 'small", "2:", &["mend the TOML"]),
    ("name = \"small\"", "synthetic = \"yes\"", "2:", &["expected true or false"]),
    ("[\"c\"]", "[\"c\", \"a\"]", "20:18", &["trial \"a\" is in development already", "exactly one role"]),
    ("[\"c\"]", "[\"c\", \"c\"]", "20:", &["is in held_out already"]),
    ("[\"c\"]", "[\"c\\u009b2J\"]", "20:13", &["control character \\u{9b}"]),
    ("[\"c\"]", "[3]", "20:13", &["expected a text in quotes"]),
    ("held_out =", "held-out =", "20:", &["unknown field `held-out`", "did you mean `held_out`?"]),
];

/// What is put before `[roles]`, where the message is, and its words.
type Insertion = (&'static str, &'static str, &'static [&'static str]);

const INSERTIONS: &[Insertion] = &[
    ("[folds]\nvalidation = [\"a\"]", "17:", &["expected a list"]),
    ("[cut.a]\nhead = { until = 1.0 }", "17:", &["0 parts have no `until`", "the part has no role"]),
    (
        "[cut.b]\nhead = { until = nan, role = \"excluded\" }\ntail = { role = \"excluded\" }",
        "17:",
        &["until = NaN", "finite"],
    ),
    ("[cut.a]\ntail = { role = \"spare\" }", "17:", &["unknown variant `spare`", "`held_out`"]),
    ("[cut.a]\ntail = { role = \"excluded\" }", "21:", &["trial \"a\" is cut", "delete it here"]),
    ("[conditions.a]\np = { value = inf, unit = \"N\" }", "17:15", &["the value is inf", "finite"]),
    ("[conditions.a]\np = { value = 1, unit = \"kN/m\" }", "17:25", &["unknown unit \"kN/m\""]),
    ("[vehicle]\nposition = [\"a\"]\nunit = \"m\"", "17:12", &["1 columns of position; name three"]),
    (
        "[vehicle]\nposition = [\"a\", \"t\", \"b\"]\nunit = \"m\"",
        "17:18",
        &["column \"t\" is the time", "cannot be a position"],
    ),
    (
        "[[predicted]]\ncolumn = \"p\"\nunit = \"mm\"\n[[predicted]]\ncolumn = \"r\"\nunit = \"mm\"",
        "",
        &["2 [[predicted]] for 1 [[measured]]"],
    ),
    ("[arm]\nlength = { value = 620.0, unit = \"m\" }", "17:", &["the arm is 620 m long", "correct its unit"]),
    ("[arm]\nlength = { value = nan, unit = \"m\" }", "17:", &["the value is NaN"]),
    ("[arm]\nlength = { value = -1, unit = \"m\" }", "", &["the arm is -1 long"]),
    ("[arm]\nlength = { value = 1, unit = \"s\" }", "17:30", &["\"s\" is no length"]),
    ("[arm]\nlength = { value = 1, unit = \"m\" }", "", &["1 outputs; a marker has three"]),
];

/// The same below `[arm]` and its length.
const OF_THE_ARM: &[Insertion] = &[
    ("axis = \"up\"", "18:8", &["axis \"up\" is not one of x y z -x -y -z"]),
    ("down = \"south\"", "18:8", &["down \"south\" is not one of x y z -x -y -z"]),
    ("strain = { basis = \"spline\" }", "18:20", &["unknown basis \"spline\"", "legendre, piecewise"]),
    ("strain = { basis = \"piecewise\", oder = 1 }", "18:33", &["unknown field `oder`"]),
    ("actuation = { degree = 0 }", "18:", &["degree is 0; choose 1 to"]),
];

/// Manifests that are in order and do not agree with the data: exit code 3.
const OTHER_TRIALS: &[Edit] = &[
    ("[\"c\"]", "[\"c\", \"z\"]", "20:18", &["[roles] names trial `z`", "trials are a b c d", "correct the name"]),
    ("[\"c\"]", "[\"c\", \"\u{441}\"]", "20:18", &["[roles] names trial `\u{441}`", "trials are a b c d"]),
    (
        ", \"b\"]\nheld_out = [\"c\"]\n",
        "]\nheld_out = [\"c\"]\n[cut.b]\nhead = { until = 105.0, role = \"development\" }\ntail = { role = \"held_out\" }\n",
        "23",
        &["`b:tail` has 0 samples", "move `until`", "from 0 s to 5.9 s"],
    ),
];

/// The same for lines that are put before `[roles]`.
const DISAGREEMENTS: &[Insertion] = &[
    ("[folds]\nvalidation = [[\"a\"], [\"y\"]]", "17:23", &["[folds] names trial `y`", "correct the name"]),
    ("[folds]\nvalidation = [[\"a\"], []]", "17:", &["fold 1 has no trials", "name its validation trials"]),
    ("[folds]\nvalidation = [[\"a\"], [\"a\", \"b\"]]", "17:23", &["trial `a` is in folds 0 and 1", "delete one"]),
    (
        "[folds]\nvalidation = [[\"a\"], [\"c\"]]",
        "17:23",
        &["fold 1 names trial `c`, whose role is held_out", "move or delete it"],
    ),
    ("[cut.z]\nhead = { role = \"excluded\" }", "16:", &["[cut] names trial `z`"]),
    ("[conditions.z]\np = { value = 1, unit = \"N\" }", "16:", &["[conditions] names trial `z`", "delete it"]),
];

fn edits() -> Vec<Case> {
    let edit = |code: i32, from: &'static str, to: String, place: &str, words: &[&str]| {
        let said = Said::of(code, &format!("manifest.toml:{place}"), words);
        Case::new(format!("manifest: {}", to.replace('\n', " ")), said, move |set| set.edit(FILE, from, &to))
    };
    let before_roles = |code, above: &str, (lines, place, words): &Insertion| {
        edit(code, "[roles]", format!("{above}{lines}\n[roles]"), place, words)
    };
    let arm = "[arm]\nlength = { value = 1, unit = \"m\" }\n";
    let replaced = EDITS.iter().map(|(from, to, place, words)| edit(2, from, to.to_string(), place, words));
    let of_others = OTHER_TRIALS.iter().map(|(from, to, place, words)| edit(3, from, to.to_string(), place, words));
    let inserted = INSERTIONS.iter().map(|insertion| before_roles(2, "", insertion));
    let of_the_arm = OF_THE_ARM.iter().map(|insertion| before_roles(2, arm, insertion));
    let disagreements = DISAGREEMENTS.iter().map(|insertion| before_roles(3, "", insertion));
    replaced.chain(inserted).chain(of_the_arm).chain(of_others).chain(disagreements).collect()
}

fn sizes() -> Vec<Case> {
    let of = |said: Said, name: &str, text: String| {
        Case::new(format!("manifest: {name}"), said, move |set| set.write(FILE, &text))
    };
    let text = |name: &str, text: String, place: &str, words: &[&str]| {
        of(Said::of(2, &format!("manifest.toml{place}"), words), name, text)
    };
    let long = "x".repeat(200_000);
    let unknown: String = (0..20_000).map(|i| format!("\"x{i}\", ")).collect();
    let held_out = |names: &str| MANIFEST.replace("held_out = [", &format!("held_out = [{names}"));
    vec![
        text("10,000 brackets", format!("name = {}", "[".repeat(10_000)), ":1:", &["brackets"]),
        text("10,000 tables in one another", format!("name = {}", "{ a = ".repeat(10_000)), ":1:", &["brackets"]),
        text("a key of 10,000 parts", format!("{} = 1\n", vec!["a"; 10_000].join(".")), ":1:", &["brackets"]),
        text("10 MB", "# filler\n".repeat(10 << 17), ":1:1", &["larger than 1048576 bytes"]),
        text("a line of 200 kB", format!("name = \"{long}\"\nunit = 5\n"), ":2:1", &["unknown field `unit`"]),
        text("a key of 200 kB", format!("{long} = 5\n"), ":1:1", &["unknown field"]),
        text("a unit of 200 kB", MANIFEST.replace("\"deg\"", &format!("\"{long}\"")), ":9:", &["unknown unit"]),
        text("20,000 trials of two roles", held_out(&"\"a\", ".repeat(20_000)), ":19:", &["more; mend these first"]),
        of(Said::of(3, "manifest.toml:19:", &["more; mend these first"]), "20,000 unknown trials", held_out(&unknown)),
        of(
            Said::of(3, "run_a.csv", &["column `xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx…` is missing"]),
            "a column of 200 kB",
            MANIFEST.replace("\"q\"", &format!("\"{long}\"")),
        ),
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

/// Patterns that match no file, and links.
fn files() -> Vec<Case> {
    let edit = |said: Said, from: &'static str, to: &'static str| {
        Case::new(format!("manifest: {}", to.replace('\n', " ")), said, move |set| set.edit(FILE, from, to))
    };
    let patterns = "\"run_*.csv\", \"run_*.parquet\"]";
    let head = "name = \"small\"\n[table]\nfiles = [\"run_*.csv\", \"run_*.parquet\"]";
    let elsewhere =
        "name = \"small\"\nobtain = \"ask the authors\"\n[table]\nfolder = \"data/nowhere\"\nfiles = [\"walk_*\"]";
    let none = ["no data for `small`", "beside the manifest", "no file matches walk_*.csv", "--data DIR"];
    let nowhere =
        ["beside the manifest", "../shared/data/nowhere", "no such folder", "to obtain them: ask the authors"];
    let of_no_file = ["\"walk_*.csv\" matches no file", "correct `files`"];
    let no_trial = ["does not match the pattern \"run_([abc])\"", "rename the file"];
    let mut cases = vec![
        edit(Said::of(3, "data", &of_no_file), patterns, "\"walk_*.csv\", \"run_*.csv\"]"),
        edit(Said::of(3, "data", &none), patterns, "\"walk_*.csv\"]"),
        edit(Said::of(3, "data", &nowhere), head, elsewhere),
        edit(Said::of(3, "run_d.csv", &no_trial), "run_(.*)", "run_([abc])"),
        Case::new("no manifest", Said::of(4, "manifest.toml", &["cannot read", "check the path"]), |set| {
            std::fs::remove_file(set.file(FILE))
        }),
    ];
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;
        let link = |said: Said, file: &'static str, to: &'static str| {
            Case::new(format!("{file} is a link to {to}"), said, move |set| {
                set.write("elsewhere/run_b.csv", csv(&rows(1)))?;
                std::fs::remove_file(set.path().join(file))?;
                symlink(to, set.path().join(file))
            })
        };
        let said = |words: &[&str]| Said::of(3, "run_b.csv", words);
        let outside = "outside of the data folder";
        cases.extend([
            link(said(&["leads to", outside, "--data DIR"]), "run_b.csv", "../elsewhere/run_b.csv"),
            link(said(&["leads to", "passwd", outside]), "run_b.csv", "/etc/passwd"),
            link(Said::of(4, "run_b.csv", &["cannot read", "check the path"]), "run_b.csv", "nowhere.csv"),
            link(Said::of(3, "manifest.toml", &["names trial `b`"]), "run_b.csv", "/dev/zero"),
            link(Said::of(2, "manifest.toml", &["not a file"]), "manifest.toml", "/dev/zero"),
            Case::new("a folder that is a link and leaves", said(&[outside]), |set| {
                set.write("elsewhere/run_b.csv", csv(&rows(1)))?;
                std::fs::remove_file(set.file("data/run_b.csv"))?;
                symlink(set.file("elsewhere"), set.file("data/more"))?;
                set.edit(FILE, "[\"run_*.csv\"", "[\"more/run_*.csv\", \"run_*.csv\"")
            }),
        ]);
    }
    cases
}
