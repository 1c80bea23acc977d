//! Lines in, answers out, one by one: CSV with a header, or JSON objects, whichever the first line is.
//!
//! | line                  | answer                                                                        |
//! | --------------------- | ----------------------------------------------------------------------------- |
//! | a sample              | time, outputs, what the nominal model alone says, samples since start or gap, whether all channels lie in their training range; low and high end of each output's interval where the run has one |
//! | one outside the domain | the same, with the outputs of the nominal model alone, 0 samples and no interval |
//! | what is no sample     | empty cells, or an object with `error`; a message on standard error           |
//! | empty                 | none: a new trial begins                                                      |
//!
//! No sample is also what is too long for a line, what is not UTF-8, and what leads to a number that is not finite. Values
//! are in the units of the manifest, both ways.

use std::{
    borrow::Cow,
    io::{self, BufRead, Write},
};

use crate::error::EvalError;
use acm_datasets::Domain;
use acm_stream::StepError;
use serde::de::IgnoredAny;
use serde_json::{Map, Value, json};

use super::{
    lines::{LONGEST_LINE, Line, Lines},
    robot::Robot,
    sampler::Sampler,
    wiring::{Column, Wiring},
};

/// Estimator that answers line by line.
pub struct Session {
    sampler: Sampler,
    /// Time of the last sample that was answered, s, and how many there were in this trial.
    before: Option<f64>,
    samples: u64,
    /// Values of the present line, in the units of the manifest.
    written: Vec<f64>,
}

/// Result of a session.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Samples that were answered.
    pub answered: u64,
    /// Lines that were no sample.
    pub refused: u64,
}

/// Reason why a line is no sample.
#[derive(Debug, PartialEq)]
struct Fault {
    /// Name of the column; none where it is the whole line.
    column: Option<String>,
    what: String,
    remedy: String,
}

/// Format of samples.
enum Format {
    /// CSV, with the names of its columns.
    Cells(Vec<String>),
    /// A JSON object a line.
    Objects,
}

/// One sample as it is written.
enum Written<'a> {
    /// Cells, and the index of each column among them.
    Cells(&'a [&'a str], &'a [String]),
    Object(&'a Map<String, Value>),
}

impl Session {
    /// Returns a session before the first line.
    pub fn new(estimator: Robot, wiring: Wiring, domain: Option<Domain>) -> Self {
        let written = vec![0.0; wiring.inputs.len()];
        Self { sampler: Sampler::new(estimator, wiring, domain), before: None, samples: 0, written }
    }

    /// Answers every line at once, until there is none.
    ///
    /// # Errors
    /// A header that lacks a column, or a stream that cannot be read or written.
    pub fn run(
        &mut self,
        stream: impl BufRead,
        mut out: impl Write,
        mut tell: impl FnMut(&str),
    ) -> Result<Count, EvalError> {
        let (mut lines, mut count) = (Lines::new(stream), Count::default());
        let mut format: Option<Format> = None;
        while let Some(line) = lines.next().map_err(unreadable)? {
            if line.whole && line.bytes.trim_ascii().is_empty() {
                self.restart();
                continue;
            }
            if format.is_none() {
                let found = self.format(&line)?;
                let is_header = matches!(found, Format::Cells(_));
                format = Some(found);
                if is_header {
                    put(&mut out, &self.answer_header())?;
                    continue;
                }
            }
            let names = match &format {
                Some(Format::Cells(names)) => Some(names),
                _ => None,
            };
            match self.answer(&line, names) {
                Ok(answer) => {
                    count.answered += 1;
                    put(&mut out, &answer)?;
                }
                Err(fault) => {
                    count.refused += 1;
                    let message = fault.message(line.number);
                    tell(&message);
                    put(&mut out, &self.refusal(names.is_some(), line.number, &message))?;
                }
            }
        }
        Ok(count)
    }

    /// Returns the format of the lines from the first line. A header may have bytes in the names of columns that are
    /// not used.
    fn format(&self, line: &Line) -> Result<Format, EvalError> {
        let text = String::from_utf8_lossy(line.bytes);
        let text = text.trim_start_matches('\u{feff}');
        if text.trim_start().starts_with('{') {
            return Ok(Format::Objects);
        }
        if !line.whole {
            return Err(EvalError::Data(Fault::too_long().message(line.number)));
        }
        let other_json = || serde_json::from_str::<IgnoredAny>(text).is_ok();
        match self.header(line.number, text) {
            Err(_) if other_json() => Ok(Format::Objects),
            names => names.map(Format::Cells),
        }
    }

    /// Returns the answer to a line that is to be a sample; with the header's `names`, of CSV.
    fn answer(&mut self, line: &Line, names: Option<&Vec<String>>) -> Result<String, Fault> {
        if !line.whole {
            return Err(Fault::too_long());
        }
        let text = str::from_utf8(line.bytes).map_err(|error| Fault {
            column: None,
            what: format!("byte {} is not UTF-8", error.valid_up_to() + 1),
            remedy: "send text in UTF-8, one sample a line".into(),
        })?;
        let text = text.trim_start_matches('\u{feff}');
        match names {
            Some(names) => self.cells(text, names),
            None => self.object(text),
        }
    }

    fn restart(&mut self) {
        self.sampler.restart();
        (self.before, self.samples) = (None, 0);
    }

    fn header(&self, number: u64, line: &str) -> Result<Vec<String>, EvalError> {
        let names: Vec<String> = cells(line, self.wiring().separator).map(unquoted).collect();
        let lacks = |column: &&Column| !names.contains(&column.name);
        let missing: Vec<String> =
            self.wiring().time().into_iter().chain(&self.wiring().inputs).filter(lacks).map(labelled).collect();
        if missing.is_empty() {
            return Ok(names);
        }
        Err(EvalError::Data(format!(
            "line {number}: the header has no column {}; it has {}; name the columns as in the manifest, with {:?} between them, \
             or send JSON objects",
            missing.join(", no column "),
            names.join(", "),
            self.wiring().separator
        )))
    }

    fn cells(&mut self, line: &str, names: &[String]) -> Result<String, Fault> {
        let cells: Vec<&str> = cells(line, self.wiring().separator).collect();
        if cells.len() != names.len() {
            let what = format!("{} cells where the header has {}", cells.len(), names.len());
            let column = names.get(cells.len()).map_or("behind the last", String::as_str).to_string();
            return Err(Fault { column: Some(column), what, remedy: "send one cell for each column".into() });
        }
        let time = self.step(&Written::Cells(&cells, names))?;
        let separator = self.wiring().separator.to_string();
        let numbers = self.answers().map(|(_, value)| value.to_string());
        let last = [
            self.sampler.history().to_string(),
            self.sampler.in_range().map_or(String::new(), |inside| inside.to_string()),
        ];
        let ends = self.ends().map(|(_, end)| end.map_or(String::new(), |end| end.to_string()));
        let all = [time.to_string()].into_iter().chain(numbers).chain(last).chain(ends);
        Ok(all.collect::<Vec<_>>().join(&separator))
    }

    fn object(&mut self, line: &str) -> Result<String, Fault> {
        let fault = |what: String| Fault {
            column: None,
            what,
            remedy: "send one JSON object a line, such as {\"t\": 0.1, \"q1\": 0.2}".into(),
        };
        let object: Map<String, Value> = match serde_json::from_str(line).map_err(|error| fault(error.to_string()))? {
            Value::Object(object) => object,
            other => return Err(fault(format!("it is {}, no object", kind(&other)))),
        };
        let time = self.step(&Written::Object(&object))?;
        let mut answer = Map::new();
        answer.insert(self.time_name(), json!(time));
        answer.extend(self.answers().map(|(name, value)| (name, json!(value))));
        answer.insert("history".into(), json!(self.sampler.history()));
        answer.insert("in_range".into(), json!(self.sampler.in_range()));
        answer.extend(self.ends().map(|(name, end)| (name, json!(end))));
        Ok(Value::Object(answer).to_string())
    }

    /// Takes a sample; returns its time in the unit of its column, or in s.
    fn step(&mut self, line: &Written) -> Result<f64, Fault> {
        let wiring = self.sampler.wiring();
        let written = wiring.time().map(|column| line.value(column)).transpose()?;
        let seconds = wiring.clock.seconds(self.samples, written.unwrap_or(0.0));
        if !seconds.is_finite() {
            return Err(Fault::not_finite(self.time_name(), "s", seconds));
        }
        for (value, column) in self.written.iter_mut().zip(&wiring.inputs) {
            *value = line.value(column)?;
        }
        let elapsed = self.before.map_or(0.0, |before| seconds - before);
        self.sampler.step(&self.written, elapsed).map_err(|error| self.fault(error, written))?;
        self.before = Some(seconds);
        self.samples += 1;
        Ok(written.unwrap_or(seconds))
    }

    fn fault(&self, error: StepError, time: Option<f64>) -> Fault {
        match error {
            StepError::NotFinite { index, value } => {
                Fault::not_finite(self.wiring().inputs[index].name.clone(), "SI units", value)
            }
            StepError::Elapsed { elapsed } => Fault {
                column: Some(self.time_name()),
                what: format!("{} is {} s before the last sample", time.unwrap_or(0.0), -elapsed),
                remedy: "sort the lines, or send an empty line before a new trial".into(),
            },
            StepError::Overflow { what, index, value } => Fault {
                column: None,
                what: format!("{what} {index} comes out as {value}, so large are the values"),
                remedy: "check their units, or leave the line out".into(),
            },
            error @ StepError::Count { .. } => {
                Fault { column: None, what: error.to_string(), remedy: "send a value for each signal".into() }
            }
        }
    }

    /// Returns names and values of outputs, then of the nominal model's, in the manifest's units.
    fn answers(&self) -> impl Iterator<Item = (String, f64)> {
        let names = || self.wiring().outputs.iter().map(|column| column.name.clone());
        let nominal = names().map(|name| format!("nominal_{name}")).zip(self.sampler.nominal());
        names().zip(self.sampler.outputs()).chain(nominal)
    }

    /// Returns names and values of the interval's ends, in the manifest's units; no values where the network did not
    /// answer.
    fn ends(&self) -> impl Iterator<Item = (String, Option<f64>)> {
        let of_output = |(o, column): (usize, &Column)| {
            let [low, high] = self.sampler.ends(o).map_or([None; 2], |ends| ends.map(Some));
            [(format!("low_{}", column.name), low), (format!("high_{}", column.name), high)]
        };
        let outputs = self.sampler.interval().map(|_| self.wiring().outputs.iter().enumerate());
        outputs.into_iter().flatten().flat_map(of_output)
    }

    fn wiring(&self) -> &Wiring {
        self.sampler.wiring()
    }

    fn answer_header(&self) -> String {
        let names = self.answers().map(|(name, _)| name);
        let last = ["history".into(), "in_range".into()].into_iter().chain(self.ends().map(|(name, _)| name));
        let all = [self.time_name()].into_iter().chain(names).chain(last);
        all.collect::<Vec<_>>().join(&self.wiring().separator.to_string())
    }

    fn refusal(&self, cells: bool, number: u64, message: &str) -> String {
        match cells {
            true => {
                self.wiring().separator.to_string().repeat(2 * self.wiring().outputs.len() + 2 + self.ends().count())
            }
            false => json!({ "line": number, "error": message }).to_string(),
        }
    }

    fn time_name(&self) -> String {
        self.wiring().time().map_or("t".into(), |column| column.name.clone())
    }
}

impl Fault {
    fn too_long() -> Self {
        Self {
            column: None,
            what: format!("it is longer than {LONGEST_LINE} bytes"),
            remedy: "send one sample a line, each with an end of line; the rest of this one is passed over".into(),
        }
    }

    fn not_finite(column: String, unit: &str, value: f64) -> Self {
        let remedy = "write a number of the signal's size, or leave the line out until there is one".into();
        Self { column: Some(column), what: format!("it is {value} in {unit}"), remedy }
    }

    fn message(&self, line: u64) -> String {
        let column = self.column.as_ref().map_or(Cow::Borrowed(""), |column| format!(", column {column}").into());
        format!("line {line}{column}: {}; {}", self.what, self.remedy)
    }
}

impl Written<'_> {
    fn value(&self, column: &Column) -> Result<f64, Fault> {
        let unit = column.unit.name;
        let fault = |what: String| Fault {
            column: Some(column.name.clone()),
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

/// Names the kind of a JSON value that is no object.
fn kind(value: &Value) -> &'static str {
    match value {
        Value::Array(_) => "a list",
        Value::String(_) => "a text",
        Value::Number(_) => "a number",
        Value::Bool(_) => "a truth value",
        Value::Null => "null",
        Value::Object(_) => "an object",
    }
}

fn unreadable(source: io::Error) -> EvalError {
    EvalError::Io {
        path: "standard input".into(),
        action: "read",
        source,
        remedy: "keep the sender running as long as samples are to come",
    }
}

/// Writes a line, and sends it before the next is read.
fn put(out: &mut impl Write, line: &str) -> Result<(), EvalError> {
    let written = writeln!(out, "{line}").and_then(|()| out.flush());
    written.map_err(|source: io::Error| EvalError::Io {
        path: "standard output".into(),
        action: "write",
        source,
        remedy: "keep the reader running as long as lines are sent",
    })
}
