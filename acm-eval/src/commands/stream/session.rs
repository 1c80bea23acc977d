//! Lines in, answers out, one by one: CSV with a header, or JSON objects, whichever the first line is.
//!
//! | line                  | answer                                                                        |
//! | --------------------- | ----------------------------------------------------------------------------- |
//! | a sample              | time, outputs, what the nominal model alone says, samples since start or gap  |
//! | one outside the domain | the same, with the outputs of the nominal model alone, and 0 samples         |
//! | what is no sample     | empty cells, or an object with `error`; a message on standard error           |
//! | empty                 | none: a new trial begins                                                      |
//!
//! Values are in the units of the manifest, both ways.

use std::io::{self, BufRead, Write};

use acm_datasets::Domain;
use acm_eval::error::EvalError;
use acm_stream::{Estimator, StepError};
use serde_json::{Map, Value, json};

use super::wiring::{Column, Wiring};

/// An estimator that is asked line by line.
pub struct Session {
    estimator: Estimator,
    wiring: Wiring,
    /// Where the network answers; everywhere without one.
    domain: Option<Domain>,
    /// Time of the last sample that was answered, s, and how many there were in this trial.
    before: Option<f64>,
    samples: u64,
    /// Samples behind the last answer.
    history: u64,
    inputs: Vec<f64>,
}

/// What came of a session.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Samples that were answered.
    pub answered: u64,
    /// Lines that were no sample.
    pub refused: u64,
}

/// A cell that is no value.
#[derive(Debug, PartialEq)]
struct Fault {
    column: String,
    what: String,
    remedy: String,
}

/// One line, taken apart.
enum Line<'a> {
    /// Cells, and where each column stands among them.
    Cells(&'a [&'a str], &'a [String]),
    Object(&'a Map<String, Value>),
}

impl Session {
    /// Before the first line.
    pub fn new(estimator: Estimator, wiring: Wiring, domain: Option<Domain>) -> Self {
        let inputs = vec![0.0; wiring.inputs.len()];
        let history = 0;
        Self { estimator, wiring, domain, history, before: None, samples: 0, inputs }
    }

    /// Answers every line at once, until there is none.
    ///
    /// # Errors
    /// A header that lacks a column, or a stream that cannot be read or written.
    pub fn run(
        &mut self,
        mut lines: impl BufRead,
        mut out: impl Write,
        mut tell: impl FnMut(&str),
    ) -> Result<Count, EvalError> {
        let (mut text, mut number, mut count) = (String::new(), 0, Count::default());
        let mut header: Option<Vec<String>> = None;
        loop {
            text.clear();
            number += 1;
            if read(&mut lines, &mut text)? == 0 {
                return Ok(count);
            }
            let line = text.trim_end_matches(['\r', '\n']).trim_start_matches('\u{feff}');
            if line.trim().is_empty() {
                self.restart();
                continue;
            }
            let is_object = line.trim_start().starts_with('{');
            if header.is_none() && !is_object {
                header = Some(self.header(line)?);
                put(&mut out, &self.answer_header())?;
                continue;
            }
            let answer = match &header {
                Some(names) => self.cells(line, names),
                None => self.object(line),
            };
            match answer {
                Ok(answer) => {
                    count.answered += 1;
                    put(&mut out, &answer)?;
                }
                Err(fault) => {
                    count.refused += 1;
                    let message = format!("line {number}, column {}: {}; {}", fault.column, fault.what, fault.remedy);
                    tell(&message);
                    put(&mut out, &self.refusal(header.is_some(), number, &message))?;
                }
            }
        }
    }

    fn restart(&mut self) {
        self.estimator.restart();
        (self.before, self.samples) = (None, 0);
    }

    fn header(&self, line: &str) -> Result<Vec<String>, EvalError> {
        let names: Vec<String> = cells(line, self.wiring.separator).map(unquoted).collect();
        let lacks = |column: &&Column| !names.contains(&column.name);
        let missing: Vec<String> =
            self.wiring.time().into_iter().chain(&self.wiring.inputs).filter(lacks).map(labelled).collect();
        if missing.is_empty() {
            return Ok(names);
        }
        Err(EvalError::Data(format!(
            "line 1: the header has no column {}; it has {}; name the columns as in the manifest, with {:?} between them, \
             or send JSON objects",
            missing.join(", no column "),
            names.join(", "),
            self.wiring.separator
        )))
    }

    fn cells(&mut self, line: &str, names: &[String]) -> Result<String, Fault> {
        let cells: Vec<&str> = cells(line, self.wiring.separator).collect();
        if cells.len() != names.len() {
            let what = format!("{} cells where the header has {}", cells.len(), names.len());
            let column = names.get(cells.len()).map_or("behind the last", String::as_str).to_string();
            return Err(Fault { column, what, remedy: "send one cell for each column".into() });
        }
        let time = self.step(&Line::Cells(&cells, names))?;
        let separator = self.wiring.separator.to_string();
        let numbers = self.answers().map(|(_, value)| value.to_string());
        let all = [time.to_string()].into_iter().chain(numbers).chain([self.history.to_string()]);
        Ok(all.collect::<Vec<_>>().join(&separator))
    }

    fn object(&mut self, line: &str) -> Result<String, Fault> {
        let fault = |what: String| Fault {
            column: "of the whole line".into(),
            what,
            remedy: "send one JSON object a line, such as {\"t\": 0.1, \"q1\": 0.2}".into(),
        };
        let object: Map<String, Value> = serde_json::from_str(line).map_err(|error| fault(error.to_string()))?;
        let time = self.step(&Line::Object(&object))?;
        let mut answer = Map::new();
        answer.insert(self.time_name(), json!(time));
        answer.extend(self.answers().map(|(name, value)| (name, json!(value))));
        answer.insert("history".into(), json!(self.history));
        Ok(Value::Object(answer).to_string())
    }

    /// Takes a sample; returns its time in the unit of its column, or in s.
    fn step(&mut self, line: &Line) -> Result<f64, Fault> {
        let written = self.wiring.time().map(|column| line.value(column)).transpose()?;
        let seconds = self.wiring.clock.seconds(self.samples, written.unwrap_or(0.0));
        for (input, column) in self.inputs.iter_mut().zip(&self.wiring.inputs) {
            *input = column.unit.to_si(line.value(column)?);
        }
        let elapsed = self.before.map_or(0.0, |before| seconds - before);
        let actuators = &self.inputs[..self.estimator.parts().signals.actuators.len()];
        let seen = self.domain.as_ref().is_none_or(|domain| domain.contains(actuators));
        let answered = match seen {
            true => self.estimator.step(&self.inputs, elapsed).map(drop),
            false => self.estimator.step_unseen(&self.inputs, elapsed).map(drop),
        };
        answered.map_err(|error| self.fault(error, written))?;
        self.history = if seen { self.estimator.history() } else { 0 };
        self.before = Some(seconds);
        self.samples += 1;
        Ok(written.unwrap_or(seconds))
    }

    fn fault(&self, error: StepError, time: Option<f64>) -> Fault {
        match error {
            StepError::Elapsed { elapsed } => Fault {
                column: self.time_name(),
                what: format!("{} is {} s before the last sample", time.unwrap_or(0.0), -elapsed),
                remedy: "sort the lines, or send an empty line before a new trial".into(),
            },
            error => Fault {
                column: "of the whole line".into(),
                what: error.to_string(),
                remedy: "send a value for each signal".into(),
            },
        }
    }

    /// Names and values of outputs, then of the nominal model's, in the manifest's units.
    fn answers(&self) -> impl Iterator<Item = (String, f64)> {
        let in_unit = |(column, value): (&Column, &f64)| (column.name.clone(), value / column.unit.factor());
        let nominal = self.wiring.outputs.iter().zip(self.estimator.nominal()).map(in_unit);
        let outputs = self.wiring.outputs.iter().zip(self.estimator.tip()).map(in_unit);
        outputs.chain(nominal.map(|(name, value)| (format!("nominal_{name}"), value)))
    }

    fn answer_header(&self) -> String {
        let names = self.answers().map(|(name, _)| name);
        let all = [self.time_name()].into_iter().chain(names).chain(["history".into()]);
        all.collect::<Vec<_>>().join(&self.wiring.separator.to_string())
    }

    fn refusal(&self, cells: bool, number: u64, message: &str) -> String {
        match cells {
            true => self.wiring.separator.to_string().repeat(2 * self.wiring.outputs.len() + 1),
            false => json!({ "line": number, "error": message }).to_string(),
        }
    }

    fn time_name(&self) -> String {
        self.wiring.time().map_or("t".into(), |column| column.name.clone())
    }
}

impl Line<'_> {
    fn value(&self, column: &Column) -> Result<f64, Fault> {
        let unit = column.unit.name;
        let fault = |what: String| Fault {
            column: column.name.clone(),
            what,
            remedy: format!("write a number in {unit}, or leave the line out until there is one"),
        };
        let found = match self {
            Self::Cells(cells, names) => {
                let place = names.iter().position(|name| *name == column.name);
                let cell = place.and_then(|place| cells.get(place)).map_or("", |cell| cell.trim());
                cell.parse().map_err(|_| fault(format!("{cell:?} is no number")))?
            }
            Self::Object(object) => match object.get(&column.name) {
                Some(value) => value.as_f64().ok_or_else(|| fault(format!("{value} is no number")))?,
                None => return Err(fault("it is missing".into())),
            },
        };
        if f64::is_finite(found) { Ok(found) } else { Err(fault(format!("{found} is no finite number"))) }
    }
}

fn labelled(column: &Column) -> String {
    format!("{} [{}]", column.name, column.unit.name)
}

fn cells(line: &str, separator: char) -> impl Iterator<Item = &str> {
    line.split(separator).map(str::trim)
}

fn unquoted(cell: &str) -> String {
    cell.trim_matches('"').to_string()
}

fn read(lines: &mut impl BufRead, text: &mut String) -> Result<usize, EvalError> {
    lines.read_line(text).map_err(|source| EvalError::Io {
        path: "standard input".into(),
        action: "read",
        source,
        remedy: "send text in UTF-8, one sample a line",
    })
}

/// A line that is on its way before the next is read.
fn put(out: &mut impl Write, line: &str) -> Result<(), EvalError> {
    let written = writeln!(out, "{line}").and_then(|()| out.flush());
    written.map_err(|source: io::Error| EvalError::Io {
        path: "standard output".into(),
        action: "write",
        source,
        remedy: "keep the reader running as long as lines are sent",
    })
}
