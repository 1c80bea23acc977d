//! The topics of a log: selected fields of each message become columns.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use px4_ulog::stream_parser::model::{DataMessage, FlattenedFieldType, FlattenedFormat};

use crate::error::DataError;
use crate::formats::{Column, Group, Keep, VALUE_LIMIT, check_size};

/// A topic and instance, and how its messages are taken apart.
struct Topic {
    group: Group,
    /// Place of the time in a message.
    stamp: usize,
    /// Type, place in a message and column of what is kept.
    fields: Vec<(FlattenedFieldType, usize, usize)>,
}

/// All topics, and which of them each number in the messages names.
pub(super) struct Topics<'a> {
    path: PathBuf,
    keep: Keep<'a>,
    topics: Vec<Topic>,
    by_number: Vec<Named>,
    values: usize,
    /// Topics without a time stamp of 64 bits.
    pub untimed: BTreeSet<String>,
}

/// What a number in a message names.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Named {
    Unknown,
    /// A topic that is skipped.
    Skipped,
    /// Index of a topic.
    Topic(usize),
}

impl<'a> Topics<'a> {
    pub fn new(path: &Path, keep: Keep<'a>) -> Self {
        let (topics, by_number, untimed) = (Vec::new(), Vec::new(), BTreeSet::new());
        Self { path: path.to_path_buf(), keep, topics, by_number, values: 0, untimed }
    }

    /// What the number of a message names. A topic that is subscribed again, under another number, goes on.
    fn named(&mut self, message: &DataMessage) -> Named {
        let Some(new) = topic(message.flattened_format, message.multi_id.value(), self.keep) else {
            self.untimed.insert(visible(&message.flattened_format.message_name));
            return Named::Skipped;
        };
        let same = |old: &Topic| old.group.name == new.group.name && old.stamp == new.stamp && old.fields == new.fields;
        let before = self.topics.iter().position(|old| same(old) && old.group.columns.len() == new.group.columns.len());
        Named::Topic(before.unwrap_or_else(|| {
            self.topics.push(new);
            self.topics.len() - 1
        }))
    }

    /// Takes one message.
    pub fn take(&mut self, message: &DataMessage) {
        let index = message.msg_id as usize;
        if index >= self.by_number.len() {
            self.by_number.resize(index + 1, Named::Unknown);
        }
        if self.by_number[index] == Named::Unknown {
            self.by_number[index] = self.named(message);
        }
        let Named::Topic(topic) = self.by_number[index] else { return };
        let topic = &mut self.topics[topic];
        let Some(time) = seconds(message.data, topic.stamp) else { return };
        let group = &mut topic.group;
        if group.samples == 0 {
            group.span.0 = time;
        }
        (group.span.1, group.samples) = (time, group.samples + 1);
        if topic.fields.is_empty() || self.values > VALUE_LIMIT {
            return;
        }
        group.time.push(time);
        self.values += 1 + topic.fields.len();
        for (kind, at, column) in &topic.fields {
            group.columns[*column].values.push(value(kind, message.data.get(*at..).unwrap_or_default()));
        }
    }

    /// Refuses a log of which more is asked for than is held.
    pub fn full(&self) -> Result<(), DataError> {
        check_size(&self.path, self.values)
    }

    /// The topics that have samples, by name.
    pub fn groups(self) -> Result<Vec<Group>, DataError> {
        self.full()?;
        let mut groups: Vec<Group> = self.topics.into_iter().map(|topic| topic.group).collect();
        groups.retain(|group| group.samples > 0);
        groups.sort_by(|a, b| a.name.cmp(&b.name));
        for pair in 1..groups.len() {
            if groups[pair].name == groups[pair - 1].name {
                let name = format!("{} ({pair})", groups[pair].name);
                groups[pair].columns.iter_mut().for_each(|c| c.name = format!("{} ({pair})", c.name));
                groups[pair].name = name;
            }
        }
        Ok(groups)
    }
}

/// A topic with a time stamp; others have no place on a clock.
fn topic(format: &FlattenedFormat, instance: u8, keep: Keep) -> Option<Topic> {
    let stamp = format.timestamp_field.as_ref()?.offset as usize;
    let name = match instance {
        0 => visible(&format.message_name),
        more => format!("{}[{more}]", visible(&format.message_name)),
    };
    let (mut columns, mut fields) = (Vec::new(), Vec::new());
    for field in format.fields.iter().filter(|field| field.flattened_field_name != "timestamp") {
        let full = format!("{name}.{}", visible(&field.flattened_field_name));
        if keep.keeps(&full) {
            fields.push((field.field_type.clone(), field.offset as usize, columns.len()));
        }
        columns.push(Column { name: full, unit: None, values: Vec::new() });
    }
    let group = Group { name, columns, first_row: 1, ..Group::default() };
    Some(Topic { group, stamp, fields })
}

fn visible(name: &str) -> String {
    name.chars().filter(|c| !c.is_control()).collect()
}

fn seconds(message: &[u8], at: usize) -> Option<f64> {
    let bytes = message.get(at..at + 8)?.try_into().ok()?;
    Some(u64::from_le_bytes(bytes) as f64 / 1e6)
}

/// The number at the beginning of `bytes`; NaN where they are too few.
fn value(kind: &FlattenedFieldType, bytes: &[u8]) -> f64 {
    use FlattenedFieldType as Type;
    fn first<const N: usize>(bytes: &[u8]) -> Option<[u8; N]> {
        bytes.get(..N)?.try_into().ok()
    }
    let number = match kind {
        Type::Int8 => first(bytes).map(|b| f64::from(i8::from_le_bytes(b))),
        Type::UInt8 | Type::Bool | Type::Char => first(bytes).map(|[b]: [u8; 1]| f64::from(b)),
        Type::Int16 => first(bytes).map(|b| f64::from(i16::from_le_bytes(b))),
        Type::UInt16 => first(bytes).map(|b| f64::from(u16::from_le_bytes(b))),
        Type::Int32 => first(bytes).map(|b| f64::from(i32::from_le_bytes(b))),
        Type::UInt32 => first(bytes).map(|b| f64::from(u32::from_le_bytes(b))),
        Type::Int64 => first(bytes).map(|b| i64::from_le_bytes(b) as f64),
        Type::UInt64 => first(bytes).map(|b| u64::from_le_bytes(b) as f64),
        Type::Float => first(bytes).map(|b| f64::from(f32::from_le_bytes(b))),
        Type::Double => first(bytes).map(f64::from_le_bytes),
    };
    number.filter(|value| value.is_finite()).unwrap_or(f64::NAN)
}
