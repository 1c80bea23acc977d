//! The expressions of a definition, and whether the dimension of each is the one that it must have.

use std::collections::BTreeMap;

use super::super::definition::{Definition, Outputs};
use super::super::dimensions::{Kind, Names, kind};
use super::super::expression::{Expression, Misplaced, Node, parse};
use super::super::fault::OwnError;
use super::super::function::Function;
use super::super::phi::MOST;
use super::super::units::Dimension;
use super::names::Named;

/// The expressions of a definition.
pub(super) struct Parts {
    pub states: Vec<String>,
    pub start: Vec<Expression>,
    pub next: Vec<Expression>,
    pub outputs: Vec<Expression>,
    /// Key and text of each of the three above, for complaints.
    texts: [Vec<(String, String)>; 3],
    pub is_rate: bool,
}

impl Parts {
    pub fn read(definition: &Definition) -> Result<Self, OwnError> {
        let forms = [definition.static_form.is_some(), definition.update.is_some(), definition.rate.is_some()];
        if forms.iter().filter(|is| **is).count() != 1 {
            let what = if forms.contains(&true) { "has more than one equation" } else { "has no equation" };
            return Err(OwnError::new("", what, "write one of `static`, `update` and `rate`"));
        }
        let (key, next) = match (&definition.update, &definition.rate) {
            (Some(update), _) => ("update", update.clone()),
            (_, Some(rate)) => ("rate", rate.clone()),
            _ => ("static", BTreeMap::new()),
        };
        if next.len() > MOST || (key != "static" && next.is_empty()) {
            let what = format!("has {} states", next.len());
            return Err(OwnError::new(key, what, format!("write 1 to {} states, each with its equation", MOST)));
        }
        let outputs = outputs(definition)?;
        if let Some(name) = definition.start.keys().find(|name| !next.contains_key(*name)) {
            let what = "starts what is no state";
            return Err(OwnError::new(format!("start.{name}"), what, format!("states are the keys of `{key}`")));
        }
        let start_text = |name: &String| {
            let text = definition.start.get(name).cloned().unwrap_or_else(|| "0".into());
            (format!("start.{name}"), text)
        };
        let texts = [
            next.keys().map(start_text).collect::<Vec<_>>(),
            next.iter().map(|(name, text)| (format!("{key}.{name}"), text.clone())).collect(),
            outputs,
        ];
        let read = |texts: &Vec<(String, String)>| -> Result<Vec<Expression>, OwnError> {
            texts.iter().map(|(key, text)| parse(text).map_err(|fault| OwnError::within(key, text, fault))).collect()
        };
        let [start, next_parts, outputs] = [read(&texts[0])?, read(&texts[1])?, read(&texts[2])?];
        let states = next.keys().cloned().collect();
        Ok(Self { states, start, next: next_parts, outputs, texts, is_rate: definition.rate.is_some() })
    }

    /// Dimension of each state: that of its start where it has one, else of the first column.
    pub fn states_are_dimensioned(&self, named: &mut Named) -> Result<(), OwnError> {
        let mut open = vec![];
        for (k, name) in self.states.iter().enumerate() {
            let (key, text) = &self.texts[0][k];
            let found = kind(&self.start[k], &named.signals).map_err(|fault| OwnError::within(key, text, fault))?;
            match found {
                Kind::Of(dimension) => drop(named.states.insert(name.clone(), dimension)),
                Kind::Zero => open.push(k),
                Kind::Truth => return Err(OwnError::new(key, "is a comparison", "write if(comparison, 1, 0)")),
            }
        }
        for k in open {
            let dimension = self.settled(k, named);
            named.states.insert(self.states[k].clone(), dimension);
        }
        Ok(())
    }

    /// Dimension of a state that starts at 0: from the parts of its equation that hold no state of unknown dimension.
    fn settled(&self, k: usize, named: &Named) -> Dimension {
        let names: Names = named.signals.iter().chain(&named.states).map(|(n, d)| (n.clone(), *d)).collect();
        let found = sides(&self.next[k]).into_iter().find_map(|part| match kind(part, &names) {
            Ok(Kind::Of(dimension)) => Some(dimension),
            _ => None,
        });
        let per = if self.is_rate { Dimension::TIME } else { Dimension::ONE };
        // A speed whose equation needs itself: from the state whose rate it is.
        let of_rate = || {
            let is_it = |part: &Expression| matches!(&part.node, Node::Name(name) if *name == self.states[k]);
            let by = self.next.iter().position(is_it)?;
            let known = named.states.get(&self.states[by])?;
            Some(if self.is_rate { known.over(Dimension::TIME) } else { *known })
        };
        of_rate().or(found.map(|found| found.times(per))).unwrap_or(Dimension::ONE)
    }

    /// Whether every expression has the dimension that it must have.
    pub fn fit(&self, definition: &Definition, named: &Named) -> Result<(), OwnError> {
        let mut names = named.signals.clone();
        names.extend(named.states.iter().map(|(name, dimension)| (name.clone(), *dimension)));
        for (k, part) in self.next.iter().enumerate() {
            let own = named.states[&self.states[k]];
            let needed = if self.is_rate { own.over(Dimension::TIME) } else { own };
            is(part, needed, &names, &self.texts[1][k])?;
        }
        let columns = definition.place.columns();
        for (k, part) in self.outputs.iter().enumerate() {
            is(part, named.signals[columns[k]], &names, &self.texts[2][k])?;
        }
        Ok(())
    }
}

/// The terms of sums, `min`, `max` and negations, whose dimension is that of the whole.
fn sides(expression: &Expression) -> Vec<&Expression> {
    let mut all = vec![expression];
    if let Node::Apply(Function::Add | Function::Subtract | Function::Min | Function::Max | Function::Negative, parts) =
        &expression.node
    {
        all.extend(parts.iter().flat_map(sides));
    }
    all
}
fn outputs(definition: &Definition) -> Result<Vec<(String, String)>, OwnError> {
    let (key, given) = match (&definition.static_form, &definition.output) {
        (Some(form), None) => ("static", form),
        (None, Some(output)) => ("output", output),
        (Some(_), Some(_)) => {
            return Err(OwnError::new("output", "stands beside `static`", "leave it out: `static` is the output"));
        }
        (None, None) => {
            return Err(OwnError::new("output", "is missing", "write what leaves the effect, from its states"));
        }
    };
    let columns = definition.place.columns();
    match given {
        Outputs::One(text) if columns.len() == 1 => Ok(vec![(key.into(), text.clone())]),
        Outputs::One(_) => Err(OwnError::new(
            key,
            "is one expression for three coordinates",
            "write { x = \"…\", y = \"…\", z = \"…\" }",
        )),
        Outputs::Each(texts) => {
            if let Some(name) = texts.keys().find(|name| !columns.contains(&name.as_str())) {
                let help = format!("write an expression for {}", columns.join(", "));
                return Err(OwnError::new(format!("{key}.{name}"), "is no coordinate", help));
            }
            let text = |name: &&str| texts.get(*name).cloned().unwrap_or_else(|| (*name).to_string());
            Ok(columns.iter().map(|name| (format!("{key}.{name}"), text(name))).collect())
        }
    }
}
fn is(part: &Expression, needed: Dimension, names: &Names, (key, text): &(String, String)) -> Result<(), OwnError> {
    let found = kind(part, names).map_err(|fault| OwnError::within(key, text, fault))?;
    let fault = |what: String| {
        let help = "check the units of its parameters, inputs and constants, or what is missing".to_string();
        OwnError::within(key, text, Misplaced { span: [0, text.len()], what, help })
    };
    match found {
        Kind::Zero => Ok(()),
        Kind::Of(dimension) if dimension == needed => Ok(()),
        Kind::Of(dimension) => Err(fault(format!("it is {dimension} and must be {needed}"))),
        Kind::Truth => Err(fault("it is a comparison and must be a quantity".into())),
    }
}
