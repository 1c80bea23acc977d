//! Decoding of a tree of values to plain structs, or an error that underlines the key.

use acm_datasets::text::spelling::meant;
use acm_datasets::toml_file::words::{in_words, remedy};
use serde::de::DeserializeOwned;
use serde_path_to_error::Segment;
use toml::{Table, Value};

use super::complaint::Complaint;
use super::source::Source;
use crate::config::error::ConfigError;

/// Decodes a file with its edits applied; `example` is the command that shows such a file.
///
/// # Errors
/// A number that is not finite, a key that is unknown, a value of a wrong type: with its place and a remedy.
pub fn decode<T: DeserializeOwned>(source: &Source, example: &str) -> Result<T, ConfigError> {
    if let Some(key) = not_finite(&source.tree) {
        let what = format!("`{}` is not a finite number", key.join("."));
        return Err(Box::new(source.complaint(&key, what, "write a finite number, or leave the key out")).into());
    }
    let refused = |refusal: Refusal| {
        let key = culprit::<T>(&source.tree, &refusal);
        let refusal = misspelt(&source.tree, Refusal { key, ..refusal });
        Box::new(refusal.complaint(source, example)).into()
    };
    attempt::<T>(&source.tree).or_else(|refusal| as_texts(source, refusal)).map_err(refused)
}

/// Values of the command line that are something else in TOML, where a text is expected: `data=2026-11-03`.
fn as_texts<T: DeserializeOwned>(source: &Source, first: Refusal) -> Result<T, Refusal> {
    let mut tree = source.tree.clone();
    let mut refusal = first;
    while refusal.message.contains("expected a string") || refusal.message.contains("expected path string") {
        let (Some((last, above)), Some(raw)) = (refusal.key.split_last(), source.as_written(&refusal.key)) else {
            break;
        };
        let Some(table) = table_at(&mut tree, above) else { break };
        table.insert(last.clone(), Value::from(raw));
        match attempt::<T>(&tree) {
            Err(next) if next.key != refusal.key => refusal = next,
            other => return other,
        }
    }
    Err(refusal)
}

struct Refusal {
    key: Vec<String>,
    message: String,
}

fn attempt<T: DeserializeOwned>(tree: &Table) -> Result<T, Refusal> {
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

/// Finds the key of a refused value. Serde reads a table that is chosen by a tag (`kind = "cfc"`) into a buffer, and so
/// forgets at which key it was. The key is the one whose removal changes the message; the tag is tried last. A value of
/// a wrong type in a list is searched for there.
fn culprit<T: DeserializeOwned>(tree: &Table, refusal: &Refusal) -> Vec<String> {
    let mut key = refusal.key.clone();
    while let Some(Value::Table(table)) = look_up(tree, &key) {
        let mut names: Vec<&String> = table.keys().collect();
        names.sort_by_key(|name| ["kind", "basis"].contains(&name.as_str()));
        let guilty = names.into_iter().find(|name| {
            let mut without = tree.clone();
            remove(&mut without, &key, name);
            !attempt::<T>(&without).is_err_and(|other| other.message == refusal.message)
        });
        match guilty {
            Some(name) => key.push(name.clone()),
            None => break,
        }
    }
    key
}

/// Converts the refusal of a missing key whose table has one of similar name to that of an unknown key.
fn misspelt(tree: &Table, refusal: Refusal) -> Refusal {
    let missing = refusal.message.strip_prefix("missing field `").and_then(|rest| rest.split('`').next());
    let table = if refusal.key.is_empty() { Some(tree) } else { look_up(tree, &refusal.key).and_then(Value::as_table) };
    let (Some(missing), Some(table)) = (missing, table) else { return refusal };
    let Some(written) = meant(missing, table.keys().map(String::as_str)) else { return refusal };
    let message = format!("unknown field `{written}`, expected `{missing}`");
    Refusal { key: [refusal.key.as_slice(), &[written.to_string()]].concat(), message }
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
    if let Some(table) = table_at(tree, key) {
        table.remove(name);
    }
}

fn table_at<'a>(tree: &'a mut Table, key: &[String]) -> Option<&'a mut Table> {
    key.iter().try_fold(tree, |at, part| at.get_mut(part)?.as_table_mut())
}

impl Refusal {
    fn complaint(self, source: &Source, example: &str) -> Complaint {
        let key = if self.key.is_empty() { String::new() } else { format!("`{}`: ", self.key.join(".")) };
        let what = key + &in_words(&self.message);
        source.complaint(&self.key, what, remedy(&self.message, &format!("`{example}`")))
    }
}

/// Returns the first `nan` or `inf`, which TOML accepts and no setting may be.
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
