//! Faulty files made from a valid one: for every key a wrong type, a value out of range, `nan`, a typing error, the key
//! twice, brackets without end, and text that is no TOML.

use toml::Value;

use crate::whole::{ALL, Reader, Whole};

/// A spoiled file.
pub struct Case {
    /// Key and what was done to it.
    pub name: String,
    pub reader: Reader,
    pub file: &'static str,
    pub text: String,
    /// Line of the spoiled key, and the bytes of that line.
    pub line: usize,
    pub length: usize,
    /// Name that a message must give it.
    pub key: String,
}

/// Values of the right type that cannot be, by the end of the dotted key.
const OUT_OF_RANGE: &[(&str, &[&str])] = &[
    ("device", &["\"abacus\""]),
    ("data", &["\"\""]),
    ("nominal.model", &["\"magic\""]),
    ("nominal.length", &["0.0", "-0.62", "620.0"]),
    ("nominal.axis", &["\"up\""]),
    ("nominal.degree", &["0", "10", "9223372036854775807"]),
    ("nominal.steps", &["0", "-1", "1000000"]),
    ("nominal.tolerance", &["0.0", "-1e-9"]),
    ("comparator_degree", &["0", "99"]),
    ("strain.basis", &["\"spline\""]),
    ("strain.order", &["65", "-1"]),
    ("strain.segments", &["0", "65"]),
    ("inputs.channels", &["[]", "[\"q1\", \"q1\"]"]),
    ("domain_filter", &["\"sphere\""]),
    ("learn_from", &["[]", "[\"held_out\"]", "[\"everything\"]"]),
    ("shuffled", &["[\"q1\", \"q1\"]"]),
    ("windows.length", &["0", "-5", "9223372036854775807"]),
    ("windows.reach", &["9", "-50", "2000000"]),
    ("windows.stride", &["0", "-1", "9223372036854775807"]),
    ("evaluation_stride", &["0", "9223372036854775807"]),
    ("max_gap", &["0.0", "-0.5"]),
    ("windows.target", &["\"first\""]),
    ("elapsed", &["\"guessed\""]),
    ("memory.state", &["\"week\""]),
    ("memory.length", &["0", "-4", "2000000"]),
    ("burn_in", &["200", "-1"]),
    ("epoch_steps", &["0", "-1"]),
    ("first_values", &["\"zeros\""]),
    ("network.kind", &["\"lstm\""]),
    ("network.units", &["0", "-4", "9000"]),
    ("network.corrects", &["[]", "[\"base\"]"]),
    ("network.mode", &["\"fast\""]),
    ("backbone_units", &["0", "100000"]),
    ("backbone_layers", &["1000"]),
    ("activation", &["\"step\""]),
    ("network.hidden", &["[64, 0]", "[100000]"]),
    ("network.layers", &["0", "65"]),
    ("training.epochs", &["0", "-1", "10000000", "1e18", "60.0"]),
    ("training.batch", &["0", "-64", "10000000"]),
    ("training.learning_rate", &["0.0", "-1e-3", "1e3"]),
    ("optimizer", &["\"sgd\""]),
    ("weight_decay", &["-0.1", "1e300"]),
    ("warm_up", &["-1", "9223372036854775807"]),
    ("clip_norm", &["0.0", "-1.0"]),
    ("dropout", &["1.0", "-0.1"]),
    ("training.patience", &["-1", "9223372036854775807"]),
    ("ensemble", &["0", "-1", "100000"]),
    ("output_layer", &["\"ones\""]),
    ("schedule.kind", &["\"zigzag\""]),
    ("schedule.patience", &["-5", "9223372036854775807"]),
    ("schedule.factor", &["0.0", "1.5", "-0.5"]),
    ("schedule.floor", &["-0.1", "1.1"]),
    ("schedule.every", &["0", "9223372036854775807"]),
    ("baseline.kind", &["\"forest\""]),
    ("baseline.lags", &["0", "51", "[]", "[50]"]),
    ("penalties", &["[]", "[-1.0]"]),
    ("rounds", &["0", "1000000000000"]),
    ("baseline.patience", &["0"]),
    ("baseline.learning_rate", &["0.0", "1.5"]),
    ("depth", &["0", "65"]),
    ("leaf_windows", &["-1"]),
    ("penalty", &["-1.0"]),
    ("chosen_from", &["[]", "[\"q1\", \"q1\"]"]),
    ("leave_out", &["\"\""]),
    ("validation_fold", &["2", "-1"]),
    ("seeds", &["[]", "[1, 1]", "[-1]", "[1.5]", "[1e3]", "[true]", "[\"1\"]"]),
    ("folds", &["[]", "[[]]", "[[\"1\", \"1\"]]"]),
    ("protocol.held_out", &["[]", "[\"10\", \"10\"]"]),
    ("study", &["\"guess\""]),
    ("experiment", &["\"none.toml\""]),
    ("only", &["[\"GRU\"]", "[]"]),
    ("sampler", &["\"magic\""]),
    ("sweep.count", &["0", "-1", "100000"]),
    ("sweep.batch", &["0", "100000"]),
    ("\"windows.length\"", &["[]", "[0]", "5", "{ low = 5, high = 2 }", "{ low = 1, high = 5, step = 2 }"]),
    (
        "\"training.learning_rate\"",
        &[
            "{ low = 0.0, high = 1e-2, log = true }",
            "{ low = 1e-4, high = 1e-2, steps = 1 }",
            "{ low = 0.2, high = 0.8, whole = true }",
            "{ low = 1e-4, high = 1e300 }",
            "{ low = 1e-4, high = 1e-2, steps = 1000000 }",
            "[0.0]",
        ],
    ),
    ("nominal_study.bins", &["0", "7", "1001"]),
    ("orders", &["[]", "[9]", "[1, 1]"]),
    ("roles", &["[]", "[\"spare\"]"]),
    ("residual_study.bins", &["1", "1001"]),
    ("least_in_bin", &["1", "-1"]),
    ("backbones", &["21"]),
    ("altitude_tolerance", &["-0.1"]),
    ("slice_tolerance", &["-0.1"]),
    ("loss", &["\"hinge\""]),
    ("data.kind", &["\"stream\""]),
    ("data.training", &["0", "9223372036854775807", "10000000"]),
    ("data.validation", &["0.0", "1.0"]),
    ("data.test", &["0"]),
    ("data.length", &["2", "5000"]),
    ("data.step", &["0.0", "-1.0"]),
    ("control.epochs", &["0"]),
    ("control.elapsed", &["\"measured\""]),
    ("data.files", &["[]"]),
    ("data.inputs", &["[]"]),
    ("data.targets", &["[]"]),
    ("data.ahead", &["2"]),
    ("time_unit", &["\"mm\"", "\"fortnight\"", "\"\""]),
    (
        "table.files",
        &["[\"../*.csv\"]", "[\"/etc/*.csv\"]", "[\"C:\\\\data\\\\*.csv\"]", "[\"~/x.csv\"]", "[\"[.csv\"]"],
    ),
    ("table.ignore", &["[\"../*.csv\"]"]),
    ("table.folder", &["\"/data\"", "\"../..\""]),
    ("separator", &["\"x\"", "\"\"", "\"tab\""]),
    ("decimal", &["\"x\"", "\"\""]),
    ("trial.file", &["\"(\"", "\".*\""]),
    ("rate_hz", &["0.0", "-20.0"]),
    ("time.unit", &["\"fortnight\"", "\"mm\""]),
    ("actuator.unit", &["\"degrees\"", "\"\""]),
    ("quantity", &["\"lift\"", "\"throttle\""]),
    ("measured.unit", &["\"s\"", "\"metre\""]),
    ("measured.at", &["0.0", "1.5", "-1.0"]),
    ("position", &["[\"px\"]", "[]"]),
    ("vehicle.unit", &["\"s\""]),
    ("attitude_unit", &["\"m\""]),
    ("arm.axis", &["\"up\""]),
    ("arm.down", &["\"south\""]),
    ("arm.steps", &["0", "9223372036854775807"]),
    ("arm.tolerance", &["0.0"]),
    ("length.value", &["0.0", "-1.0"]),
    ("length.unit", &["\"s\"", "\"furlong\""]),
    ("arm.strain.basis", &["\"spline\""]),
    ("arm.strain.order", &["65"]),
    ("actuation.degree", &["0", "99"]),
    ("registration.kind", &["\"loose\"", "\"identified\""]),
    ("rotation", &["[0.0]"]),
    ("development", &["[\"b\", \"a\"]"]),
    ("payload", &["{ value = nan, unit = \"g\" }", "{ value = 1.0 }", "{ value = 1.0, unit = \"stone\" }"]),
    ("head", &["{ until = 5.0 }", "{ role = \"development\" }", "{ until = 5.0, role = \"spare\" }"]),
];

/// Keys whose text may be anything.
const FREE: &[&str] = &["title", "licence", "source", "obtain", "name", "question", "augmented_sha256"];

/// Returns every spoiled file, in the order of the files and of their lines.
pub fn all() -> Vec<Case> {
    ALL.iter().flat_map(of).collect()
}

fn of(whole: &'static Whole) -> Vec<Case> {
    let mut table = String::new();
    let mut cases = vec![];
    for (index, line) in whole.text.lines().enumerate() {
        match line.split_once(" = ") {
            Some((key, value)) => cases.extend(spoil(whole, &table, index, key, value)),
            None => {
                table = line.trim_matches(['[', ']']).to_string();
                cases.extend(headers(whole, index, line));
            }
        }
    }
    cases
}

fn spoil(whole: &'static Whole, table: &str, index: usize, key: &str, value: &str) -> Vec<Case> {
    let dotted = if table.is_empty() { key.to_string() } else { format!("{table}.{key}") };
    let last = if key.starts_with('"') { key.trim_matches('"') } else { key.rsplit('.').next().unwrap_or(key) };
    let case = |what: &str, line: String, named: &str| Case {
        name: format!("{}: {dotted}: {what}", whole.file),
        reader: whole.reader,
        file: whole.file,
        text: with_line(whole.text, index, &line),
        line: index + 1,
        length: line.lines().last().unwrap_or_default().chars().count(),
        key: named.to_string(),
    };
    let mut cases = vec![];
    for (what, bad) in wrong_types(value) {
        cases.push(case(what, format!("{key} = {bad}"), last));
    }
    for bad in OUT_OF_RANGE.iter().filter(|(end, _)| ends(&dotted, end)).flat_map(|(_, values)| *values) {
        if fits(value, bad) && *bad != value {
            cases.push(case(&format!("is {bad}"), format!("{key} = {bad}"), last));
        }
    }
    // the names of trials, of conditions and of parts are the user's own
    let own = ["conditions", "cut", "set"].iter().any(|free| table.starts_with(free) || key.starts_with("set."));
    if !own && !key.starts_with('"') {
        let slip = slip(key);
        cases.push(case("misspelt", format!("{slip} = {value}"), &slip));
    }
    cases.push(Case { line: index + 2, ..case("twice", format!("{key} = {value}\n{key} = {value}"), last) });
    cases.push(case("brackets", format!("{key} = {}", "[".repeat(10_000)), last));
    cases.push(case("no value", format!("{key} ="), last));
    cases.push(case("two equals signs", format!("{key} = = {value}"), last));
    if value.starts_with('"') && !FREE.contains(&key) {
        cases.push(case("without quotes", format!("{key} = {}", value.trim_matches('"')), last));
    }
    if value.contains('.') && value.parse::<f64>().is_ok() {
        cases.push(case("decimal comma", format!("{key} = {}", value.replace('.', ",")), last));
    }
    cases
}

/// Returns the cases with an unknown table name.
fn headers(whole: &'static Whole, index: usize, line: &str) -> Vec<Case> {
    let name = line.trim_matches(['[', ']']);
    // a table that has others below it stays there when its own header is spoiled
    if name.contains('.') || name.is_empty() || whole.text.contains(&format!("[{name}.")) {
        return vec![];
    }
    let slip = slip(name);
    let line = line.replace(name, &slip);
    vec![Case {
        name: format!("{}: [{name}]: misspelt", whole.file),
        reader: whole.reader,
        file: whole.file,
        text: with_line(whole.text, index, &line),
        line: index + 1,
        length: line.len(),
        key: slip,
    }]
}

/// Exchanges two letters, or doubles the last one.
fn slip(name: &str) -> String {
    let mut letters: Vec<char> = name.chars().collect();
    let n = letters.len();
    if n > 3 && letters[n - 2] != letters[n - 1] {
        letters.swap(n - 2, n - 1);
        letters.into_iter().collect()
    } else {
        format!("{name}{}", letters.last().unwrap_or(&'x'))
    }
}

fn wrong_types(value: &str) -> Vec<(&'static str, &'static str)> {
    match format!("x = {value}").parse::<toml::Table>().ok().and_then(|mut t| t.remove("x")) {
        Some(Value::String(_)) => vec![("a number for a text", "17"), ("a list for a text", "[\"a\"]")],
        Some(Value::Integer(_)) => {
            vec![
                ("a text for a count", "\"many\""),
                ("a fraction for a count", "1.5"),
                ("nan for a count", "nan"),
                ("beyond 64 bits with a sign", "18446744073709551615"),
                ("beyond 128 bits", "-999999999999999999999999999999999999999999"),
            ]
        }
        Some(Value::Float(_)) => {
            vec![("a text for a number", "\"much\""), ("nan", "nan"), ("infinity", "-inf"), ("too large", "1e999")]
        }
        Some(Value::Boolean(_)) => vec![("a text for a truth", "\"yes\""), ("a number for a truth", "1")],
        Some(Value::Array(_)) => vec![("a number for a list", "7"), ("a table in a list", "[{ a = { b = 1 } }]")],
        Some(Value::Table(_)) => vec![("a number for a table", "7")],
        _ => vec![],
    }
}

/// Returns whether a value is meant for the key as it stands here: `lags` is a number in one file and a list in
/// another.
fn fits(value: &str, bad: &str) -> bool {
    value.starts_with('[') == bad.starts_with('[') || value.starts_with('{') || bad.starts_with('{') || bad == "5"
}

fn ends(dotted: &str, end: &str) -> bool {
    dotted == end || dotted.ends_with(&format!(".{end}"))
}

fn with_line(text: &str, index: usize, line: &str) -> String {
    let lines = text.lines().enumerate().map(|(i, old)| if i == index { line } else { old });
    lines.map(|line| format!("{line}\n")).collect()
}
