//! Validation trials of each fold of a cross-validation.
//!
//! What is left out is what held-out trials ask for: conditions that nothing was learned from. In this order:
//!
//! | where                                                                    | left out at a time          |
//! | ------------------------------------------------------------------------ | --------------------------- |
//! | the manifest has `[folds]`                                               | the trials that it lists    |
//! | a context signal is constant within trials and takes 3 to 8 values       | one value                   |
//! | there are three trials or more                                           | one trial; of more than five, a fifth |
//! | otherwise, if a fifth of a trial is long enough                          | a block of time, a fifth of each trial |
//!
//! A value counts as such where at least one is shared by several trials; see [`Constant`]. Of several such signals it is the one whose
//! values most held-out trials lie outside of, then the one with the fewest values, then the first of the manifest. Of
//! held-out trials nothing but that is looked at.

use std::fmt;

use crate::entry::Entry;
use crate::levels::{Constant, context};
use crate::manifest::{Manifest, Role};

/// Up to so many development trials, each is a fold of its own; beyond, there are so many folds. So many blocks of time.
pub const LEAVE_ONE_OUT: usize = 5;

/// Fewer folds are too few to tell how far errors differ from one to the next.
const FEWEST: usize = 3;

/// More values than these are no few.
const MOST_VALUES: usize = 8;

/// Samples of the windows that networks read unless an experiment says otherwise.
const USUAL_WINDOW: usize = 50;

/// Unit that is left out at a time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LeaveOut {
    /// Whatever the rule says.
    Rule,
    /// One trial, or a fifth of many.
    Trial,
    /// A block of time of each trial.
    Block,
    /// One value of this signal.
    Value(String),
}

/// Unit that is left out at a time.
#[derive(Debug, Clone, PartialEq)]
pub enum By {
    /// Trials that a file lists.
    List,
    /// One value of a signal that is constant within trials.
    Value(String),
    /// One trial, or a share of many.
    Trial,
    /// A block of time of each trial.
    Block,
}

/// The folds, and how they were made.
#[derive(Debug, Clone, PartialEq)]
pub struct Folds {
    /// Unit that is left out at a time.
    pub by: By,
    /// Validation trials of each fold; of blocks, their names ([`block`]).
    pub validation: Vec<Vec<String>>,
}

impl Folds {
    /// Those that a file lists.
    pub fn listed(validation: Vec<Vec<String>>) -> Self {
        Self { by: By::List, validation }
    }
}

impl fmt::Display for Folds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.validation.len();
        match &self.by {
            By::List => f.write_str("listed trials left out")?,
            By::Value(signal) => write!(f, "one {signal} left out at a time")?,
            By::Trial if self.validation.iter().all(|fold| fold.len() == 1) => {
                f.write_str("one trial left out at a time")?;
            }
            By::Trial => f.write_str("some trials left out at a time")?,
            By::Block => f.write_str("one block of time left out of each trial at a time")?,
        }
        write!(f, " ({count} fold{})", if count == 1 { "" } else { "s" })
    }
}

/// The folds of `learned`, trials in natural order; blocks of time need `room` samples without a gap. `None` where a value is
/// asked for and the signal is not constant within trials, or has one value.
pub fn folds(
    manifest: &Manifest,
    asked: &LeaveOut,
    learned: &[&Entry],
    held_out: &[&Entry],
    room: usize,
) -> Option<Folds> {
    match asked {
        LeaveOut::Value(name) => Constant::of(name, manifest, learned).map(|signal| by_value(&signal, learned)),
        LeaveOut::Trial => Some(by_trial(learned)),
        LeaveOut::Block => Some(by_block(learned)),
        LeaveOut::Rule if !manifest.folds.validation.is_empty() => {
            Some(Folds::listed(manifest.folds.validation.clone()))
        }
        LeaveOut::Rule => Some(by_rule(manifest, learned, held_out, room)),
    }
}

/// The folds of the development trials by the rule, with the usual windows.
pub(crate) fn usual(manifest: &Manifest, trials: &[Entry]) -> Folds {
    let of = |role: Role| trials.iter().filter(|trial| trial.role == role).collect::<Vec<_>>();
    let (learned, held_out) = (of(Role::Development), of(Role::HeldOut));
    let folds = folds(manifest, &LeaveOut::Rule, &learned, &held_out, USUAL_WINDOW);
    folds.unwrap_or_else(|| Folds::listed(vec![]))
}

fn by_rule(manifest: &Manifest, learned: &[&Entry], held_out: &[&Entry], room: usize) -> Folds {
    let few = |signal: &Constant| {
        (FEWEST..=MOST_VALUES).contains(&signal.values.len()) && signal.values.len() < learned.len()
    };
    let signals = context(manifest, learned).into_iter().filter_map(|name| Constant::of(&name, manifest, learned));
    let unknown = |signal: &Constant| held_out.iter().filter(|trial| !signal.knows(manifest, trial)).count();
    let first = signals.filter(few).min_by_key(|signal| (std::cmp::Reverse(unknown(signal)), signal.values.len()));
    let long = learned.iter().any(|trial| trial.longest / LEAVE_ONE_OUT > room);
    match first {
        Some(signal) => by_value(&signal, learned),
        None if learned.len() < FEWEST && long => by_block(learned),
        None => by_trial(learned),
    }
}

fn by_value(signal: &Constant, learned: &[&Entry]) -> Folds {
    let mut validation = vec![Vec::new(); signal.values.len()];
    for (trial, &value) in learned.iter().zip(&signal.of_trial) {
        validation[value].push(trial.name.clone());
    }
    Folds { by: By::Value(signal.name.clone()), validation }
}

/// Up to [`LEAVE_ONE_OUT`] trials validate one at a time; of more, trial `i` validates in fold `i mod 5`.
fn by_trial(learned: &[&Entry]) -> Folds {
    let mut validation = vec![Vec::new(); learned.len().min(LEAVE_ONE_OUT)];
    for (i, trial) in learned.iter().enumerate() {
        validation[i % LEAVE_ONE_OUT].push(trial.name.clone());
    }
    Folds { by: By::Trial, validation }
}

fn by_block(learned: &[&Entry]) -> Folds {
    let of = |number| learned.iter().map(|trial| block(&trial.name, number)).collect();
    Folds { by: By::Block, validation: (0..LEAVE_ONE_OUT).map(of).collect() }
}

/// The name of a block of time of a trial, which is a trial of its own: `d1:block2`.
pub fn block(trial: &str, number: usize) -> String {
    format!("{trial}:block{}", number + 1)
}

#[cfg(test)]
mod tests;
