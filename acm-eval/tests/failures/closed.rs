//! `acm-eval close-loop FOLDER`, and what its loop.json says, of format 1 (bbce5cc) and of format 2 alike.

use std::fmt;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::rig::Rig;

/// A run that ended.
pub struct Closed {
    /// loop.json.
    pub found: Value,
    /// Whether a model was handed out as `model.json`.
    pub has_model: bool,
}

/// A fitted value with its 95 % interval, SI.
#[derive(Debug, Clone, Copy)]
pub struct Fitted {
    /// Estimate.
    pub value: f64,
    /// Lower bound; minus infinity where open.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Fitted {
    /// Whether the interval holds a value.
    pub fn covers(&self, truth: f64) -> bool {
        self.low <= truth && truth <= self.high
    }

    /// Whether the estimate is within a share of a value.
    pub fn is_within(&self, share: f64, truth: f64) -> bool {
        (self.value / truth - 1.0).abs() <= share
    }
}

/// The program under test.
fn program() -> Command {
    let under_test = std::env::var_os("ACM_EVAL_UNDER_TEST");
    Command::new(under_test.unwrap_or_else(|| env!("CARGO_BIN_EXE_acm-eval").into()))
}

/// Runs the loop on a rig with further arguments.
pub fn close(rig: &Rig, arguments: &[&str]) -> Closed {
    let folder = rig.write();
    let closed = close_folder(folder.path(), arguments);
    println!("{closed}");
    closed
}

fn close_folder(folder: &Path, arguments: &[&str]) -> Closed {
    let out = folder.join("out");
    let run = program().arg("close-loop").arg(folder).args(arguments).arg("--out").arg(&out).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let found = serde_json::from_slice(&std::fs::read(out.join("loop.json")).unwrap()).unwrap();
    Closed { found, has_model: out.join("model.json").exists() }
}

impl Closed {
    /// Names of the effects, with the signal that a size depends on: `backlash`, `backlash per p`; sorted.
    pub fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.effects().iter().map(name).collect();
        names.sort();
        names
    }

    /// Whether an effect of one of these names was found.
    pub fn has(&self, any: &[&str]) -> bool {
        self.names().iter().any(|name| any.contains(&name.split(' ').next().unwrap()))
    }

    fn effects(&self) -> &[Value] {
        self.found["effects"].as_array().unwrap()
    }

    /// The first parameter of an effect whose name begins so; panics where there is none.
    pub fn parameter(&self, effect: &str, parameter: &str) -> Fitted {
        let is = |value: &Value, start: &str| value["name"].as_str().unwrap().starts_with(start);
        let effects = self.effects().iter().filter(|found| found["name"] == effect);
        let mut parameters = effects.flat_map(|found| found["parameters"].as_array().unwrap());
        let found = parameters.find(|found| is(found, parameter));
        let found = found.unwrap_or_else(|| panic!("no {parameter} of {effect}: {self}"));
        let bound = |k: usize, open: f64| found["interval"][k].as_f64().unwrap_or(open);
        let (low, high) = (bound(0, f64::NEG_INFINITY), bound(1, f64::INFINITY));
        Fitted { value: found["value"].as_f64().unwrap(), low, high }
    }

    /// `named`, `no effect`, …
    pub fn verdict(&self) -> &str {
        self.found["verdict"].as_str().unwrap()
    }

    /// Error on held-out trials with what was found, SI.
    pub fn after(&self) -> f64 {
        self.error(["/errors/after/value", "/after_mm/value", "/after/value"])
    }

    /// Error on held-out trials of the nominal model, SI.
    pub fn nominal(&self) -> f64 {
        self.baseline("nominal")
    }

    /// The smallest error of a baseline on held-out trials, SI.
    pub fn best_baseline(&self) -> f64 {
        let of = |name: &&str| self.baseline(name);
        ["nominal", "static_map", "recalibrated"].iter().map(of).fold(f64::INFINITY, f64::min)
    }

    /// Error on held-out trials of a baseline: `nominal`, `static_map`, `recalibrated`; SI.
    pub fn baseline(&self, of: &str) -> f64 {
        let places = ["/errors/baselines", "/before_mm", "/before"];
        self.error(places.map(|place| format!("{place}/{of}/value")))
    }

    /// A value at the first of three places; the second is in millimetres.
    fn error(&self, places: [impl AsRef<str>; 3]) -> f64 {
        let [si, mm, own] = places;
        let at = |place: &str| self.found.pointer(place).and_then(Value::as_f64);
        at(si.as_ref()).or(at(mm.as_ref()).map(|x| 1e-3 * x)).or(at(own.as_ref())).expect("an error")
    }
}

fn name(effect: &Value) -> String {
    let on = effect["parameters"].as_array().unwrap().iter().find_map(|parameter| parameter["depends_on"].as_str());
    let name = effect["name"].as_str().unwrap();
    on.map_or_else(|| name.to_string(), |on| format!("{name} per {on}"))
}

impl fmt::Display for Closed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.verdict(), self.found["sentence"].as_str().unwrap())?;
        for effect in self.effects() {
            writeln!(f, "  {}: {}", name(effect), effect["parameters"])?;
        }
        let (nominal, best) = (self.nominal(), self.best_baseline());
        writeln!(f, "  nominal {nominal:.4}, best baseline {best:.4}, after {:.4}", self.after())?;
        for step in self.found["steps"].as_array().unwrap() {
            writeln!(f, "  {} {}", step["model"], step["error"])?;
        }
        write!(
            f,
            "  left {} {}, {} s",
            self.found["left"]["probe"], self.found["left"]["network"], self.found["seconds"]
        )
    }
}
