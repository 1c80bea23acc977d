//! A definition that is checked and compiled: what holds on every rig.

use std::collections::BTreeMap;

use super::affine::{Affine, affine};
use super::definition::{Definition, Derived, Outputs, Place};
use super::dimensions::{Kind, Names, kind};
use super::expression::{Expression, Misplaced, Node, parse};
use super::fault::OwnError;
use super::function::Function;
use super::phi;
use super::program::{Class, Program, Scope, Writer};
use super::sound::{CARRIER, ELAPSED, PI, STEPS, TIME, key, sound};
use super::units::{self, Dimension, Unit, parse as parse_unit};

/// A definition as it is carried out.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Operations on registers.
    pub program: Program,
    /// Registers of the columns, then of the inputs, then of the time where it is used: 0 and up.
    pub base: usize,
    /// Whether the last of these is the time.
    pub uses_time: bool,
    /// Register of the time since the sample before.
    pub elapsed: usize,
    /// First register of the parameters, in the order of their names.
    pub parameters: usize,
    /// Registers of the states before, and at the sample.
    pub before: Vec<usize>,
    /// See above.
    pub now: Vec<usize>,
    /// Registers of the states at the first sample.
    pub start: Vec<usize>,
    /// Registers of the columns as they leave.
    pub results: Vec<usize>,
    /// How states go on.
    pub form: Form,
    /// The operations of an update of one state, where each takes on from the one before.
    pub chain: Option<Vec<(Function, usize)>>,
    /// Unit of each input's signal and of each parameter, in the order of their names.
    pub inputs: Vec<Unit>,
    /// See above.
    pub units: Vec<Unit>,
    /// Unit of the columns; none where it is open.
    pub column: Option<Unit>,
    /// Whether it adds to the columns in proportion to its sizes.
    pub is_additive: bool,
    /// Whether it is a linear filter of each column, with one set of values and nothing else that it reads.
    pub is_filter: bool,
    /// Whether what it does is a function of the moment.
    pub is_static: bool,
}

/// How states go on from one sample to the next.
#[derive(Debug, Clone)]
pub enum Form {
    /// There are none.
    Static,
    /// As operations say.
    Update,
    /// ż = A z + B u + c, exactly.
    Linear(Linear),
    /// ż = f(z, u), by Runge–Kutta: registers of the rates, and steps between two samples.
    RungeKutta { rates: Vec<usize>, steps: usize },
}

/// Registers of the coefficients of a linear rate.
#[derive(Debug, Clone)]
pub struct Linear {
    /// A, row by row; none where it is 0.
    pub a: Vec<Option<usize>>,
    /// Entries of B: state, register of the input, register of the coefficient.
    pub b: Vec<(usize, usize, usize)>,
    /// c; none where it is 0.
    pub c: Vec<Option<usize>>,
    /// Whether A is the same for every column.
    pub is_shared: bool,
}

struct Named {
    /// Everything but states.
    signals: Names,
    states: Names,
}

impl Plan {
    /// Checks a definition and compiles it.
    ///
    /// # Errors
    /// What cannot be carried out, with its key.
    pub fn new(definition: &Definition) -> Result<Self, OwnError> {
        sound(definition)?;
        let column = definition.unit.as_ref().map(|unit| unit_of("unit", unit, &[])).transpose()?;
        let column = if definition.place == Place::Frame { Some(metres(definition, column)?) } else { column };
        let mut named = named(definition, column.as_ref())?;
        let parts = Parts::read(definition)?;
        parts.states_are_dimensioned(&mut named)?;
        parts.fit(definition, &named)?;
        let open = open(definition, column.as_ref());
        let units =
            definition.parameters.iter().map(|(name, p)| unit_of(&key("parameters", name, "unit"), &p.unit, &open));
        let units: Vec<Unit> = units.collect::<Result<_, _>>()?;
        let inputs = definition.inputs.iter().map(|(name, input)| match &input.unit {
            Some(unit) => unit_of(&key("inputs", name, "unit"), unit, &[]),
            None => Ok(Unit { dimension: Dimension::CARRIER, ..Unit::one() }),
        });
        let inputs: Vec<Unit> = inputs.collect::<Result<_, _>>()?;
        Ok(parts.compiled(definition, column, units, inputs))
    }
}

/// The expressions of a definition.
struct Parts {
    states: Vec<String>,
    start: Vec<Expression>,
    next: Vec<Expression>,
    outputs: Vec<Expression>,
    /// Key and text of each of the three above, for complaints.
    texts: [Vec<(String, String)>; 3],
    is_rate: bool,
}

impl Parts {
    fn read(definition: &Definition) -> Result<Self, OwnError> {
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
        if next.len() > phi::MOST || (key != "static" && next.is_empty()) {
            let what = format!("has {} states", next.len());
            return Err(OwnError::new(key, what, format!("write 1 to {} states, each with its equation", phi::MOST)));
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
    fn states_are_dimensioned(&self, named: &mut Named) -> Result<(), OwnError> {
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

    /// Dimension of a state that starts at 0: what its equation gives without the states that are not known yet, tried
    /// from the states that are.
    fn settled(&self, k: usize, named: &Named) -> Dimension {
        let names: Names = named.signals.iter().chain(&named.states).map(|(n, d)| (n.clone(), *d)).collect();
        let found = sides(&self.next[k]).into_iter().find_map(|part| match kind(part, &names) {
            Ok(Kind::Of(dimension)) => Some(dimension),
            _ => None,
        });
        let per = if self.is_rate { Dimension::TIME } else { Dimension::ONE };
        // A speed whose equation needs itself: what another state's equation says it is.
        let of_rate = || {
            let is_it = |part: &Expression| matches!(&part.node, Node::Name(name) if *name == self.states[k]);
            let by = self.next.iter().position(is_it)?;
            let known = named.states.get(&self.states[by])?;
            Some(if self.is_rate { known.over(Dimension::TIME) } else { *known })
        };
        of_rate().or(found.map(|found| found.times(per))).unwrap_or(Dimension::ONE)
    }

    /// Whether every expression has the dimension that it must have.
    fn fit(&self, definition: &Definition, named: &Named) -> Result<(), OwnError> {
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

    fn compiled(self, definition: &Definition, column: Option<Unit>, units: Vec<Unit>, inputs: Vec<Unit>) -> Plan {
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
                    // The time since the sample before is not straight between samples.
                    Some(name) if name == ELAPSED => return None,
                    Some(name) if self.states.contains(name) => (),
                    Some(name) => linear.b.push((i, *scope.get(name)?, register(part))),
                }
            }
            linear.c.push(row.get(&None).map(&mut register));
        }
        Some(linear)
    }

    /// y + Σ size · φ, where neither φ nor any state knows y or a size.
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

/// The parts of a sum, and what is multiplied or negated to make one: whose dimension is that of the whole.
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

fn metres(definition: &Definition, column: Option<Unit>) -> Result<Unit, OwnError> {
    let metre = Unit { dimension: Dimension::LENGTH, scale: 1.0, factors: vec![("m".into(), 1)] };
    match column {
        Some(unit) if unit.dimension != Dimension::LENGTH => {
            let what = format!("is {:?}", definition.unit.as_deref().unwrap_or_default());
            Err(OwnError::new("unit", what, "leave it out: coordinates of a frame are in m"))
        }
        _ => Ok(metre),
    }
}

fn unit_of(key: &str, text: &str, open: &[(&str, Dimension)]) -> Result<Unit, OwnError> {
    let names: Vec<&str> = open.iter().map(|(name, _)| *name).collect();
    let also = if names.is_empty() { String::new() } else { format!(" {}", names.join(" ")) };
    let help = || format!("write a product of these, as in m/s^2: {}{also}", units::known());
    parse_unit(text, open).map_err(|what| OwnError::new(key, format!("= {text:?}: {what}"), help()))
}

/// Names that stand for the unit of a signal, where that was left open.
fn open(definition: &Definition, column: Option<&Unit>) -> Vec<(&'static str, Dimension)> {
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
fn constants(definition: &Definition) -> BTreeMap<String, f64> {
    let scale = |unit: &str| parse_unit(unit, &[]).map_or(f64::NAN, |unit| unit.scale);
    let own = definition.constants.iter().map(|(name, c)| (name.clone(), c.value * scale(&c.unit)));
    own.chain([(PI.to_string(), std::f64::consts::PI)]).collect()
}

/// Dimension of every name but the states.
fn named(definition: &Definition, column: Option<&Unit>) -> Result<Named, OwnError> {
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
