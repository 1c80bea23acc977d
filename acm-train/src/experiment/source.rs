//! Where an experiment's values were written: the file, and each `--set` of the command line.
//!
//! Decoding works on the merged tree; a fault is then traced back to the text that its key came from.

use std::{
    fs,
    io::Read,
    path::{Path, PathBuf},
};

use miette::NamedSource;
use toml::{
    Table, Value,
    de::{DeTable, DeValue},
};

use super::{Complaint, Fault};
use crate::error::TrainError;

/// A file beyond this is not an experiment. A refusal prints the offending line, so this also bounds messages.
const LARGEST_FILE: u64 = 64 * 1024;

/// The texts of an experiment, and the tree of values that they amount to.
#[derive(Debug)]
pub struct Source {
    path: PathBuf,
    file: Text,
    edits: Vec<Edit>,
    /// Values of the file with all edits applied.
    pub tree: Table,
}

#[derive(Debug)]
struct Text {
    name: String,
    text: String,
    /// Whether a place in it is told by line and column.
    line: bool,
}

#[derive(Debug)]
struct Edit {
    text: Text,
    key: Vec<String>,
}

impl Source {
    /// Reads `file` and applies `edits` in order, each `key=value` with a dotted key and a TOML value.
    ///
    /// # Errors
    /// The file cannot be read, is too large or not TOML; an edit is not `key=value`.
    pub fn read(file: &Path, edits: &[String]) -> Result<Self, TrainError> {
        let text = Text { name: file.display().to_string(), text: read_capped(file)?, line: true };
        Self::edited(file, text, edits)
    }

    /// No file: the defaults with `edits` applied.
    ///
    /// # Errors
    /// An edit is not `key=value`.
    pub fn without_file(edits: &[String]) -> Result<Self, TrainError> {
        Self::edited(Path::new(""), Text { name: "the defaults".into(), text: String::new(), line: true }, edits)
    }

    fn edited(path: &Path, text: Text, edits: &[String]) -> Result<Self, TrainError> {
        let tree = text.parse()?;
        let mut source = Self { path: path.into(), file: text, edits: vec![], tree };
        edits.iter().try_for_each(|edit| source.edit("--set ", edit))?;
        Ok(source)
    }

    /// Applies `key=value`; a fault in it is shown as one of `origin`, such as `--set `.
    ///
    /// # Errors
    /// It is not `key=value`, or the key goes through a value.
    pub fn edit(&mut self, origin: &str, edit: &str) -> Result<(), TrainError> {
        let text = Text { name: format!("{origin}{edit}"), text: quoted(edit), line: false };
        let (key, value) = text.text.split_once('=').ok_or_else(|| {
            text.refuse(
                0..edit.len(),
                format!("`{edit}` has no `=`"),
                "write --set key=value, for example --set training.epochs=3".into(),
            )
        })?;
        let tree = text.parse().map_err(|_| {
            text.refuse(
                key.len() + 1..text.text.len(),
                format!("`{value}` is not a TOML value"),
                "write 3, 0.5, true, [1, 2], a word, or a text in quotes: --set 'question=\"Why?\"'".into(),
            )
        })?;
        let (key, value) = descend(tree, key_parts(key));
        place(&mut self.tree, &key, value).map_err(|blocked| {
            text.refuse(
                0..edit.len(),
                format!("`{blocked}` is a value, not a table, so it has no key below it"),
                "give the key as the experiment file would: table.key".into(),
            )
        })?;
        self.edits.push(Edit { text, key });
        Ok(())
    }

    /// A fault at `key`, traced to the text that the key came from.
    pub fn complaint(&self, key: &[String], what: impl Into<String>, help: impl Into<String>) -> Complaint {
        match self.edits.iter().rev().find(|edit| key.starts_with(&edit.key)) {
            Some(edit) => edit.text.complain(key, what.into(), help.into()),
            None => self.file.complain(key, what.into(), help.into()),
        }
    }
}

impl Source {
    /// The file; empty where there is none, so that paths are sought from the current directory and above it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Name of the file, without its folder.
    pub fn file_name(&self) -> String {
        self.path.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned())
    }

    /// Refuses the first of `faults`, if there is any.
    ///
    /// # Errors
    /// That fault, traced to the text that its key came from.
    pub fn refuse_first(&self, faults: impl IntoIterator<Item = Fault>) -> Result<(), TrainError> {
        match faults.into_iter().next() {
            Some(fault) => Err(Box::new(self.complaint(&fault.key(), fault.what, fault.help)).into()),
            None => Ok(()),
        }
    }
}

impl Text {
    fn parse(&self) -> Result<Table, TrainError> {
        self.text.parse::<Table>().map_err(|error| {
            let span = error.span().unwrap_or(0..0);
            self.refuse(span, error.message().into(), "mend the TOML; text values need quotes".into())
        })
    }

    fn complain(&self, key: &[String], what: String, help: String) -> Complaint {
        let span = DeTable::parse(&self.text).ok().and_then(|tree| span_of(tree.get_ref(), key));
        self.at(span, what, help)
    }

    fn refuse(&self, span: std::ops::Range<usize>, what: String, help: String) -> TrainError {
        Box::new(self.at(Some(span), what, help)).into()
    }

    fn at(&self, span: Option<std::ops::Range<usize>>, what: String, help: String) -> Complaint {
        let place = match &span {
            Some(span) if self.line => {
                let before = &self.text[..span.start.min(self.text.len())];
                let line = before.matches('\n').count() + 1;
                let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
                format!("{}:{line}:{column}", self.name)
            }
            _ => self.name.clone(),
        };
        Complaint {
            place,
            what,
            help,
            text: NamedSource::new(&self.name, self.text.clone()),
            span: span.map(Into::into),
        }
    }
}

fn read_capped(file: &Path) -> Result<String, TrainError> {
    let mut bytes = Vec::new();
    fs::File::open(file).and_then(|opened| opened.take(LARGEST_FILE + 1).read_to_end(&mut bytes)).map_err(
        |source| TrainError::Usage {
            what: format!("cannot read the experiment file {}: {source}", file.display()),
            help: "give the path of a TOML file: --config experiments/cfc.toml".into(),
        },
    )?;
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(TrainError::Usage {
            what: format!("{} is larger than {LARGEST_FILE} bytes, so it is no experiment file", file.display()),
            help: "give the path of a TOML file: --config experiments/cfc.toml".into(),
        });
    }
    String::from_utf8(bytes).map_err(|error| TrainError::Usage {
        what: format!("{} is not UTF-8 text: byte {} is not", file.display(), error.utf8_error().valid_up_to() + 1),
        help: "save the file as UTF-8".into(),
    })
}

/// A value that is one plain word and no TOML is a text, since a shell takes its quotes away: `network.kind=gru`.
fn quoted(edit: &str) -> String {
    let word = |value: &str| {
        value.starts_with(|c: char| c.is_ascii_alphabetic())
            && value.chars().all(|c| c.is_ascii_alphanumeric() || "_-./".contains(c))
    };
    match edit.split_once('=') {
        Some((key, value)) if word(value) && edit.parse::<Table>().is_err() => format!("{key}=\"{value}\""),
        _ => edit.to_string(),
    }
}

/// Parts of a dotted key as TOML reads it, quotes and all.
fn key_parts(key: &str) -> usize {
    let depth = |table: &Table| {
        let mut depth = 0;
        let mut at = Some(table);
        while let Some(table) = at {
            depth += 1;
            at = table.values().next().and_then(Value::as_table);
        }
        depth
    };
    format!("{key} = 0").parse::<Table>().map_or(1, |table| depth(&table))
}

/// Follows `depth` single keys down a tree that `a.b.c = value` made.
fn descend(tree: Table, depth: usize) -> (Vec<String>, Value) {
    let mut key = vec![];
    let mut value = Value::Table(tree);
    while key.len() < depth {
        let Value::Table(table) = value else { break };
        let Some((name, inner)) = table.into_iter().next() else { return (key, Value::Table(Table::new())) };
        key.push(name);
        value = inner;
    }
    (key, value)
}

/// Puts `value` at `key`, making tables on the way; the error is the part of the key that is no table.
fn place(tree: &mut Table, key: &[String], value: Value) -> Result<(), String> {
    let Some((last, tables)) = key.split_last() else { return Ok(()) };
    let mut at = tree;
    for name in tables {
        at = at
            .entry(name.clone())
            .or_insert_with(|| Value::Table(Table::new()))
            .as_table_mut()
            .ok_or_else(|| name.clone())?;
    }
    at.insert(last.clone(), value);
    Ok(())
}

/// Where `key`, or the deepest part of it that is written down, stands in the text.
fn span_of(tree: &DeTable<'_>, key: &[String]) -> Option<std::ops::Range<usize>> {
    let (name, rest) = key.split_first()?;
    let (found, value) = tree.iter().find(|(candidate, _)| candidate.get_ref() == name)?;
    let deeper = match (value.get_ref(), rest) {
        (DeValue::Table(inner), _) => span_of(inner, rest),
        (DeValue::Array(items), [index, below @ ..]) => {
            let item = index.parse().ok().and_then(|i: usize| items.get(i));
            let inside = item.and_then(|item| item.get_ref().as_table()).and_then(|table| span_of(table, below));
            inside.or(item.map(|item| item.span()))
        }
        _ => None,
    };
    deeper.or_else(|| Some(found.span()))
}
