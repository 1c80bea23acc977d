//! Progress of the loop: a spinner on a terminal, and everywhere a line for each step, accepted or rejected.
//!
//! All of it goes to stderr, so that stdout holds the summary alone.

use std::{
    cell::{OnceCell, RefCell},
    io::{IsTerminal, Write, stderr},
    time::Duration,
};

use acm_core::{
    display::{Display, percent, significant},
    rig::Rig,
};
use acm_trace::finding::Step;
use indicatif::ProgressBar;

/// Progress of one loop.
pub struct Steps {
    bar: Option<ProgressBar>,
    /// Unit of the errors; none where outputs differ in theirs.
    unit: Option<String>,
    /// Display of errors, chosen by the first error, so that all lines share it.
    display: OnceCell<Display>,
    /// The line before: a candidate that is rejected again, from another set, is shown once.
    before: RefCell<String>,
}

impl Steps {
    /// Returns a progress that shows errors as the result will, in one unit.
    pub fn new(rig: &Rig) -> Self {
        let first = rig.outputs.first().map_or("", |output| output.unit.as_str());
        let alike = rig.outputs.iter().all(|output| output.unit == first);
        let bar = stderr().is_terminal().then(|| {
            let bar = ProgressBar::new_spinner();
            bar.enable_steady_tick(Duration::from_millis(120));
            bar
        });
        Self { bar, unit: alike.then(|| first.to_string()), display: OnceCell::new(), before: RefCell::default() }
    }

    /// Shows the current step.
    pub fn begin(&self, what: &str) {
        match &self.bar {
            Some(bar) => bar.set_message(what.to_string()),
            None => note(what),
        }
    }

    /// Shows that a step was accepted, or its best candidate rejected.
    pub fn tried(&self, step: &Step) {
        let line = self.line(step);
        if self.before.replace(line.clone()) == line {
            return;
        }
        match &self.bar {
            Some(bar) => {
                bar.println(line);
                bar.set_message("looking for what else is missing");
            }
            None => note(&line),
        }
    }

    fn line(&self, step: &Step) -> String {
        let error = self.shown(step.error);
        let gain = step.gain.map_or(String::new(), |gain| format!(", gain {}", percent(gain)));
        let chance = step.by_chance.map_or(String::new(), |chance| format!(" (by chance {})", percent(chance)));
        let sure = step.significance.map_or(String::new(), |t| format!(", {t:.1} standard errors").replace('-', "−"));
        let rejected = if step.accepted { "" } else { ", rejected" };
        format!("{:<42} {error:>12}{gain}{chance}{sure}{rejected}", step.model)
    }

    fn shown(&self, error: f64) -> String {
        let of = |unit: &str| self.display.get_or_init(|| Display::of(unit, error)).show(error);
        self.unit.as_deref().map_or_else(|| format!("{} of each range", significant(error, 3)), of)
    }

    /// Ends the display of the search.
    pub fn end(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Prints a line. A closed stderr is no reason to stop.
fn note(line: &str) {
    drop(writeln!(stderr(), "{line}"));
}
