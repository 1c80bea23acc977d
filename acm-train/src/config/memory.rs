//! The `[memory]` table of an experiment: how far back a network remembers.
//!
//! | `state` | state of the network                                | training examples                | scored samples       |
//! | ------- | --------------------------------------------------- | -------------------------------- | -------------------- |
//! | trial   | zero at the first sample after a gap, then carried  | pieces of `length` samples       | all                  |
//! | window  | zero before each window (`[windows]`)               | windows                          | ends of windows      |
//!
//! ```toml
//! [memory]
//! state   = "trial"
//! length  = 320      # samples of a training piece
//! burn_in = 80       # first samples of a piece, which are not scored in training
//! ```
//!
//! A file that describes windows, and no memory, has `state = "window"`; any other has `state = "trial"` and the settings of
//! training in [`OF_TRIAL`].

use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::parse::fault::Fault;

/// Settings of training with a carried state, where a file does not name them.
pub const OF_TRIAL: &str = include_str!("memory/trial.toml");

/// Keys of `[windows]` that describe windows.
const OF_WINDOWS: [&str; 4] = ["length", "reach", "stride", "target"];

/// Longest piece, samples.
const MOST: usize = 1_000_000;

/// How far back a network remembers: the table above.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Memory {
    /// Rule for the state.
    pub state: State,
    /// Samples of a training piece. Left out: [`Memory::length`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<usize>,
    /// First samples of a piece that are not scored in training. Left out: a quarter of the piece.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub burn_in: Option<usize>,
}

/// Rule for the state of a network.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// Carried from the first sample of a trial, or from the first after a gap.
    Trial,
    /// Zero before each window.
    #[default]
    Window,
}

impl Memory {
    /// Returns whether the state is carried through trials.
    pub fn is_trial(&self) -> bool {
        self.state == State::Trial
    }

    /// Returns whether all values are the default's; files then have no `[memory]`.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the number of samples of a training piece.
    pub fn length(&self) -> usize {
        self.length.unwrap_or(320)
    }

    /// Returns the number of samples at the start of a piece that are not scored.
    pub fn burn_in(&self) -> usize {
        self.burn_in.unwrap_or(self.length() / 4)
    }

    /// Returns what is out of bounds.
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults: Vec<Fault> = Fault::count("memory.length", self.length(), 1, MOST, "320").into_iter().collect();
        if self.burn_in() >= self.length() {
            let what = format!("is {}, and a piece has {} samples (memory.length)", self.burn_in(), self.length());
            faults.push(Fault::new(
                "memory.burn_in",
                what,
                "write a smaller number, for example a quarter of the length",
            ));
        }
        faults
    }
}

/// Names the memory that a file does not name, and the settings of training that go with a carried state.
pub fn name_the_default_memory(tree: &mut Table) {
    let windows = tree.get("windows").and_then(Value::as_table);
    let describes_windows = windows.is_some_and(|windows| OF_WINDOWS.iter().any(|key| windows.contains_key(*key)));
    let memory = tree.entry("memory").or_insert_with(|| Value::Table(Table::new()));
    let Value::Table(memory) = memory else { return };
    let default = if describes_windows && memory.is_empty() { "window" } else { "trial" };
    let state = memory.entry("state").or_insert_with(|| default.into());
    if state.as_str() == Some("trial") {
        complete(tree, &toml::from_str(OF_TRIAL).unwrap_or_default());
    }
}

/// Adds the tables that a file lacks, and the keys that its tables lack.
fn complete(file: &mut Table, defaults: &Table) {
    for (name, defaults) in defaults {
        let table = file.entry(name).or_insert_with(|| Value::Table(Table::new()));
        if let (Value::Table(table), Value::Table(defaults)) = (table, defaults) {
            for (key, default) in defaults {
                table.entry(key).or_insert_with(|| default.clone());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn completed(text: &str) -> Table {
        let mut tree: Table = toml::from_str(text).expect("TOML");
        name_the_default_memory(&mut tree);
        tree
    }

    #[test]
    fn a_file_that_describes_windows_has_no_other_memory() {
        let state = |text: &str| completed(text)["memory"]["state"].as_str().map(str::to_string);
        assert_eq!(state("[windows]\nlength = 25").as_deref(), Some("window"));
        assert_eq!(state("[windows]\nmax_gap = 2.0").as_deref(), Some("trial"));
        assert_eq!(state("[windows]\nlength = 25\n[memory]\nlength = 100").as_deref(), Some("trial"));
        assert_eq!(state("").as_deref(), Some("trial"));
    }

    #[test]
    fn settings_of_a_file_stay() {
        let tree = completed("[training]\nlearning_rate = 0.5\nschedule = { kind = \"constant\" }");
        assert_eq!(tree["training"]["learning_rate"].as_float(), Some(0.5));
        assert_eq!(tree["training"]["schedule"].as_table().map(Table::len), Some(1));
        assert!(tree["training"].get("epoch_steps").is_some());
        assert!(completed("[windows]\nlength = 25").get("training").is_none());
    }
}
