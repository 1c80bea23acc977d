//! Messages of one topic.

use std::collections::BTreeMap;

use ::mcap::{Channel, Message};
use re_ros_msg::MessageSchema;

use super::layout::{Item, layout};
use super::message::{Paths, Values, WIDEST, read};
use crate::error::short;
use crate::formats::{Column, Group, Keep};

/// A topic.
pub(super) struct Topic {
    pub name: String,
    /// Encoding of its messages, and their schema.
    form: Form,
    /// Layout of its messages; or the reason why they are not read.
    layout: Result<Item, String>,
    /// Indices of columns by path.
    places: BTreeMap<String, usize>,
    columns: Vec<Kept>,
    /// Fields of the last message.
    fields: Fields,
    time: Vec<f64>,
    log_time: Vec<f64>,
    /// Whether `log_time` is wanted.
    keeps_log_time: bool,
    samples: usize,
    span: (f64, f64),
    stamped: usize,
    /// Texts `name[…]` of the first message.
    names: Vec<String>,
    renamed: bool,
    refused: BTreeMap<String, usize>,
}

/// The numbers of a field over time.
struct Kept {
    is_wanted: bool,
    values: Vec<f64>,
}

/// What the numbers and texts of a message are.
#[derive(Default)]
struct Fields {
    /// Of [`Values`]; none before the first message.
    lengths: Option<Vec<usize>>,
    /// Column of each number; none beyond [`WIDEST`] columns.
    columns: Vec<Option<usize>>,
    /// Whether the first two numbers are the stamp of a header.
    stamped: bool,
    /// Which texts are `name[…]`.
    names: Vec<usize>,
}

/// Facts of a topic.
#[derive(Default)]
pub(super) struct Said {
    pub notes: Vec<String>,
    pub lost: Vec<String>,
}

impl Topic {
    pub fn new(channel: &Channel, keep: Keep) -> Topic {
        let layout = match &channel.schema {
            Some(schema) if channel.message_encoding == "cdr" && schema.encoding == "ros2msg" => {
                let text = String::from_utf8_lossy(&schema.data);
                let parsed = MessageSchema::parse(&schema.name, &text).map(|schema| layout(&schema));
                parsed.map_err(|e| format!("its schema cannot be read: {}", short(&e.to_string(), 80)))
            }
            Some(schema) => Err(format!(
                "messages of encoding {:?} with a schema of {:?} are not supported",
                channel.message_encoding, schema.encoding
            )),
            None => Err("it has no schema".to_string()),
        };
        let name = name(channel);
        Topic {
            keeps_log_time: keep.keeps(&format!("{name}.log_time")),
            name,
            form: form(channel),
            layout,
            places: BTreeMap::new(),
            columns: Vec::new(),
            fields: Fields::default(),
            time: Vec::new(),
            log_time: Vec::new(),
            samples: 0,
            span: (0.0, 0.0),
            stamped: 0,
            names: Vec::new(),
            renamed: false,
            refused: BTreeMap::new(),
        }
    }

    /// Whether the messages of a channel are of this topic and read alike.
    pub fn is_of(&self, channel: &Channel) -> bool {
        self.name == name(channel) && self.form == form(channel)
    }

    /// Takes one message; how many values are kept of it.
    pub fn take(&mut self, message: &Message, keep: Keep) -> usize {
        let Ok(layout) = &self.layout else { return 0 };
        let values = read::<Values>(layout, &message.data).and_then(|values| {
            self.recognise(&values, &message.data, keep)?;
            Ok(values)
        });
        match values {
            Ok(values) => self.add(&values, message.log_time as f64 / 1e9, keep),
            Err(why) => {
                *self.refused.entry(why).or_insert(0) += 1;
                0
            }
        }
    }

    /// Names the fields of a message, unless they are those of the message before.
    fn recognise(&mut self, values: &Values, data: &[u8], keep: Keep) -> Result<(), String> {
        let (Ok(layout), true) = (&self.layout, self.fields.lengths.as_ref() != Some(&values.lengths)) else {
            return Ok(());
        };
        let Paths { numbers, texts, .. } = read(layout, data)?;
        let stamp = ["header.stamp.sec", "header.stamp.nanosec"];
        self.fields = Fields {
            lengths: Some(values.lengths.clone()),
            stamped: numbers.iter().take(2).eq(stamp),
            names: (0..texts.len()).filter(|&k| texts[k].starts_with("name[")).collect(),
            columns: numbers.into_iter().map(|path| self.column(path, keep)).collect(),
        };
        Ok(())
    }

    /// The column of a path, a new one where there is none.
    fn column(&mut self, path: String, keep: Keep) -> Option<usize> {
        if let Some(&known) = self.places.get(&path) {
            return Some(known);
        }
        if self.columns.len() >= WIDEST {
            return None;
        }
        let is_wanted = keep.keeps(&format!("{}.{path}", self.name));
        self.columns.push(Kept { is_wanted, values: Vec::new() });
        self.places.insert(path, self.columns.len() - 1);
        Some(self.columns.len() - 1)
    }

    fn add(&mut self, values: &Values, log_time: f64, keep: Keep) -> usize {
        let stamp = stamp(&values.numbers).filter(|_| self.fields.stamped);
        self.stamped += usize::from(stamp.is_some());
        let time = stamp.unwrap_or(log_time);
        let names = self.fields.names.iter().map(|&k| values.texts[k]);
        if self.samples == 0 {
            (self.span.0, self.names) = (time, names.map(String::from).collect());
        } else {
            self.renamed |= !names.eq(self.names.iter().map(String::as_str));
        }
        self.span.1 = time;
        let before = self.samples;
        self.samples += 1;
        let mut kept = 0;
        for (place, &value) in self.fields.columns.iter().zip(&values.numbers) {
            let Some(column) = place.map(|place| &mut self.columns[place]).filter(|column| column.is_wanted) else {
                continue;
            };
            kept += 1 + before.saturating_sub(column.values.len());
            column.values.resize(before, f64::NAN); // the field was not there before
            column.values.push(if value.is_finite() { value } else { f64::NAN });
        }
        if self.keeps_log_time {
            self.log_time.push(log_time);
        }
        if kept > 0 || self.keeps_log_time || !self.time.is_empty() || matches!(keep, Keep::Named(_)) {
            self.time.push(time);
        }
        kept + 2
    }

    /// The topic as a group, if it has samples, and notes on it.
    pub fn finish(mut self) -> (Option<Group>, Said) {
        let mut said = Said::default();
        let name = &self.name;
        if let Err(why) = &self.layout {
            said.notes.push(format!("topic `{name}` is skipped: {why}"));
        }
        for (why, count) in &self.refused {
            said.lost.push(format!("topic `{name}`: {count} messages are not read: {why}"));
        }
        if self.renamed {
            said.lost.push(format!(
                "topic `{name}`: the texts `name` change from message to message, so that indices mean different things"
            ));
        }
        if self.samples == 0 {
            return (None, said);
        }
        let clock = match self.stamped {
            0 => "the time at which messages were recorded",
            all if all == self.samples => "header.stamp",
            _ => "header.stamp, and the time at which they were recorded where that is 0",
        };
        said.notes.push(format!("topic `{name}`: time is {clock}"));
        if !self.names.is_empty() {
            let named: Vec<String> = self.names.iter().enumerate().map(|(i, name)| format!("[{i}] {name}")).collect();
            said.notes.push(format!("topic `{name}`: {}", short(&named.join(", "), 200)));
        }
        let samples = self.samples;
        let mut column = |(path, &place): (&String, &usize)| {
            let mut values = std::mem::take(&mut self.columns[place].values);
            if !values.is_empty() {
                values.resize(samples, f64::NAN);
            }
            Column { name: format!("{name}.{path}"), unit: None, values }
        };
        let mut columns: Vec<Column> = self.places.iter().map(&mut column).collect();
        columns.push(Column {
            name: format!("{name}.log_time"),
            unit: Some("s"),
            values: std::mem::take(&mut self.log_time),
        });
        let kept = columns.iter().any(|column| !column.values.is_empty());
        let time = if kept { std::mem::take(&mut self.time) } else { Vec::new() };
        let (name, span) = (self.name.clone(), self.span);
        (Some(Group { name, samples, span, rate: None, time, columns, first_row: 1 }), said)
    }
}

/// Encoding of messages, and name, encoding and text of their schema.
type Form = (String, Option<(String, String, Vec<u8>)>);

fn form(channel: &Channel) -> Form {
    let schema = channel.schema.as_ref();
    let schema = schema.map(|schema| (schema.name.clone(), schema.encoding.clone(), schema.data.to_vec()));
    (channel.message_encoding.clone(), schema)
}

fn name(channel: &Channel) -> String {
    channel.topic.chars().filter(|c| !c.is_control()).collect()
}

/// The stamp of a header, seconds and nanoseconds, s; none where it is 0.
fn stamp(numbers: &[f64]) -> Option<f64> {
    let (sec, nanosec) = (numbers.first()?, numbers.get(1)?);
    (*sec != 0.0 || *nanosec != 0.0).then_some(sec + nanosec / 1e9)
}
