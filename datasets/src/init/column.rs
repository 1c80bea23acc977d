//! One column of a group of files.

use super::look::Look;
use super::names;
use crate::ingest::recording::Held;

/// A column, as each file of a group has it.
#[derive(Debug, Clone)]
pub(super) struct Column<'a> {
    pub name: &'a str,
    pub looks: Vec<&'a Look>,
    /// How many files the group has.
    pub files: usize,
}

impl Column<'_> {
    /// Whether each file has it once, by a name that a manifest can have.
    pub fn is_sound(&self) -> bool {
        self.looks.len() == self.files && !self.name.is_empty() && !self.name.contains(char::is_control)
    }

    pub fn empty(&self) -> usize {
        self.looks.iter().map(|look| look.empty).sum()
    }

    /// Whether it has even steps and does not count rows.
    pub fn is_paced(&self) -> bool {
        self.looks.iter().all(|look| look.pace().is_some()) && !self.counts_rows()
    }

    fn counts_rows(&self) -> bool {
        self.looks.iter().all(|look| look.whole && look.rises(&[], false) && look.pace() == Some(1.0))
    }

    /// Why it cannot be a signal.
    pub fn flaw(&self) -> Option<String> {
        let low = self.looks.iter().map(|look| look.low).fold(f64::INFINITY, f64::min);
        let high = self.looks.iter().map(|look| look.high).fold(f64::NEG_INFINITY, f64::max);
        let is_index = names::words(self.name).last().is_some_and(|word| names::has("index frame id", word));
        Some(match &self.looks[0].kind {
            _ if self.name.is_empty() => "a column without a name: give it one in the header".into(),
            _ if self.name.contains(char::is_control) => "its name has control characters: rename it".into(),
            _ if self.looks.len() > self.files => "the header has it twice: rename one".into(),
            _ if self.looks.len() < self.files => format!("{} of {} files have it", self.looks.len(), self.files),
            Held::Unread(kind) => format!("a {kind}, which is not read"),
            Held::Time => "a second time".into(),
            Held::Text => "text".into(),
            Held::Number if low > high => "always empty".into(),
            Held::Number if low == high => format!("always {low}"),
            Held::Number if self.counts_rows() || (is_index && self.looks[0].whole) => "it counts".into(),
            Held::Number => return None,
        })
    }
}
