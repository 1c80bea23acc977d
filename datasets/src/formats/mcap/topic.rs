//! Messages of one topic.

use std::collections::BTreeMap;

use ::mcap::{Channel, Message};
use re_cdr::{BigEndian, CdrReader, LittleEndian};
use re_ros_msg::MessageSchema;

use super::fields::{Visit, Walk};
use crate::error::short;
use crate::formats::{Column, Group, Keep};

/// Columns of a topic, at most.
const WIDEST: usize = 4096;

/// A topic.
pub(super) struct Topic {
    name: String,
    /// Schema of its messages; or the reason why they are not read.
    schema: Result<MessageSchema, String>,
    /// Columns by path, and the numbers of the message before they are kept.
    columns: BTreeMap<String, Vec<f64>>,
    time: Vec<f64>,
    log_time: Vec<f64>,
    samples: usize,
    span: (f64, f64),
    stamped: usize,
    /// Texts `name[…]` of the first message.
    names: Vec<String>,
    renamed: bool,
    refused: BTreeMap<String, usize>,
}

/// Facts of a topic.
#[derive(Default)]
pub(super) struct Said {
    pub notes: Vec<String>,
    pub lost: Vec<String>,
}

/// The numbers of one message.
#[derive(Default)]
struct Numbers {
    all: Vec<(String, f64)>,
    names: Vec<String>,
}

impl Visit for Numbers {
    fn number(&mut self, path: &str, value: f64) {
        if self.all.len() < WIDEST {
            self.all.push((path.to_string(), value));
        }
    }

    fn text(&mut self, path: &str, text: &str) {
        if path.starts_with("name[") && self.names.len() < WIDEST {
            self.names.push(text.to_string());
        }
    }
}

impl Topic {
    pub fn new(channel: &Channel) -> Topic {
        let schema = match &channel.schema {
            Some(schema) if channel.message_encoding == "cdr" && schema.encoding == "ros2msg" => {
                let text = String::from_utf8_lossy(&schema.data);
                let parsed = MessageSchema::parse(&schema.name, &text);
                parsed.map_err(|e| format!("its schema cannot be read: {}", short(&e.to_string(), 80)))
            }
            Some(schema) => Err(format!(
                "messages of encoding {:?} with a schema of {:?} are not read",
                channel.message_encoding, schema.encoding
            )),
            None => Err("it has no schema".to_string()),
        };
        let name = channel.topic.chars().filter(|c| !c.is_control()).collect();
        let (columns, refused) = (BTreeMap::new(), BTreeMap::new());
        let (time, log_time, names) = (Vec::new(), Vec::new(), Vec::new());
        let (samples, span, stamped, renamed) = (0, (0.0, 0.0), 0, false);
        Topic { name, schema, columns, time, log_time, samples, span, stamped, names, renamed, refused }
    }

    /// Takes one message; how many values are kept of it.
    pub fn take(&mut self, message: &Message, keep: Keep) -> usize {
        let Ok(schema) = &self.schema else { return 0 };
        let numbers = match numbers(schema, &message.data) {
            Ok(numbers) => numbers,
            Err(why) => {
                *self.refused.entry(why).or_insert(0) += 1;
                return 0;
            }
        };
        let log_time = message.log_time as f64 / 1e9;
        let time = stamp(&numbers.all);
        self.stamped += usize::from(time.is_some());
        let time = time.unwrap_or(log_time);
        if self.samples == 0 {
            (self.span.0, self.names) = (time, numbers.names);
        } else {
            self.renamed |= self.names != numbers.names;
        }
        self.span.1 = time;
        self.samples += 1;
        self.keep(time, log_time, numbers.all, keep)
    }

    fn keep(&mut self, time: f64, log_time: f64, numbers: Vec<(String, f64)>, keep: Keep) -> usize {
        let before = self.samples - 1;
        let mut kept = 0;
        for (path, value) in numbers {
            let full = format!("{}.{path}", self.name);
            let wanted = keep.keeps(&full);
            if self.columns.len() >= WIDEST && !self.columns.contains_key(&path) {
                continue;
            }
            let values = self.columns.entry(path).or_default();
            if wanted {
                kept += 1 + before.saturating_sub(values.len());
                values.resize(before, f64::NAN); // the field was not there before
                values.push(if value.is_finite() { value } else { f64::NAN });
            }
        }
        let stamped = keep.keeps(&format!("{}.log_time", self.name));
        if stamped {
            self.log_time.push(log_time);
        }
        if kept > 0 || stamped || !self.time.is_empty() || matches!(keep, Keep::Named(_)) {
            self.time.push(time);
        }
        kept + 2
    }

    /// The topic as a group, if it has samples, and notes on it.
    pub fn finish(mut self) -> (Option<Group>, Said) {
        let mut said = Said::default();
        let name = &self.name;
        if let Err(why) = &self.schema {
            said.notes.push(format!("topic `{name}` is passed over: {why}"));
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
        let mut columns: Vec<Column> = std::mem::take(&mut self.columns)
            .into_iter()
            .map(|(path, mut values)| {
                if !values.is_empty() {
                    values.resize(samples, f64::NAN);
                }
                Column { name: format!("{name}.{path}"), unit: None, values }
            })
            .collect();
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

/// The numbers of a message in the encoding that its first four bytes declare.
fn numbers(schema: &MessageSchema, data: &[u8]) -> Result<Numbers, String> {
    let mut numbers = Numbers::default();
    let (Some(little), Some(body)) = (data.get(1), data.get(4..)) else {
        return Err("it is shorter than its head".into());
    };
    let path = String::new();
    let done = match little & 1 {
        1 => Walk { reader: CdrReader::<LittleEndian>::new(body), schema, visit: &mut numbers, path }
            .message(&schema.spec, 0),
        _ => Walk { reader: CdrReader::<BigEndian>::new(body), schema, visit: &mut numbers, path }
            .message(&schema.spec, 0),
    };
    done.map(|()| numbers).map_err(|e| short(&e.to_string(), 80))
}

/// The stamp of a header at the beginning, s; none where it is 0.
fn stamp(numbers: &[(String, f64)]) -> Option<f64> {
    let (sec, nanosec) = (numbers.first()?, numbers.get(1)?);
    let stamped = sec.0 == "header.stamp.sec" && nanosec.0 == "header.stamp.nanosec";
    (stamped && (sec.1 != 0.0 || nanosec.1 != 0.0)).then_some(sec.1 + nanosec.1 / 1e9)
}
