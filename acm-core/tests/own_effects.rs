//! Files of effects that are wrong are refused with effect, key, value and remedy; nothing panics on any text.

use acm_core::effects::own::{Own, read};
use acm_core::rig::{Rig, Signal};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const WHOLE: &str = r#"[[effect]]
name = "soft"
place = "actuators"
unit = "kPa"
carriers = ["T"]
rate = { p = "(q - p)/tau" }
start = { p = "q" }
output = "p + g*c*(T - T0)"
[effect.inputs]
T = { signal = "carrier", unit = "K" }
[effect.constants]
T0 = { value = 293, unit = "K" }
c = { value = 1, unit = "kPa/K" }
[effect.parameters]
tau = { unit = "ms", silent = 0, bounds = [0, 5000], guesses = [200] }
g = { silent = 0, bounds = [-1, 1], guesses = [0.1] }
"#;

fn rig() -> Rig {
    let signal =
        |name: &str, unit: &str, low: f64, high: f64| Signal { name: name.into(), unit: unit.into(), low, high };
    Rig {
        actuators: vec![signal("p1", "Pa", 0.0, 1e5), signal("p2", "Pa", 0.0, 2e5)],
        contexts: vec![signal("T", "K", 290.0, 310.0), signal("h", "m", 0.0, 1.0)],
        outputs: vec![signal("F", "N", -5.0, 5.0)],
        throttle: None,
        altitude: None,
        payload: None,
        carried: false,
        arm: None,
        step: 0.01,
        duration: 10.0,
    }
}

/// What reading and binding say; nothing where both succeed.
fn said(text: &str) -> Option<String> {
    let found = read(text, "own.toml").and_then(|all| all.iter().try_for_each(|one| Own::new(one, &rig()).map(drop)));
    found.err().map(|error| error.to_string())
}

#[test]
fn the_whole_is_sound() {
    assert_eq!(said(WHOLE), None);
}

/// Edits of the sound file, and what must be said.
const WRONG: &[(&str, &str, &[&str])] = &[
    ("\"soft\"", "\"Soft\"", &["`name`", "\"Soft\"", "lower-case"]),
    ("\"soft\"", "\"backlash\"", &["`name`", "which the library has", "my_backlash"]),
    ("\"soft\"", "\"\"", &["`name`", "lower-case"]),
    ("\"soft\"", "7", &["line 2", "string"]),
    ("place = \"actuators\"", "place = \"base\"", &["`base`", "actuators"]),
    ("place = \"actuators\"", "", &["missing field `place`"]),
    ("unit = \"kPa\"", "unit = \"m\"", &["`output`", "one side is m", "effect \"soft\""]),
    ("unit = \"kPa\"", "unit = \"psi\"", &["`unit`", "`psi` is no known unit", "kPa"]),
    ("unit = \"kPa\"", "columns = [\"p3\"]\nunit = \"kPa\"", &["`columns`", "\"p3\"", "p1 p2"]),
    ("unit = \"kPa\"", "columns = [\"p1\", \"p1\"]\nunit = \"kPa\"", &["`columns`", "twice"]),
    ("[\"T\"]", "[\"h\"]", &["`carriers`", "\"h\"", "K", "m"]),
    ("[\"T\"]", "[\"warmth\"]", &["`carriers`", "\"warmth\"", "p1 p2 T h"]),
    ("carriers = [\"T\"]", "", &["`inputs.T.signal`", "carriers = "]),
    ("(q - p)/tau", "(q - p)/tau/tau", &["`rate.p`", "must be"]),
    ("(q - p)/tau", "(q - tau)/tau", &["`rate.p`", "in `(q - tau)`", "Pa", " s", "both sides"]),
    ("(q - p)/tau", "(q - p", &["`rate.p`", "character 7", "`)`"]),
    ("(q - p)/tau", "(q - p)//tau", &["`rate.p`", "`/` stands"]),
    ("(q - p)/tau", "(q - p)/lag", &["`rate.p`", "no `lag`", "names here", "tau"]),
    ("(q - p)/tau", "softly(q - p)/tau", &["no function `softly`", "tanh"]),
    ("(q - p)/tau", "max(q)/tau", &["max has 1 argument", "2"]),
    ("(q - p)/tau", "exp(q)/tau", &["in `q`", "Pa where a number"]),
    ("(q - p)/tau", "2q/tau", &["`*` between a number and a name"]),
    ("(q - p)/tau", "0 < q < p", &["`&&`"]),
    ("(q - p)/tau", "if(q, p, q)/tau", &["comparison is needed"]),
    ("(q - p)/tau", "(q > p)/tau", &["comparison where a number"]),
    ("(q - p)/tau", "q^p/tau", &["`rate.p`", "in `p`"]),
    ("(q - p)/tau", "1e999*(q - p)/tau", &["`1e999` is no number"]),
    ("start = { p = \"q\" }", "start = { r = \"q\" }", &["`start.r`", "no state"]),
    ("start = { p = \"q\" }", "start = { p = \"q\" }\nstatic = \"q\"", &["more than one equation"]),
    ("rate = { p = \"(q - p)/tau\" }\nstart = { p = \"q\" }", "", &["no equation", "`static`"]),
    ("rate = { p", "rate = { p1 = \"0\", p2 = \"0\", p3 = \"0\", p4 = \"0\", p5 = \"0\", p6 = \"0\", p", &["7 states"]),
    ("output = \"p + g*c*(T - T0)\"", "", &["`output`", "missing"]),
    ("output = \"p + g*c*(T - T0)\"", "output = { x = \"p\" }", &["`output.x`", "q"]),
    ("output = \"p + g*c*(T - T0)\"", "output = 3", &["an expression in quotes"]),
    ("p + g*c*(T - T0)", "p + g*c*(T - T0) + 3", &["`output`", "at character 1", "Pa", "a number"]),
    ("p + g*c*(T - T0)", "0.5*p + g*c*(T - T0)", &["`silent`", "not silent", "50 %"]),
    ("(q - p)/tau", "(q - p)*abs(q/p)/tau", &["`silent`", "without end", "let a size multiply"]),
    ("p + g*c*(T - T0)", "p/sqrt(g - 0.1)", &["`guesses`", "no finite result", "g = 0.1"]),
    (
        "T = { signal = \"carrier\", unit = \"K\" }",
        "T = { signal = \"heat\", unit = \"K\" }",
        &["`inputs.T`", "\"heat\"", "signals: p1"],
    ),
    ("T = { signal = \"carrier\", unit = \"K\" }", "T = { signal = \"T\" }", &["`inputs.T.unit`", "missing"]),
    (
        "T = { signal = \"carrier\", unit = \"K\" }",
        "T = { signal = \"T\", unit = \"K\", window = \"tau\" }",
        &["`inputs.T.window`"],
    ),
    ("T = { signal", "exp = { signal", &["`inputs.exp`", "taken"]),
    ("value = 293", "value = nan", &["`constants.T0.value`", "NaN"]),
    ("bounds = [0, 5000]", "bounds = [5000, 0]", &["`parameters.tau.bounds`", "smallest"]),
    ("bounds = [0, 5000]", "bounds = [0, inf]", &["`parameters.tau.bounds`", "finite"]),
    ("guesses = [200]", "guesses = [9000]", &["`parameters.tau.guesses`", "9000"]),
    ("guesses = [200]", "guesses = []", &["`parameters.tau.guesses`", "1 to 50"]),
    ("guesses = [200]", "guess = [200]", &["unknown field `guess`", "guesses"]),
    ("silent = 0, bounds = [0, 5000]", "silent = -3, bounds = [0, 5000]", &["`parameters.tau.silent`"]),
    ("output =", "steps = 0\noutput =", &["`steps`", "1 to 64"]),
    ("[[effect]]", "[effects]", &["own.toml", "effect"]),
];

#[test]
fn what_is_wrong_is_said_with_its_place_and_a_remedy() {
    let mut unsaid = vec![];
    for (from, to, parts) in WRONG {
        assert!(WHOLE.contains(from), "{from}");
        let said = said(&WHOLE.replacen(from, to, 1)).unwrap_or_else(|| "accepted".into());
        let all = parts.iter().chain(&["own.toml: "]);
        unsaid.extend(all.filter(|part| !said.contains(*part)).map(|part| format!("{to}: {part:?} is not in: {said}")));
    }
    assert!(unsaid.is_empty(), "{}", unsaid.join("\n"));
    let without_sizes = WHOLE.replace("silent = 0, ", "");
    assert!(said(&without_sizes).expect("refused").contains("has no size"));
    assert!(said("").expect("refused").contains("missing field `effect`"));
    assert!(said("effect = []").expect("refused").contains("is empty"));
    assert!(said(&[WHOLE, WHOLE].concat()).expect("refused").contains("is there twice"));
    let deep = WHOLE.replace("(q - p)/tau", &format!("{}q{}", "(".repeat(400), ")".repeat(400)));
    assert!(said(&deep).expect("refused").contains("within each other"));
    let signs = WHOLE.replace("(q - p)/tau", &format!("{}q", "-".repeat(900)));
    assert!(said(&signs).expect("refused").contains("within each other"));
    let powers = WHOLE.replace("(q - p)/tau", &format!("q{}", "^2".repeat(400)));
    assert!(said(&powers).is_some());
    let long = WHOLE.replace("(q - p)/tau", &"q + ".repeat(600));
    assert!(said(&long).expect("refused").contains("1000 characters"));
    let sums = WHOLE.replace("(q - p)/tau", &format!("(q - p)/tau{}", " + 0".repeat(240)));
    assert_eq!(said(&sums), None);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, rng_seed: RngSeed::Fixed(1), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_text_panics(text in "\\PC*") {
        said(&text);
        said(&WHOLE.replace("kPa/K", &text.replace(['"', '\\'], "")));
    }

    #[test]
    fn no_expression_panics(text in "[qpT0-9.()+*/^<>=!&|, a-ex-z-]{0,60}") {
        said(&WHOLE.replace("(q - p)/tau", &text));
    }

    /// Bytes of a sound file that are changed.
    #[test]
    fn no_change_panics(at in 0..WHOLE.len(), to in any::<char>(), cut in 0usize..20) {
        let mut text: String = WHOLE.chars().take(at).collect();
        text.push(to);
        text.extend(WHOLE.chars().skip(at + cut));
        said(&text);
    }
}
