//! From expressions to operations on registers.

use super::super::affine::{Affine, affine};
use super::super::definition::{Definition, Place};
use super::super::expression::{Expression, Node};
use super::super::program::{Class, Scope, Writer};
use super::super::sound::{ELAPSED, STEPS, TIME};
use super::super::units::Unit;
use super::names::constants;
use super::parts::Parts;
use super::{Form, Linear, Plan};

impl Parts {
    /// The plan of a definition whose units fit.
    pub fn compiled(self, definition: &Definition, column: Option<Unit>, units: Vec<Unit>, inputs: Vec<Unit>) -> Plan {
        let all = || self.start.iter().chain(&self.next).chain(&self.outputs);
        let uses_time = all().any(|part| part.has(&|name: &str| name == TIME));
        let uses_elapsed = all().any(|part| part.has(&|name: &str| name == ELAPSED));
        let mut writer = Writer::default();
        let mut scope = Scope::new();
        let signals =
            definition.place.columns().iter().map(ToString::to_string).chain(definition.inputs.keys().cloned());
        for name in signals.chain(uses_time.then(|| TIME.to_string())) {
            scope.insert(name, writer.register(Class::Sample));
        }
        let base = scope.len();
        let elapsed = writer.register(Class::Sample);
        scope.insert(ELAPSED.into(), elapsed);
        let before: Vec<usize> = self.states.iter().map(|_| writer.register(Class::State)).collect();
        let parameters = before.last().map_or(elapsed, |last| *last) + 1;
        for name in definition.parameters.keys() {
            scope.insert(name.clone(), writer.register(Class::Constant));
        }
        for (name, value) in constants(definition) {
            scope.insert(name, writer.number(value));
        }
        let start: Vec<usize> = self.start.iter().map(|part| writer.expression(part, &scope)).collect();
        let mut within = scope.clone();
        within.extend(self.states.iter().cloned().zip(before.iter().copied()));
        let (form, now) = self.form(definition, &mut writer, &within);
        let chain = match (&form, &before[..], &now[..]) {
            (Form::Update, [before], [now]) => writer.chain(*before, *now),
            _ => None,
        };
        scope.extend(self.states.iter().cloned().zip(now.iter().copied()));
        let results: Vec<usize> = self.outputs.iter().map(|part| writer.expression(part, &scope)).collect();
        let derived = definition.inputs.values().any(|input| input.derivative.is_some());
        Plan {
            base,
            uses_time,
            elapsed,
            parameters,
            before,
            now,
            chain,
            start,
            results,
            inputs,
            units,
            column,
            is_additive: self.is_additive(definition),
            is_filter: self.is_filter(definition, &form),
            is_static: self.states.is_empty() && !derived && !uses_time && !uses_elapsed,
            form,
            program: writer.finish(),
        }
    }

    fn form(&self, definition: &Definition, writer: &mut Writer, scope: &Scope) -> (Form, Vec<usize>) {
        if self.states.is_empty() {
            return (Form::Static, vec![]);
        }
        if !self.is_rate {
            let next = self.next.iter().map(|part| writer.expression(part, scope)).collect();
            return (Form::Update, writer.results(next));
        }
        let form = self.linear(definition, writer, scope).map_or_else(
            || {
                let rates = self.next.iter().map(|part| writer.expression(part, scope)).collect();
                Form::RungeKutta { rates, steps: definition.steps.unwrap_or(STEPS) }
            },
            Form::Linear,
        );
        (form, self.states.iter().map(|_| writer.register(Class::After)).collect())
    }

    /// The coefficients of every rate, where states and inputs enter linearly.
    fn linear(&self, definition: &Definition, writer: &mut Writer, scope: &Scope) -> Option<Linear> {
        let is_known =
            |name: &str| definition.parameters.contains_key(name) || constants(definition).contains_key(name);
        let is_variable = |name: &str| !is_known(name);
        let rows: Vec<Affine> = self.next.iter().map(|part| affine(part, &is_variable)).collect::<Option<_>>()?;
        let mut register = |part: &Expression| writer.expression(part, scope);
        let mut linear = Linear { a: vec![], b: vec![], c: vec![], is_shared: true };
        let is_each = |name: &str| definition.parameters.get(name).is_some_and(|p| p.each);
        for (i, row) in rows.iter().enumerate() {
            for state in &self.states {
                let part = row.get(&Some(state.clone()));
                linear.is_shared &= part.is_none_or(|part| !part.has(&is_each));
                linear.a.push(part.map(&mut register));
            }
            for (name, part) in row {
                match name {
                    None => (),
                    // The time since the sample before is not linear between samples.
                    Some(name) if name == ELAPSED => return None,
                    Some(name) if self.states.contains(name) => (),
                    Some(name) => linear.b.push((i, *scope.get(name)?, register(part))),
                }
            }
            linear.c.push(row.get(&None).map(&mut register));
        }
        Some(linear)
    }

    /// y + Σ size · φ, where φ and the states are free of y and sizes.
    fn is_additive(&self, definition: &Definition) -> bool {
        let is_size = |name: &str| definition.parameters.get(name).is_some_and(|p| p.silent.is_some());
        let [column] = definition.place.columns() else { return false };
        let within = |name: &str| name == *column || is_size(name);
        let zero = definition.parameters.values().all(|p| p.silent.is_none_or(|silent| silent == 0.0));
        let free = self.start.iter().chain(&self.next).all(|part| !part.has(&within));
        let is_column = |part: &Expression| matches!(&part.node, Node::Name(name) if name == column);
        let Some(terms) = affine(&self.outputs[0], &is_size).filter(|_| definition.place == Place::Outputs) else {
            return false;
        };
        let sizes = terms.iter().filter(|(name, _)| name.is_some());
        zero && free
            && terms.get(&None).is_some_and(is_column)
            && terms.len() > 1
            && sizes.into_iter().all(|(_, part)| !part.has(&within))
    }

    fn is_filter(&self, definition: &Definition, form: &Form) -> bool {
        let alone = definition.inputs.is_empty() && definition.parameters.values().all(|p| !p.each);
        let [column] = definition.place.columns() else { return false };
        let is_variable = |name: &str| name == *column || self.states.iter().any(|state| state == name);
        let no_rest = |part: &Expression| affine(part, &is_variable).is_some_and(|terms| !terms.contains_key(&None));
        let parts = || self.start.iter().chain(&self.outputs).chain(&self.next);
        let timeless = parts().all(|part| !part.has(&|name: &str| [TIME, ELAPSED].contains(&name)));
        alone && timeless && matches!(form, Form::Linear(_)) && parts().all(no_rest)
    }
}
