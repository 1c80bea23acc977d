//! Experiment file → [`Experiment`], or a complaint that underlines the key.

use std::path::{Path, PathBuf};

use acm_models::NetworkConfig;
use serde_path_to_error::Segment;
use toml::{Table, Value};

use super::{Complaint, Experiment, Source, validate::faults};
use crate::error::TrainError;

/// Reads an experiment file, applies the edits of the command line, and checks every value.
///
/// # Errors
/// Anything that is unreadable, unknown, of a wrong type, not finite, or out of bounds; with its place and a remedy.
pub fn read(file: &Path, edits: &[String]) -> Result<(Experiment, Source), TrainError> {
    let mut source = Source::read(file, edits)?;
    name_the_default_network(&mut source.tree);
    if let Some(key) = not_finite(&source.tree) {
        let what = format!("`{}` is not a finite number", key.join("."));
        return Err(Box::new(source.complaint(&key, what, "write a finite number, or leave the key out")).into());
    }
    let experiment = decode(&source.tree).map_err(|refusal| Box::new(refusal.complaint(&source)))?;
    match faults(&experiment).into_iter().next() {
        Some(fault) => Err(Box::new(source.complaint(&fault.key(), fault.what, fault.help)).into()),
        None => Ok((experiment, source)),
    }
}

/// The folder that `path` means: from the current directory, else from the experiment file's folder or one above it.
pub fn find_folder(path: &Path, file: &Path) -> Option<PathBuf> {
    let above = std::path::absolute(file).unwrap_or_else(|_| file.into());
    let places = std::iter::once(Path::new("")).chain(above.ancestors().skip(1));
    places.map(|place| place.join(path)).find(|folder| folder.is_dir())
}

/// `[network]` without a kind keeps the default one, like any other field that is left out.
fn name_the_default_network(tree: &mut Table) {
    if let Some(Value::Table(network)) = tree.get_mut("network") {
        let kind = NetworkConfig::default().kind();
        network.entry("kind").or_insert_with(|| Value::String(kind.into()));
    }
}

struct Refusal {
    key: Vec<String>,
    message: String,
}

fn decode(tree: &Table) -> Result<Experiment, Refusal> {
    attempt(tree).map_err(|refusal| {
        let key = culprit(tree, &refusal);
        Refusal { key, ..refusal }
    })
}

fn attempt(tree: &Table) -> Result<Experiment, Refusal> {
    serde_path_to_error::deserialize(Value::Table(tree.clone())).map_err(|error| Refusal {
        key: error.path().iter().filter_map(part).collect(),
        message: error.inner().to_string().trim_end().to_string(),
    })
}

fn part(segment: &Segment) -> Option<String> {
    match segment {
        Segment::Map { key } => Some(key.clone()),
        Segment::Seq { index } => Some(index.to_string()),
        Segment::Enum { .. } | Segment::Unknown => None,
    }
}

/// Serde reads a table that is chosen by a tag (`kind = "cfc"`) into a buffer, and so forgets at which key it was.
/// The culprit is the key whose removal changes the complaint; the tag is suspected last.
fn culprit(tree: &Table, refusal: &Refusal) -> Vec<String> {
    let mut key = refusal.key.clone();
    while let Some(Value::Table(table)) = look_up(tree, &key) {
        let mut names: Vec<&String> = table.keys().collect();
        names.sort_by_key(|name| *name == "kind");
        let guilty = names.into_iter().find(|name| {
            let mut without = tree.clone();
            remove(&mut without, &key, name);
            !attempt(&without).is_err_and(|other| other.message == refusal.message)
        });
        match guilty {
            Some(name) => key.push(name.clone()),
            None => break,
        }
    }
    key
}

fn look_up<'a>(tree: &'a Table, key: &[String]) -> Option<&'a Value> {
    let (first, rest) = key.split_first()?;
    rest.iter().try_fold(tree.get(first)?, |at, name| match at {
        Value::Table(table) => table.get(name),
        Value::Array(items) => items.get(name.parse::<usize>().ok()?),
        _ => None,
    })
}

fn remove(tree: &mut Table, key: &[String], name: &str) {
    let mut at = tree;
    for part in key {
        match at.get_mut(part).and_then(Value::as_table_mut) {
            Some(table) => at = table,
            None => return,
        }
    }
    at.remove(name);
}

impl Refusal {
    fn complaint(self, source: &Source) -> Complaint {
        let plain = self.message.lines().next().unwrap_or_default();
        let what = format!("`{}`: {}", self.key.join("."), in_words(plain));
        source.complaint(&self.key, what, remedy(plain))
    }
}

/// Serde names Rust's types; a reader of TOML knows others.
fn in_words(message: &str) -> String {
    [
        ("expected usize", "expected a whole number, 0 or more"),
        ("expected u64", "expected a whole number, 0 or more"),
        ("expected f64", "expected a number"),
        ("expected a sequence", "expected a list"),
        ("sequence", "a list"),
        ("invalid type: map", "invalid type: a table"),
    ]
    .iter()
    .fold(message.to_string(), |text, (rust, words)| text.replace(rust, words))
}

fn remedy(message: &str) -> &'static str {
    if message.starts_with("unknown field") {
        "remove the key, or use one of the names above; `acm-train --help` shows an experiment file"
    } else if message.starts_with("unknown variant") {
        "use one of the names above"
    } else {
        "write a value of the expected type, or leave the key out for its default"
    }
}

/// The first `nan` or `inf`, which TOML accepts and no experiment can mean.
fn not_finite(tree: &Table) -> Option<Vec<String>> {
    tree.iter().find_map(|(name, value)| {
        let below = match value {
            Value::Float(number) => (!number.is_finite()).then(Vec::new),
            Value::Table(table) => not_finite(table),
            Value::Array(items) => {
                let table: Table = items.iter().enumerate().map(|(i, item)| (i.to_string(), item.clone())).collect();
                not_finite(&table)
            }
            _ => None,
        }?;
        Some(std::iter::once(name.clone()).chain(below).collect())
    })
}
