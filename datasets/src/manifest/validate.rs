//! Validation of a manifest beyond its types, each fault with place, value and remedy.

mod arm;
mod signals;
mod source;
mod table;
mod trials;

use super::{Manifest, Quantity};
use crate::toml_file::{TomlError, TomlSource};
use crate::units::{Dimension, Unit};

/// Largest number of problems that are listed; of more, only the number.
const TOLD: usize = 100;

struct Check<'a> {
    source: &'a TomlSource,
    problems: Vec<TomlError>,
    more: usize,
}

impl Manifest {
    /// All problems of the manifest itself.
    pub fn validate(&self, source: &TomlSource) -> Vec<TomlError> {
        let mut check = Check { source, problems: Vec::new(), more: 0 };
        match self.source.list.is_empty() {
            true => check.table(self),
            false => check.sources(self),
        }
        check.signals("actuator", &self.actuator);
        check.signals("context", &self.context);
        check.measured(self);
        check.predicted(self);
        check.names(self);
        check.no_time(self);
        check.vehicle(self);
        if let Some(arm) = &self.arm {
            check.arm(arm);
        }
        check.roles(self);
        check.cuts(self);
        for (trial, constants) in &self.conditions {
            for (name, quantity) in constants {
                check.quantity(&["conditions", trial, name], quantity);
            }
        }
        if check.more > 0 {
            let message = format!("{} more problems; mend these first", check.more);
            check.problems.push(check.source.problem(&[], message));
        }
        check.problems
    }
}

impl Check<'_> {
    fn say(&mut self, key: &[&str], message: impl Into<String>) {
        if self.problems.len() >= TOLD {
            self.more += 1;
            return;
        }
        let key_and_message = format!("`{}`: {}", dotted(key), message.into());
        self.problems.push(self.source.problem(key, key_and_message));
    }

    fn unit(&mut self, key: &[&str], name: &str) -> Option<Dimension> {
        match Unit::parse(name) {
            Ok(unit) => Some(unit.dimension),
            Err(e) => {
                self.say(key, e.to_string());
                None
            }
        }
    }

    fn quantity(&mut self, key: &[&str], quantity: &Quantity) -> Option<Dimension> {
        if !quantity.value.is_finite() {
            let message = format!("the value is {}; give a finite number", quantity.value);
            self.say(&[key, &["value"]].concat(), message);
        }
        let key = [key, &["unit"]].concat();
        if quantity.unit.is_empty() {
            self.say(&key, "the unit is missing; write { value = …, unit = \"…\" }");
            return None;
        }
        self.unit(&key, &quantity.unit)
    }
}

/// `actuator[0].unit`, as serde's own messages have it.
fn dotted(key: &[&str]) -> String {
    key.iter().fold(String::new(), |path, part| match part.parse::<usize>() {
        Ok(index) if !path.is_empty() => format!("{path}[{index}]"),
        _ if path.is_empty() => part.to_string(),
        _ => format!("{path}.{part}"),
    })
}
