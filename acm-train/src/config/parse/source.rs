//! Origin of an experiment's values: the file, each `--set` of the command line, each edit of a study.
//!
//! Decoding works on the merged tree; a fault is then traced back to the text that its key came from.

use std::{
    io::Read,
    path::{Path, PathBuf},
    sync::Arc,
};

use acm_datasets::files::regular;
use acm_datasets::toml_file::{overflow, words::empty};
use toml::{Table, Value};

use super::complaint::Complaint;
use super::fault::Fault;
use super::text::Text;
use crate::config::error::ConfigError;

/// A file beyond this is not an experiment.
const LARGEST_FILE: u64 = 64 * 1024;

/// Files that show what such a file can say.
const EXAMPLES: &str = "experiments/cfc.toml (acm-train) or experiments/close-the-loop.toml (acm-eval)";

/// Keys that have options of their own on the command line.
const OPTIONS: [&str; 2] = ["out", "config"];

/// The texts of an experiment, and the tree of values that they amount to.
#[derive(Debug, Clone)]
pub struct Source {
    path: PathBuf,
    file: Arc<Text>,
    edits: Vec<Edit>,
    /// Study that uses an experiment of this file, if any.
    asked_by: String,
    /// Values of the file with all edits applied.
    pub tree: Table,
}

#[derive(Debug, Clone)]
struct Edit {
    /// Text that contains the edit, and the key there of the value that it sets.
    text: Arc<Text>,
    at: Vec<String>,
    /// Key that it sets.
    key: Vec<String>,
    /// The value as the command line has it.
    raw: Option<String>,
}

/// A table of edits in a study's file.
#[derive(Debug, Clone)]
pub struct Edits<'a> {
    /// Source of the study.
    pub study: &'a Source,
    /// Key of the table there.
    pub table: Vec<String>,
    /// Whether each edit is one key there, as in a sweep (`"windows.length" = …`), and not a path of tables.
    pub whole: bool,
}

impl Source {
    /// Reads `file` and applies `edits` in order, each `key=value` with a dotted key and a TOML value.
    ///
    /// # Errors
    /// The file cannot be read, is too large or not TOML; an edit is not `key=value`.
    pub fn read(file: &Path, edits: &[String]) -> Result<Self, ConfigError> {
        let text = read_capped(file)?;
        match empty(&text.text, EXAMPLES) {
            Some((what, help)) => Err(text.refuse(0..0, what.into(), help)),
            None => Self::edited(file, text, edits),
        }
    }

    /// Returns the defaults with `edits` applied, without a file.
    ///
    /// # Errors
    /// An edit is not `key=value`.
    pub fn without_file(edits: &[String]) -> Result<Self, ConfigError> {
        Self::edited(Path::new(""), Text { name: "the defaults".into(), text: String::new(), line: false }, edits)
    }

    /// Returns the source of values that are decoded already: only the place of their file is still needed.
    pub fn resolved(file: &Path) -> Self {
        let text = Text { name: file.display().to_string(), text: String::new(), line: false };
        let (file, edits, asked_by) = (file.into(), vec![], String::new());
        Self { path: file, file: Arc::new(text), edits, asked_by, tree: Table::new() }
    }

    fn edited(path: &Path, text: Text, edits: &[String]) -> Result<Self, ConfigError> {
        let tree = text.parse()?;
        let mut source = Self { path: path.into(), file: Arc::new(text), edits: vec![], asked_by: String::new(), tree };
        edits.iter().try_for_each(|edit| source.edit("--set ", edit))?;
        Ok(source)
    }

    /// Applies `key=value`; a fault in it is shown as one of `origin`, such as `--set `.
    ///
    /// What is no TOML value is a text, since a shell takes quotes away: `network.kind=gru`, `data=../my robot`.
    ///
    /// # Errors
    /// It is not `key=value`, a bracket or quote lacks its counterpart, or the key goes through a value.
    pub fn edit(&mut self, origin: &str, edit: &str) -> Result<(), ConfigError> {
        let text = Text { name: format!("{origin}{edit}"), text: as_toml(edit), line: false };
        let all = 0..text.text.len();
        let refuse = |what: String, help: &str| Err(text.refuse(all.clone(), what, help.into()));
        let Some((key, raw)) = edit.split_once('=').map(|(key, raw)| (key.trim(), raw.trim())) else {
            let help = "write --set key=value, for example --set training.epochs=3";
            return refuse(format!("`{edit}` has no `=`"), help);
        };
        if OPTIONS.contains(&key) {
            let help = format!("write --{key} {raw}");
            return refuse(format!("`{key}` is an option of the command line, and no key of a file"), &help);
        }
        if format!("{key}=0").parse::<Table>().is_err() {
            let help = "write table.key as a file has it: --set training.epochs=3";
            return refuse(format!("`{key}` is no dotted key"), help);
        }
        if let Some((span, what, help)) = overflow::find(edit) {
            return Err(text.refuse(span, what, help.into()));
        }
        let Ok(tree) = text.parse() else {
            let help = "write 3, 0.5, true, [1, 2], or a text: --set 'question=Why?'";
            return refuse(format!("`{raw}` is not a TOML value"), help);
        };
        let (key, value) = descend(tree, key_parts(key));
        if let Err(blocked) = place(&mut self.tree, &key, value) {
            let help = "give the key as the experiment file would: table.key";
            return refuse(format!("`{blocked}` is a value, not a table, so it has no key below it"), help);
        }
        let (text, at, raw) = (Arc::new(text), key.clone(), Some(raw.into()));
        self.edits.push(Edit { text, at, key, raw });
        Ok(())
    }

    /// Sets the dotted `key` to a value that stands among the edits of a study.
    ///
    /// # Errors
    /// It is no key, or goes through a value; with its place in the study.
    pub fn edit_from(&mut self, edits: &Edits, key: &str, value: &Value) -> Result<(), ConfigError> {
        let parts = format!("{key} = 0").parse::<Table>().map(|tree| descend(tree, key_parts(key)).0);
        let below = if edits.whole { vec![key.to_string()] } else { parts.clone().unwrap_or_default() };
        let (text, at) = edits.study.written(&[edits.table.clone(), below].concat());
        let refuse = |what: String| {
            let help = "write table.key as an experiment file has it; names with other characters need quotes";
            ConfigError::from(Box::new(text.complain(&at, what, help.into())))
        };
        let parts = parts.map_err(|_| refuse(format!("`{key}` is no dotted key")))?;
        place(&mut self.tree, &parts, value.clone()).map_err(|blocked| {
            refuse(format!("`{key}`: `{blocked}` is a value, not a table, so it has no key below it"))
        })?;
        self.edits.push(Edit { text, at, key: parts, raw: None });
        Ok(())
    }

    /// Records the study that uses this experiment, for messages about its own file.
    pub fn asked_by(&mut self, who: String) {
        self.asked_by = who;
    }

    /// Returns a fault at `key`, traced to the text that the key came from.
    pub fn complaint(&self, key: &[String], what: impl Into<String>, help: impl Into<String>) -> Complaint {
        let (text, at) = self.written(key);
        let asked_by = if Arc::ptr_eq(&text, &self.file) { self.asked_by.as_str() } else { "" };
        text.complain(&at, what.into() + asked_by, help.into())
    }

    /// Returns the text that the command line gave for `key`, where nothing was set there or below it afterwards: a
    /// folder named 2026-11-03 is a date in TOML.
    pub(super) fn as_written(&self, key: &[String]) -> Option<&str> {
        let last = self.edits.iter().rev().find(|edit| edit.key.starts_with(key) || key.starts_with(&edit.key))?;
        last.raw.as_deref().filter(|_| last.key == key)
    }

    /// Returns the text that `key` comes from, and the key there.
    fn written(&self, key: &[String]) -> (Arc<Text>, Vec<String>) {
        let edits = || self.edits.iter().rev();
        if let Some(edit) = edits().find(|edit| key.starts_with(&edit.key)) {
            return (edit.text.clone(), [&edit.at, &key[edit.key.len()..]].concat());
        }
        // a table that an edit alone made is that edit's
        match edits().find(|edit| edit.key.starts_with(key) && !key.is_empty() && !self.file.has(key)) {
            Some(edit) => (edit.text.clone(), edit.at.clone()),
            None => (self.file.clone(), key.to_vec()),
        }
    }

    /// Returns the file; empty where there is none, so that paths are sought from the current directory and above it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the name of the file, without its folder.
    pub fn file_name(&self) -> String {
        self.path.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned())
    }

    /// Refuses the first of `faults`, if there is any.
    ///
    /// # Errors
    /// That fault, traced to the text that its key came from.
    pub fn refuse_first(&self, faults: impl IntoIterator<Item = Fault>) -> Result<(), ConfigError> {
        match faults.into_iter().next() {
            Some(fault) => Err(Box::new(self.complaint(&fault.key, fault.what, fault.help)).into()),
            None => Ok(()),
        }
    }
}

fn read_capped(file: &Path) -> Result<Text, ConfigError> {
    let mut bytes = Vec::new();
    regular::open(file).and_then(|opened| opened.take(LARGEST_FILE + 1).read_to_end(&mut bytes)).map_err(|source| {
        ConfigError::Unreadable {
            what: format!("cannot read the experiment file {}: {source}", file.display()),
            help: "give the path of a TOML file: --config experiments/cfc.toml".into(),
        }
    })?;
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(ConfigError::Unreadable {
            what: format!("{} is larger than {LARGEST_FILE} bytes, so it is no experiment file", file.display()),
            help: "give the path of a TOML file: --config experiments/cfc.toml".into(),
        });
    }
    let text = |text: String| Text { name: file.display().to_string(), text, line: true };
    String::from_utf8(bytes).map(text).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let what = format!("the text is not UTF-8: byte {} is not", valid + 1);
        text(String::from_utf8_lossy(error.as_bytes()).into_owned()).refuse(
            valid..valid,
            what,
            "save the file as UTF-8".into(),
        )
    })
}

/// Returns an edit whose value is quoted as a text where it is no TOML, and is not meant to be.
fn as_toml(edit: &str) -> String {
    let Some((key, value)) = edit.split_once('=').map(|(key, value)| (key, value.trim())) else { return edit.into() };
    let tried = value.is_empty() || value.starts_with(['[', '{', '"', '\'']);
    match tried || edit.parse::<Table>().is_ok() {
        true => edit.into(),
        false => format!("{key}={}", Value::from(value)),
    }
}

/// Returns the number of parts of a dotted key as TOML reads it, quotes and all.
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

/// Sets `value` at `key`, making tables on the way; the error is the part of the key that is no table.
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
