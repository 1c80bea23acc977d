//! Text of the draft: each file, each column and each trial stands in it once, and what is not certain is a question.

use std::fmt::Write;
use std::path::Path;

use super::clocks;
use super::found::{Found, Time};
use super::names::{self, list, quoted};
use super::signals::{self, Part, Signal};
use super::sources::Folder;
use crate::text::natural;

/// Columns that are proposed as a [[context]]; of more, the names.
const LISTED: usize = 24;

/// The draft of a folder with recordings.
pub(super) fn text(folder: &Path, found: &Folder) -> String {
    let signals = signals::signals(&found.sources);
    let mut draft = Draft { text: String::new(), is_table: is_table(&found.sources), comment: "" };
    draft.add("# A first draft: answer the questions, then run acm-data check.");
    for (file, reason) in &found.left {
        draft.add(&format!("# {} is left out: {reason}", quoted(file)));
    }
    draft.line("provenance", "\"\"", "where are the data from?");
    for source in &found.sources {
        draft.files(folder, source, &found.left);
        if source.format.is_table() {
            draft.time(source.time.as_ref());
        }
        let is_periodic = |s: &&Signal| std::ptr::eq(s.source, source) && s.part != Part::Unknown && s.period.is_some();
        draft.periods(&signals.iter().filter(is_periodic).collect::<Vec<_>>());
        if !draft.is_table {
            draft.clock(folder, &found.sources[0], source, &signals);
        }
    }
    draft.add("");
    draft.signals(&signals);
    draft.roles(found.sources[0].trials().into_iter().collect());
    draft.text
}

/// Whether a [table] describes all.
fn is_table(sources: &[Found]) -> bool {
    sources.len() == 1 && sources[0].format.is_table() && sources[0].files.iter().all(|file| has_table_name(&file.path))
}

fn has_table_name(path: &str) -> bool {
    [".csv", ".parquet"].iter().any(|end| path.to_lowercase().ends_with(end))
}

/// A text that grows.
struct Draft {
    text: String,
    is_table: bool,
    /// Before each key of what is only proposed.
    comment: &'static str,
}

impl Draft {
    fn add(&mut self, line: &str) {
        let _ = writeln!(self.text, "{line}");
    }

    /// A key, its value, and what is asked about it; an empty list needs no line.
    fn line(&mut self, key: &str, value: &str, question: &str) {
        if value == "[]" {
            return;
        }
        let question = if question.is_empty() { String::new() } else { format!("   # {question}") };
        self.add(&format!("{}{key:<6} = {value}{question}", self.comment));
    }

    /// Which files, and where their trials are named.
    fn files(&mut self, folder: &Path, source: &Found, left: &[(String, String)]) {
        let paths: Vec<&str> = source.files.iter().map(|file| file.path.as_str()).collect();
        if self.is_table {
            self.add("\n[table]");
        } else {
            self.add("\n[[source]]");
            self.line("name", &quoted(&source.name), "");
        }
        self.line("files", &list(names::patterns(folder, &paths, &source.ends)), "");
        if self.is_table {
            let ignored = left.iter().map(|(path, _)| path).filter(|path| !path.contains('/') && has_table_name(path));
            self.line("ignore", &list(ignored.map(|path| names::escaped(path))), "");
        } else {
            self.line("format", &quoted(source.format.name()), "");
        }
        let (before, after) = &source.ends;
        if let Some((column, _)) = &source.by {
            self.line("trial", &format!("{{ column = {} }}", quoted(column)), "does it name the trials?");
        } else if source.shared {
            self.line("shared", "true", "does this one file hold all trials?");
        } else if source.ends != Default::default() {
            let pattern = format!("{}(.*){}", regex::escape(before), regex::escape(after));
            self.line("trial", &format!("{{ file = {} }}", quoted(&pattern)), "");
        }
    }

    fn time(&mut self, time: Option<&Time>) {
        let Some(Time { column, unit, guessed, .. }) = time else {
            return self.line("time", "{ rate_hz = 100.0 }", "no column looks like time: what is the rate?");
        };
        let unit = unit.as_ref().map_or(String::new(), |unit| format!(", unit = {}", quoted(unit)));
        let question = if *guessed { "is this its unit?" } else { "" };
        self.line("time", &format!("{{ column = {}{unit} }}", quoted(column)), question);
    }

    /// Signals of a source that start again at their other end.
    fn periods(&mut self, signals: &[&Signal]) {
        let (angles, counters): (Vec<&Signal>, Vec<&Signal>) = signals.iter().partition(|signal| signal.is_angle());
        self.line("angles", &list(angles.iter().map(|signal| signal.of.name)), "each jumps by a full turn");
        if !counters.is_empty() {
            let of = |s: &&Signal| format!("{} = {}", quoted(s.of.name), s.period.unwrap_or_default());
            let counters = counters.iter().map(of).collect::<Vec<_>>().join(", ");
            self.line("counters", &format!("{{ {counters} }}"), "each starts again after so many");
        }
    }

    /// The clock of the reference, or that of another source and what is known of it.
    fn clock(&mut self, folder: &Path, reference: &Found, source: &Found, signals: &[Signal]) {
        if std::ptr::eq(source, reference) {
            return self.line("clock", "\"reference\"", "its samples are those of the trials");
        }
        let same = "or clock = \"same\", where one computer stamped both";
        match clocks::located(folder, reference, source, signals) {
            None => self.line("offset", "\"estimate\"", same),
            Some((by, found)) => {
                let offset = format!("{{ estimate = \"estimate\", by = {} }}", list(by));
                self.line("offset", &offset, &format!("{found}; {same}"));
            }
        }
    }

    fn signals(&mut self, signals: &[Signal]) {
        let of = |part: Part| signals.iter().filter(move |signal| signal.part == part && signal.flaw.is_none());
        for (part, table, question) in [
            (Part::Actuator, "actuator", "commanded, or read back from the drive,"),
            (Part::Measured, "measured", "an output of the robot, for a model to predict,"),
        ] {
            self.add(&format!("# Is each of these {question} in this unit?"));
            of(part).for_each(|signal| self.signal(signal, table));
            if of(part).next().is_none() {
                self.add(&format!("# No column is left for it: [[{table}]] needs `column` and `unit`.\n"));
            }
        }
        if of(Part::Unknown).next().is_some() {
            self.add("# What else is known at each sample, such as a load? Delete the # before it.");
        }
        self.comment = "# ";
        of(Part::Unknown).take(LISTED).for_each(|signal| self.signal(signal, "context"));
        self.comment = "";
        of(Part::Unknown).skip(LISTED).for_each(|signal| self.add(&format!("# {}", self.column(signal))));
        for (signal, flaw) in signals.iter().filter_map(|signal| Some((signal, signal.flaw.as_ref()?))) {
            self.add(&format!("# not used: {}, {flaw}", self.column(signal)));
        }
        if !self.text.ends_with("\n\n") {
            self.add("");
        }
    }

    fn signal(&mut self, signal: &Signal, table: &str) {
        let unit = signal.unit.unwrap_or("1");
        self.add(&format!("{}[[{table}]]", self.comment));
        self.line("column", &self.column(signal), "");
        self.line("unit", &quoted(unit), if unit == "1" { "which unit?" } else { "" });
        if let Some(name) = signal.plain_name() {
            self.line("name", &quoted(name), "");
        }
        self.add("");
    }

    /// Name of a column in the manifest, in quotes.
    fn column(&self, signal: &Signal) -> String {
        let (source, name) = (&signal.source.name, signal.of.name);
        if self.is_table { quoted(name) } else { quoted(&format!("{source}.{name}")) }
    }

    /// The last of three trials or more is held out. Of fewer, the programs hold out the last part of each.
    fn roles(&mut self, mut trials: Vec<&str>) {
        trials.sort_by(|a, b| natural::compare(a, b));
        let held_out = trials.split_off(if trials.len() > 2 { trials.len() - 1 } else { trials.len() });
        self.add("[roles]   # which trials calibrate the nominal model, and which test the result?");
        self.add("calibration = []");
        self.add(&format!("development = {}", list(trials)));
        self.add(&format!("held_out    = {}", list(held_out)));
    }
}
