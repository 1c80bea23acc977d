//! What a person sees while the loop goes on: a spinner on a terminal, a line for each accepted step everywhere.
//!
//! All of it goes to stderr, so that stdout holds the summary alone.

use std::{
    io::{IsTerminal, Write, stderr},
    time::Duration,
};

use acm_core::rig::Rig;
use acm_trace::finding::Step;
use indicatif::ProgressBar;

/// Progress of one loop.
pub struct Steps {
    bar: Option<ProgressBar>,
    scale: f64,
    /// After a number: with a blank before it.
    unit: String,
}

impl Steps {
    /// Shows errors as the result will: in millimetres where all outputs are lengths.
    pub fn new(rig: &Rig) -> Self {
        let first = rig.outputs.first().map_or("", |output| output.unit.as_str());
        let alike = rig.outputs.iter().all(|output| output.unit == first);
        let (scale, unit) = match (alike, first) {
            (true, "m") => (1e3, " mm".to_string()),
            (true, "1") => (1.0, String::new()),
            (true, unit) => (1.0, format!(" {unit}")),
            (false, _) => (1.0, " of each range".to_string()),
        };
        let bar = stderr().is_terminal().then(|| {
            let bar = ProgressBar::new_spinner();
            bar.enable_steady_tick(Duration::from_millis(120));
            bar
        });
        Self { bar, scale, unit }
    }

    /// What is being done.
    pub fn begin(&self, what: &str) {
        match &self.bar {
            Some(bar) => bar.set_message(what.to_string()),
            None => note(what),
        }
    }

    /// A step was accepted.
    pub fn accepted(&self, step: &Step) {
        let error = self.scale * step.error;
        let sure =
            step.significance.map_or(String::new(), |significance| format!(", {significance:.1} standard errors"));
        let line = format!("{:<42} {error:>9.4}{}{sure}", step.model, self.unit);
        match &self.bar {
            Some(bar) => {
                bar.println(line);
                bar.set_message("looking for what else is missing");
            }
            None => note(&line),
        }
    }

    /// The search is over.
    pub fn end(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A closed stderr is no reason to stop.
fn note(line: &str) {
    drop(writeln!(stderr(), "{line}"));
}
