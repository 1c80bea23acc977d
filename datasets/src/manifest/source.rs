//! `[[source]]`: recordings of one trial in several files, each with a clock of its own.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, Visitor};
use serde::{Deserialize, Serialize};

use super::{Quantity, Time, TrialName};
use crate::formats::Format;
use crate::join::Rule;

/// One source of every trial. Its columns are `name.column` everywhere else in the manifest.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Source {
    /// Prefix of its columns.
    pub name: String,
    /// Patterns relative to the data folder.
    pub files: Vec<String>,
    /// Format of the files; by extension and content where it is omitted.
    pub format: Option<Format>,
    /// Where a trial's name stands: `file` alone; the file name without extension where it is omitted.
    pub trial: TrialName,
    /// Its one file holds all trials.
    pub shared: bool,
    /// Its clock is that of the others (`reference`), or runs with it (`same`).
    pub clock: Option<Clock>,
    /// Where time stands; of tables alone.
    pub time: Time,
    /// Separator of CSV cells, one character; recognised where it is omitted.
    pub separator: Option<String>,
    /// Decimal separator in CSV, `","` or `"."`; recognised where it is omitted.
    pub decimal: Option<String>,
    /// Offset added to its time.
    pub offset: Option<Offset>,
    /// Rate of the reference's clock relative to this one.
    pub drift: Option<Drift>,
    /// Resampling to the reference's samples.
    pub resample: Rule,
    /// Longer distances of samples are gaps; five of its steps where it is omitted.
    pub gap: Option<Quantity>,
    /// Columns of angles that are written within one turn; they are unwrapped.
    pub angles: Vec<String>,
    /// Range of each counter, such as 65536; they are unwrapped.
    pub counters: BTreeMap<String, f64>,
    /// Four columns each of unit quaternions, which are turned along great circles.
    pub quaternions: Vec<[String; 4]>,
}

/// Clock of a source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Clock {
    /// The others' clocks are brought to this one, and its samples are those of the trial.
    Reference,
    /// Clock of the reference: nothing is added.
    Same,
}

/// `"estimate"`, `"common"`, or a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Offset {
    /// `estimate`: of each trial; `common`: one for all.
    Word(Word),
    /// A given offset, an event, or more about an estimate.
    Table(OffsetTable),
}

/// Kinds of estimated offsets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Word {
    /// Each trial has its own.
    Estimate,
    /// All trials have one: the median of theirs.
    Common,
}

/// `0.12`, or `{ run_1 = 0.12, run_2 = 3.4 }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "a number, or numbers by trial such as { run_1 = 0.12, run_2 = 3.4 }, is expected")]
pub enum ByTrial {
    /// One number for all trials.
    All(f64),
    /// Numbers by the names of trials.
    Each(BTreeMap<String, f64>),
}

/// `{ value, unit }`, `{ event, above, reference, reference_above }` or `{ estimate = "estimate", by, around, within }`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OffsetTable {
    /// Given, in `unit`.
    pub value: Option<ByTrial>,
    /// Unit of `value`.
    pub unit: Option<String>,
    /// Estimated: `estimate` or `common`.
    pub estimate: Option<Word>,
    /// The columns that are compared, `[reference's, source's]`; all where it is omitted.
    pub by: Vec<String>,
    /// It is looked for around this offset, s; everywhere in trials without one.
    pub around: Option<ByTrial>,
    /// Longest distance from it, s.
    pub within: Option<f64>,
    /// Column of this source that rises at an event.
    pub event: Option<String>,
    /// Threshold that it rises above, in its unit.
    pub above: Option<f64>,
    /// Column of the reference that rises at the same event.
    pub reference: Option<String>,
    /// Threshold that it rises above, in its unit.
    pub reference_above: Option<f64>,
}

/// `"estimate"` or `{ ppm = 40.0 }`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Drift {
    /// Estimated with the offset.
    Word(Word),
    /// Given.
    Table(DriftTable),
}

/// A given drift.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DriftTable {
    /// Parts per million.
    pub ppm: f64,
}

impl ByTrial {
    /// The number of a trial.
    pub fn of(&self, trial: &str) -> Option<f64> {
        match self {
            ByTrial::All(number) => Some(*number),
            ByTrial::Each(numbers) => numbers.get(trial).copied(),
        }
    }

    /// The named trials with their numbers, or the number of all.
    pub fn numbers(&self) -> Vec<(Option<&str>, f64)> {
        match self {
            ByTrial::All(number) => vec![(None, *number)],
            ByTrial::Each(numbers) => numbers.iter().map(|(trial, number)| (Some(trial.as_str()), *number)).collect(),
        }
    }
}

impl Offset {
    /// All that is said of it.
    pub fn table(&self) -> OffsetTable {
        match self {
            Offset::Word(word) => OffsetTable { estimate: Some(*word), ..OffsetTable::default() },
            Offset::Table(table) => table.clone(),
        }
    }
}

impl Source {
    /// Whether the reference's samples are its samples.
    pub fn is_reference(&self) -> bool {
        self.clock == Some(Clock::Reference)
    }

    /// The column's name in the source's files, of a name in the manifest.
    pub fn column<'a>(&self, full: &'a str) -> Option<&'a str> {
        full.strip_prefix(self.name.as_str())?.strip_prefix('.')
    }
}

/// A word, or a table: what is wrong in it keeps its place.
struct WordOr<T>(std::marker::PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for WordOr<T> {
    type Value = Result<Word, T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a text in quotes, or a table")
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Self::Value, E> {
        match text {
            "estimate" => Ok(Ok(Word::Estimate)),
            "common" => Ok(Ok(Word::Common)),
            _ => Err(E::unknown_variant(text, &["estimate", "common"])),
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(Err)
    }
}

impl<'de> Deserialize<'de> for Offset {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let read = deserializer.deserialize_any(WordOr::<OffsetTable>(std::marker::PhantomData))?;
        Ok(read.map_or_else(Offset::Table, Offset::Word))
    }
}

impl<'de> Deserialize<'de> for Drift {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let read = deserializer.deserialize_any(WordOr::<DriftTable>(std::marker::PhantomData))?;
        Ok(read.map_or_else(Drift::Table, Drift::Word))
    }
}

/// The key `source`: a text that says where the data come from, or the tables `[[source]]`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sources {
    /// Where the data come from.
    pub text: String,
    /// Several recordings of each trial.
    pub list: Vec<Source>,
}

impl Serialize for Sources {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.list.is_empty() {
            true => self.text.serialize(serializer),
            false => self.list.serialize(serializer),
        }
    }
}

struct TextOrTables;

impl<'de> Visitor<'de> for TextOrTables {
    type Value = Sources;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a text in quotes, or tables [[source]]")
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Sources, E> {
        Ok(Sources { text: text.to_string(), list: Vec::new() })
    }

    fn visit_seq<A: serde::de::SeqAccess<'de>>(self, mut members: A) -> Result<Sources, A::Error> {
        let mut list = Vec::new();
        while let Some(source) = members.next_element()? {
            list.push(source);
        }
        Ok(Sources { text: String::new(), list })
    }
}

impl<'de> Deserialize<'de> for Sources {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TextOrTables)
    }
}

impl From<String> for Sources {
    fn from(text: String) -> Self {
        Self { text, list: Vec::new() }
    }
}
