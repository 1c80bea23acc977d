//! Manifests that are refused: exit code 2, line and column, the key underlined, and a remedy.

use acm_datasets::DataError;

use super::set::Set;

/// Text to replace, its replacement, and what the message must contain.
const CASES: &[(&str, &str, &[&str])] = &[
    (
        "column = \"q\"",
        "colum = \"q\"",
        &["manifest.toml:8:1", "unknown field `colum`", "`column`", "colum = \"q\"", "─────"],
    ),
    (
        "unit = \"deg\"",
        "unit = 5",
        &["manifest.toml:9:8", "actuator[0].unit", "invalid type: integer `5`, expected a text in quotes"],
    ),
    (
        "unit = \"deg\"",
        "unit = \"degrees\"",
        &["manifest.toml:9:8", "unknown unit \"degrees\"", "did you mean \"deg\"?", "rad", "bar"],
    ),
    ("unit = \"deg\"", "", &["manifest.toml:7", "`unit` of \"q\" is missing", "\"1\" for a plain number"]),
    ("name = \"small\"", "name = \"small", &["manifest.toml:2"]),
    ("unit = \"ms\" }", "unit = \"ms\", rate_hz = nan }", &["manifest.toml:6", "rate_hz is NaN", "above 0"]),
    (
        "{ column = \"t\", unit = \"ms\" }",
        "{ rate_hz = 1e308 }",
        &["manifest.toml:6:20", "rate_hz is 1e308", "samples per second"],
    ),
    ("{ column = \"t\", unit = \"ms\" }", "{ rate_hz = 1e-300 }", &["manifest.toml:6:20", "rate_hz is 1e-300"]),
    ("unit = \"ms\" }", "unit = \"sample\", rate_hz = 2e6 }", &["manifest.toml:6", "rate_hz is 2e6"]),
    (", unit = \"ms\" }", ", rate_hz = 20.0 }", &["manifest.toml:6", "without `unit`"]),
    ("column = \"y\"", "column = \"t\"", &["manifest.toml:13", "column \"t\" is the time", "cannot be an output"]),
    ("column = \"q\"", "column = \"t\"", &["manifest.toml:7", "column \"t\" is the time", "cannot be an actuator"]),
    (
        "[roles]",
        "[vehicle]\nposition = [\"a\", \"t\", \"b\"]\nunit = \"m\"\n[roles]",
        &["manifest.toml:17:18", "column \"t\" is the time", "cannot be a position"],
    ),
    (
        "name = \"small\"",
        "name = \"sm\\u001b[31mall\"",
        &["manifest.toml:2:8", "the text has the control character \\u{1b}; delete it"],
    ),
    ("name = \"small\"", "title = \"a\\u0007\"", &["manifest.toml:2:9", "control character \\u{7}"]),
    ("held_out = [\"c\"]", "held_out = [\"c\\u009b2J\"]", &["manifest.toml:19:13", "control character \\u{9b}"]),
    ("name = \"small\"", "\"na\\u001bme\" = \"small\"", &["manifest.toml:2:1", "control character \\u{1b}"]),
    ("name = \"small\"", "name = \"sm\u{1b}[31mall\"", &["manifest.toml:2:", "sm?[31mall"]),
    ("unit = \"ms\" }", "unit = \"ms\", rate_hz = 20.0 }", &["manifest.toml:6", "delete rate_hz"]),
    ("unit = \"ms\" }", "unit = \"sample\" }", &["manifest.toml:6", "counts samples; add rate_hz"]),
    ("unit = \"ms\" }", "unit = \"mm\" }", &["manifest.toml:6", "\"mm\" is no unit of time"]),
    ("time = { column = \"t\", unit = \"ms\" }", "", &["manifest.toml:3", "`time` is missing", "rate_hz = 20.0"]),
    ("files = [\"run_*.csv\"]", "", &["manifest.toml:3", "`files` is missing"]),
    ("run_*.csv", "../run_*.csv", &["manifest.toml:4:10", "leaves the data folder"]),
    ("run_*.csv", "run_[.csv", &["manifest.toml:4:10", "malformed"]),
    ("run_(.*)", "run_.*", &["manifest.toml:5", "has no group"]),
    ("run_(.*)", "run_(", &["manifest.toml:5", "no regular expression"]),
    (
        "trial = { file = \"run_(.*)\" }",
        "trial = { file = \"(.)\", column = \"c\" }",
        &["manifest.toml:5", "delete one of them"],
    ),
    ("column = \"h\"", "column = \"q\"", &["manifest.toml:10", "the name \"q\" is taken by [[actuator]]", "add `name"]),
    ("column = \"h\"", "column = \"y\"", &["manifest.toml:10", "an output cannot be an input"]),
    ("[roles]", "[arm]\nlength = { value = inf, unit = \"m\" }\n[roles]", &["the value is inf", "finite"]),
    ("[roles]", "[arm]\nlength = { value = 1, unit = \"s\" }\n[roles]", &["manifest.toml:17:30", "\"s\" is no length"]),
    ("[roles]", "[arm]\nlength = { value = -1, unit = \"m\" }\n[roles]", &["the arm is -1 long"]),
    (
        "[roles]",
        "[arm]\nlength = { value = 1, unit = \"m\" }\naxis = \"up\"\n[roles]",
        &["manifest.toml:18:8", "axis \"up\" is not one of x y z -x -y -z"],
    ),
    (
        "[roles]",
        "[arm]\nlength = { value = 1, unit = \"m\" }\ndown = \"south\"\n[roles]",
        &["manifest.toml:18:8", "down \"south\" is not one of x y z -x -y -z"],
    ),
    (
        "unit = \"cm\"",
        "unit = \"cm\"\nquantity = \"throttle\"",
        &["manifest.toml:13:12", "\"cm\" is no unit of throttle", "delete `quantity`"],
    ),
    (
        "unit = \"cm\"",
        "unit = \"cm\"\nquantity = \"lift\"",
        &["manifest.toml:13:12", "unknown variant `lift`", "`altitude`"],
    ),
    ("unit = \"deg\"", "unit = \"deg\"\nquantity = \"payload\"", &["manifest.toml:10:12", "belongs to a [[context]]"]),
    (
        "unit = \"cm\"",
        "unit = \"cm\"\nquantity = \"altitude\"\n[[context]]\ncolumn = \"g\"\nunit = \"m\"\nquantity = \"altitude\"",
        &["manifest.toml:17:12", "\"h\" is the altitude already"],
    ),
    (
        "[roles]",
        "[arm]\nlength = { value = 1, unit = \"m\" }\nstrain = { basis = \"spline\" }\n[roles]",
        &["manifest.toml:18:20", "unknown basis \"spline\"", "legendre, piecewise"],
    ),
    (
        "[roles]",
        "[arm]\nlength = { value = 1, unit = \"m\" }\nstrain = { basis = \"piecewise\", oder = 1 }\n[roles]",
        &["manifest.toml:18:33", "unknown field `oder`"],
    ),
    (
        "[roles]",
        "[arm]\nlength = { value = 1, unit = \"m\" }\nactuation = { degree = 0 }\n[roles]",
        &["manifest.toml:18", "degree is 0; choose 1 to"],
    ),
    ("[roles]", "[arm]\nlength = { value = 1, unit = \"m\" }\n[roles]", &["1 outputs; a marker has three"]),
    ("unit = \"mm\"", "unit = \"mm\"\nat = 1.5", &["manifest.toml:16:6", "at = 1.5", "up to 1 (the tip)"]),
    (
        "[roles]",
        "[[predicted]]\ncolumn = \"p\"\nunit = \"mm\"\n[[predicted]]\ncolumn = \"r\"\nunit = \"mm\"\n[roles]",
        &["2 [[predicted]] for 1 [[measured]]"],
    ),
    (
        "[roles]",
        "[vehicle]\nposition = [\"a\"]\nunit = \"m\"\n[roles]",
        &["manifest.toml:17:12", "1 columns of position; name three"],
    ),
    (
        "held_out = [\"c\"]",
        "held_out = [\"c\", \"a\"]",
        &["manifest.toml:19:18", "trial \"a\" is in development already", "exactly one role"],
    ),
    ("held_out = [\"c\"]", "held_out = [3]", &["manifest.toml:19:13", "expected a text in quotes"]),
    ("[roles]", "[cut.a]\nhead = { until = 1.0 }\n[roles]", &["0 parts have no `until`", "the part has no role"]),
    (
        "[roles]",
        "[cut.a]\nhead = { until = nan, role = \"excluded\" }\ntail = { role = \"excluded\" }\n[roles]",
        &["until = NaN", "finite"],
    ),
    (
        "[roles]",
        "[cut.a]\ntail = { role = \"spare\" }\n[roles]",
        &["manifest.toml:17", "unknown variant `spare`", "`held_out`"],
    ),
    (
        "[roles]",
        "[cut.a]\ntail = { role = \"excluded\" }\n[roles]",
        &["manifest.toml:20", "trial \"a\" is cut", "delete it here"],
    ),
    (
        "[roles]",
        "[conditions.a]\np = { value = nan, unit = \"N\" }\n[roles]",
        &["manifest.toml:17:15", "the value is NaN"],
    ),
    (
        "[roles]",
        "[conditions.a]\np = { value = 1, unit = \"kN/m\" }\n[roles]",
        &["manifest.toml:17:25", "unknown unit \"kN/m\""],
    ),
];

#[test]
fn every_refusal_has_line_column_and_remedy() {
    let mut failures = Vec::new();
    for (from, to, expected) in CASES {
        let set = Set::new();
        set.edit("manifest.toml", from, to);
        let error = set.read().err();
        let code = error.as_ref().map_or(0, DataError::exit_code);
        let message = error.map_or(String::new(), |e| e.to_string());
        let missing: Vec<_> = expected.iter().filter(|e| !message.contains(**e)).collect();
        if code != 2 || !missing.is_empty() || message.contains(|c: char| c.is_control() && c != '\n') {
            failures.push(format!("{from:?} → {to:?}: code {code}, without {missing:?}:\n{message}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn a_huge_manifest_is_a_mistake_and_is_not_parsed() {
    let set = Set::new();
    set.write("manifest.toml", &"# padding\n".repeat(200_000));
    let message = set.error();
    assert!(message.contains("larger than 1048576 bytes"), "{message}");
    assert!(message.len() < 500);
}

#[test]
fn all_problems_of_a_manifest_are_printed() {
    let set = Set::new();
    set.edit("manifest.toml", "unit = \"deg\"", "unit = \"degrees\"").edit(
        "manifest.toml",
        "unit = \"mm\"",
        "unit = \"miles\"",
    );
    let message = set.error();
    assert!(
        message.contains("2 problems") && message.contains("\"degrees\"") && message.contains("\"miles\""),
        "{message}"
    );
}
