//! The text of one file or one `--set`: parsed, and searched for the place of a key.

use std::ops::Range;

use acm_datasets::toml_file::overflow;
use acm_datasets::toml_file::words::{in_words, key_near, short, syntax_remedy};
use miette::NamedSource;
use toml::{
    Table, Value,
    de::{DeTable, DeValue},
};

use super::complaint::Complaint;
use crate::config::error::ConfigError;

/// Longest line that is shown, so that it fits a terminal and the message stays short.
const LONGEST_LINE: usize = 240;

/// A text with its name.
#[derive(Debug)]
pub(super) struct Text {
    /// Name in messages.
    pub name: String,
    /// Whole text.
    pub text: String,
    /// Whether a place in it is reported by line and column.
    pub line: bool,
}

impl Text {
    /// Parses the text to a tree of values.
    pub fn parse(&self) -> Result<Table, ConfigError> {
        if let Some((span, what, help)) = overflow::find(&self.text) {
            return Err(self.refuse(span, what, help.into()));
        }
        self.text.parse::<Table>().map_err(|error| {
            let span = error.span().unwrap_or(0..0);
            let near = key_near(&self.text, span.start).map_or(String::new(), |key| format!(" (at `{key}`)"));
            self.refuse(span, format!("{}{near}", in_words(error.message())), syntax_remedy(error.message()).into())
        })
    }

    /// Returns a fault at a key. Where the text does not have the key, its place is that of the table that would hold
    /// it.
    pub fn complain(&self, key: &[String], what: String, help: String) -> Complaint {
        let span = DeTable::parse(&self.text).ok().and_then(|tree| span_of(tree.get_ref(), key));
        self.at(span, what, help)
    }

    /// Returns whether the text has a key.
    pub fn has(&self, key: &[String]) -> bool {
        let mut at = self.text.parse::<Table>().ok().map(Value::Table);
        for name in key {
            at = at.and_then(|value| match value {
                Value::Table(mut table) => table.remove(name),
                _ => None,
            });
        }
        at.is_some()
    }

    /// Returns a fault at a range of bytes.
    pub fn refuse(&self, span: Range<usize>, what: String, help: String) -> ConfigError {
        Box::new(self.at(Some(span), what, help)).into()
    }

    fn at(&self, span: Option<Range<usize>>, what: String, help: String) -> Complaint {
        let start = span.as_ref().map_or(0, |span| span.start.min(self.text.len()));
        let before = self.text.get(..start).unwrap_or(&self.text);
        let (line, column) =
            (before.matches('\n').count() + 1, before.rsplit('\n').next().unwrap_or("").chars().count() + 1);
        let place = if self.line { format!("{}:{line}:{column}", self.name) } else { self.name.clone() };
        let shown = if self.can_be_shown(line) { self.text.clone() } else { String::new() };
        let span = span.filter(|_| !shown.is_empty());
        Complaint {
            place: short(&place),
            what: short(&what),
            help: short(&help),
            text: NamedSource::new(&self.name, shown),
            span: span.map(Into::into),
        }
    }

    /// Returns whether a line and its neighbours are short enough to be shown.
    fn can_be_shown(&self, line: usize) -> bool {
        self.text.lines().skip(line.saturating_sub(2)).take(3).all(|line| line.len() <= LONGEST_LINE)
    }
}

/// Returns the range in the text of `key`, or of its deepest part that is written down.
fn span_of(tree: &DeTable<'_>, key: &[String]) -> Option<Range<usize>> {
    let (name, rest) = key.split_first()?;
    let (found, value) = tree.iter().find(|(candidate, _)| candidate.get_ref() == name)?;
    inside(value.get_ref(), rest).or_else(|| Some(found.span()))
}

fn inside(value: &DeValue<'_>, key: &[String]) -> Option<Range<usize>> {
    match (value, key) {
        (DeValue::Table(inner), _) => span_of(inner, key),
        (DeValue::Array(items), [index, below @ ..]) => {
            let item = index.parse().ok().and_then(|i: usize| items.get(i))?;
            inside(item.get_ref(), below).or(Some(item.span()))
        }
        _ => None,
    }
}
