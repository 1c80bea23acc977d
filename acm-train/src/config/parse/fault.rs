//! One invalid value, by its key.

/// A key, its value, why that cannot be, and what to do.
#[derive(Debug)]
pub struct Fault {
    /// Parts of the dotted key.
    pub key: Vec<String>,
    /// The value, and why it cannot be.
    pub what: String,
    /// Advice to the user.
    pub help: String,
}

impl Fault {
    /// Creates a fault; `what` continues the dotted key: `is 0`.
    pub fn new(key: &str, what: impl Into<String>, help: impl Into<String>) -> Self {
        Self::at(key.split('.').map(String::from).collect(), what, help)
    }

    /// Creates a fault as [`Fault::new`] does, for a key whose parts contain dots.
    pub fn at(key: Vec<String>, what: impl Into<String>, help: impl Into<String>) -> Self {
        Self { what: format!("`{}` {}", key.join("."), what.into()), key, help: help.into() }
    }

    /// Returns the fault of a count outside `least ..= most`.
    pub fn count(key: &str, value: usize, least: usize, most: usize, example: &str) -> Option<Self> {
        let help = || format!("write a whole number from {least} to {most}, for example {example}");
        (!(least..=most).contains(&value)).then(|| Self::new(key, format!("is {value}"), help()))
    }
}

/// A value of `[training]` that cannot be.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingFault {
    /// The key within `[training]`, dotted.
    pub field: &'static str,
    /// Value of the field.
    pub value: String,
    /// Advice to the user.
    pub remedy: &'static str,
}
