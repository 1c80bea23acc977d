//! Whether the names and the numbers of a definition can be used, before any expression is read.

use std::collections::BTreeMap;

use super::definition::{Definition, Input, Parameter, Place};
use super::fault::OwnError;
use super::function::{CALLED, CLAMP};
use super::units::{Dimension, parse as parse_unit};

/// Names with a meaning of their own.
pub const TIME: &str = "t";
pub const ELAPSED: &str = "dt";
pub const PI: &str = "pi";
/// Signal that stands for what carries the effect.
pub const CARRIER: &str = "carrier";

/// Runge–Kutta steps between two samples, where none are given, and most.
pub const STEPS: usize = 4;
pub const MOST_STEPS: usize = 64;

/// Longest name.
pub const LONGEST: usize = 40;

/// Most parameters, inputs and constants together.
pub const MOST_NAMES: usize = 40;

/// Refuses names that cannot be used, then values that cannot be.
pub fn sound(definition: &Definition) -> Result<(), OwnError> {
    let is_name = |name: &str| {
        let first = name.chars().next().is_some_and(|c| c.is_ascii_alphabetic());
        first && name.len() <= LONGEST && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    let name = &definition.name;
    if !is_name(name) || name.chars().any(|c| c.is_ascii_uppercase()) {
        let help = format!("write lower-case letters, digits and `_`, a letter first, {LONGEST} at most");
        return Err(OwnError::new("name", format!("is {name:?}"), help));
    }
    if super::super::find(name).is_some() || name == "clock_correction" {
        let help = format!("choose another, such as my_{name}: results must tell yours from the library's");
        return Err(OwnError::new("name", format!("is {name:?}, which the library has"), help));
    }
    let mut seen: Vec<&str> = definition.place.columns().to_vec();
    seen.extend([TIME, ELAPSED, PI, CARRIER, CLAMP]);
    seen.extend(CALLED.iter().map(|(name, ..)| *name));
    let states = definition.update.iter().chain(&definition.rate).flat_map(BTreeMap::keys).map(|n| ("states", n));
    let inputs = definition.inputs.keys().map(|name| ("inputs", name));
    let constants = definition.constants.keys().map(|name| ("constants", name));
    let parameters = definition.parameters.keys().map(|name| ("parameters", name));
    let all: Vec<(&str, &String)> = inputs.chain(constants).chain(parameters).chain(states).collect();
    if all.len() > MOST_NAMES {
        return Err(OwnError::new(
            "",
            format!("has {} names", all.len()),
            format!("{MOST_NAMES} at most: write two effects"),
        ));
    }
    for (table, name) in all {
        if !is_name(name) || seen.contains(&name.as_str()) {
            let what = if is_name(name) { "is a name that is taken" } else { "is no name" };
            let help = format!("use letters, digits and `_`, each name once, and none of {}", seen.join(" "));
            return Err(OwnError::new(format!("{table}.{name}"), what, help));
        }
        seen.push(name);
    }
    values_are_sound(definition)
}

fn values_are_sound(definition: &Definition) -> Result<(), OwnError> {
    for (name, constant) in &definition.constants {
        if !constant.value.is_finite() {
            let what = format!("is {}", constant.value);
            return Err(OwnError::new(key("constants", name, "value"), what, "write a finite number"));
        }
    }
    for (name, parameter) in &definition.parameters {
        parameter_is_sound(definition, name, parameter)?;
    }
    if definition.parameters.values().all(|p| p.silent.is_none()) {
        let help =
            "write `silent = 0` (or another value) for each parameter that is a size: there the effect does nothing";
        return Err(OwnError::new("parameters", "has no size", help));
    }
    if let Some(steps) = definition.steps.filter(|steps| !(1..=MOST_STEPS).contains(steps)) {
        return Err(OwnError::new("steps", format!("is {steps}"), format!("write 1 to {MOST_STEPS}")));
    }
    if definition.steps.is_some() && definition.rate.is_none() {
        return Err(OwnError::new("steps", "is for a `rate`", "leave it out"));
    }
    for (name, input) in &definition.inputs {
        let carried = definition.carriers.is_empty() && input.signal == CARRIER;
        if carried {
            let help = "name the signals that may carry the effect: carriers = [\"contexts\"]";
            return Err(OwnError::new(key("inputs", name, "signal"), "is the carrier, and there is none", help));
        }
        window_is_sound(definition, name, input)?;
    }
    Ok(())
}

fn window_is_sound(definition: &Definition, name: &str, input: &Input) -> Result<(), OwnError> {
    let Some(window) = &input.window else { return Ok(()) };
    let at = || key("inputs", name, "window");
    if input.derivative.is_none() {
        return Err(OwnError::new(at(), "is for a derivative", "add derivative = \"rate\", or leave the window out"));
    }
    let is_shape = |p: &Parameter| p.silent.is_none() && !p.each && p.bounds[0] >= 0.0;
    let time = |p: &Parameter| parse_unit(&p.unit, &[]).is_ok_and(|unit| unit.dimension == Dimension::TIME);
    if definition.parameters.get(window).is_some_and(|p| is_shape(p) && time(p)) {
        return Ok(());
    }
    let help = "name a parameter in s that is neither negative nor `each` and has no `silent`";
    Err(OwnError::new(at(), format!("is {window:?}"), help))
}

fn parameter_is_sound(definition: &Definition, name: &str, parameter: &Parameter) -> Result<(), OwnError> {
    let Parameter { bounds: [low, high], guesses, silent, .. } = parameter;
    let fault = |field: &str, what: String, help: &str| Err(OwnError::new(key("parameters", name, field), what, help));
    if !(low.is_finite() && high.is_finite() && low < high) {
        return fault(
            "bounds",
            format!("= [{low}, {high}]"),
            "write the smallest value first, then the largest, both finite",
        );
    }
    let inside = |value: &f64| (low..=high).contains(&value);
    if guesses.is_empty() || guesses.len() > 50 {
        return fault("guesses", format!("has {} values", guesses.len()), "write 1 to 50 values to start a fit from");
    }
    if let Some(guess) = guesses.iter().find(|guess| !inside(guess) || Some(**guess) == *silent) {
        return fault("guesses", format!("has {guess}"), "write values within the bounds, none of them the silent one");
    }
    if let Some(silent) = silent.as_ref().filter(|silent| !inside(silent)) {
        return fault("silent", format!("is {silent}"), "write a value within the bounds");
    }
    if parameter.each && definition.place == Place::Frame {
        return fault("each", "is true".into(), "leave it out: a frame has one value for all markers");
    }
    Ok(())
}

pub fn key(table: &str, name: &str, key: &str) -> String {
    format!("{table}.{name}.{key}")
}
