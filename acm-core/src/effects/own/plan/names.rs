//! The names that expressions may use, with their units.

use std::collections::BTreeMap;

use super::super::definition::{Definition, Derived};
use super::super::dimensions::Names;
use super::super::fault::OwnError;
use super::super::sound::{CARRIER, ELAPSED, PI, TIME, key};
use super::super::units::{self, Dimension, Unit, parse as parse_unit};

/// Dimension of each name.
pub struct Named {
    /// Everything but states.
    pub signals: Names,
    /// Of the states as far as they are known.
    pub states: Names,
}

/// Unit of the coordinates of a frame: m, which may be left out.
pub fn metres(definition: &Definition, column: Option<Unit>) -> Result<Unit, OwnError> {
    let metre = Unit { dimension: Dimension::LENGTH, scale: 1.0, factors: vec![("m".into(), 1)] };
    match column {
        Some(unit) if unit.dimension != Dimension::LENGTH => {
            let what = format!("is {:?}", definition.unit.as_deref().unwrap_or_default());
            Err(OwnError::new("unit", what, "leave it out: coordinates of a frame are in m"))
        }
        _ => Ok(metre),
    }
}

/// A unit as it is written; `open` are names that stand for the unit of a signal.
pub fn unit_of(key: &str, text: &str, open: &[(&str, Dimension)]) -> Result<Unit, OwnError> {
    let names: Vec<&str> = open.iter().map(|(name, _)| *name).collect();
    let also = if names.is_empty() { String::new() } else { format!(" {}", names.join(" ")) };
    let help = || format!("write a product of these, as in m/s^2: {}{also}", units::known());
    parse_unit(text, open).map_err(|what| OwnError::new(key, format!("= {text:?}: {what}"), help()))
}

/// Names that stand for the unit of a signal, where that was left open.
pub fn open(definition: &Definition, column: Option<&Unit>) -> Vec<(&'static str, Dimension)> {
    let mut open = vec![];
    if let ([name], None) = (definition.place.columns(), column) {
        open.push((*name, Dimension::COLUMN));
    }
    if definition.inputs.values().any(|input| input.signal == CARRIER && input.unit.is_none()) {
        open.push((CARRIER, Dimension::CARRIER));
    }
    open
}

/// Value of each constant, SI; π with them.
pub fn constants(definition: &Definition) -> BTreeMap<String, f64> {
    let scale = |unit: &str| parse_unit(unit, &[]).map_or(f64::NAN, |unit| unit.scale);
    let own = definition.constants.iter().map(|(name, c)| (name.clone(), c.value * scale(&c.unit)));
    own.chain([(PI.to_string(), std::f64::consts::PI)]).collect()
}

/// Dimension of every name but the states.
pub fn named(definition: &Definition, column: Option<&Unit>) -> Result<Named, OwnError> {
    let own = column.map_or(Dimension::COLUMN, |unit| unit.dimension);
    let mut signals: Names = definition.place.columns().iter().map(|name| (name.to_string(), own)).collect();
    signals.extend([(TIME.into(), Dimension::TIME), (ELAPSED.into(), Dimension::TIME), (PI.into(), Dimension::ONE)]);
    let open = open(definition, column);
    for (name, input) in &definition.inputs {
        let plain = match &input.unit {
            Some(unit) => unit_of(&key("inputs", name, "unit"), unit, &[])?,
            None if input.signal == CARRIER => Unit { dimension: Dimension::CARRIER, ..Unit::one() },
            None => {
                let help = format!("write the unit of {:?}, such as Pa", input.signal);
                return Err(OwnError::new(key("inputs", name, "unit"), "is missing", help));
            }
        };
        let seconds = match input.derivative {
            None => Dimension::ONE,
            Some(Derived::Rate) => Dimension::TIME,
            Some(Derived::Acceleration) => Dimension::TIME.times(Dimension::TIME),
        };
        signals.insert(name.clone(), plain.dimension.over(seconds));
    }
    for (name, constant) in &definition.constants {
        signals.insert(name.clone(), unit_of(&key("constants", name, "unit"), &constant.unit, &[])?.dimension);
    }
    for (name, parameter) in &definition.parameters {
        signals.insert(name.clone(), unit_of(&key("parameters", name, "unit"), &parameter.unit, &open)?.dimension);
    }
    Ok(Named { signals, states: Names::new() })
}
