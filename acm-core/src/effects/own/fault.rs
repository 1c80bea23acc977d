//! What is wrong with an effect of one's own, where, and what to do.

use thiserror::Error;

use super::expression::Misplaced;

/// A definition that is refused.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}; {help}", self.fault())]
pub struct OwnError {
    /// As it was given; empty where there is none.
    pub file: String,
    /// Name of the effect; empty where the file as a whole is wrong.
    pub effect: String,
    /// Key within the effect.
    pub key: String,
    /// What is wrong.
    pub what: String,
    /// What to do.
    pub help: String,
}

impl OwnError {
    /// Of a key.
    pub fn new(key: impl Into<String>, what: impl Into<String>, help: impl Into<String>) -> Self {
        let (file, effect) = (String::new(), String::new());
        Self { file, effect, key: key.into(), what: what.into(), help: help.into() }
    }

    /// Of a part of an expression.
    pub fn within(key: impl Into<String>, text: &str, fault: Misplaced) -> Self {
        let [from, to] = fault.span;
        let part = text.get(from..to).unwrap_or_default();
        let column = text.get(..from).map_or(0, |before| before.chars().count()) + 1;
        let place = if part.is_empty() || part == text { String::new() } else { format!(" in `{part}`") };
        Self::new(key, format!("= {text:?}: at character {column}{place}, {}", fault.what), fault.help)
    }

    /// The same with file and effect.
    #[must_use]
    pub fn of(self, file: &str, effect: &str) -> Self {
        Self { file: file.into(), effect: effect.into(), ..self }
    }

    /// Place and fault without the remedy.
    pub fn fault(&self) -> String {
        let file = if self.file.is_empty() { String::new() } else { format!("{}: ", self.file) };
        let effect = if self.effect.is_empty() { String::new() } else { format!("effect {:?}: ", self.effect) };
        let key = if self.key.is_empty() { String::new() } else { format!("`{}` ", self.key) };
        format!("{file}{effect}{key}{}", self.what)
    }
}
