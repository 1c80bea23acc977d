//! Text of the draft: each file, each column and each trial stands in it once, and what is not certain is a question.

use std::fmt::Write;
use std::path::Path;

use super::clocks::{self, Located};
use super::found::Found;
use super::names::{self, list, quoted};
use super::signals::{self, Part, Signal};
use super::sources::Folder;
use super::time::{self, Time};
use crate::text::natural;

/// Columns that are proposed as a [[context]]; of more, the names.
const LISTED: usize = 24;

/// The draft of a folder with recordings, whose trials a column may name.
pub(super) fn text(folder: &Path, found: &Folder, trial: Option<(String, Vec<String>)>) -> String {
    let (reference, by) = (&found.sources[0], trial.as_ref().map(|(column, _)| column.as_str()));
    let times: Vec<Option<Time>> = found.sources.iter().map(|source| time::of(source, by)).collect();
    let signals = signals::signals(&found.sources, &times, by);
    let outputs =
        signals.iter().filter(|signal| signal.part == Part::Measured).map(|signal| signal.of.name.to_string());
    let outputs: Vec<String> = outputs.collect();
    let mut text = String::from("# A first draft: answer the questions, then run acm-data check.\n");
    for (file, reason) in &found.left {
        let _ = writeln!(text, "# {} is left out: {reason}", quoted(file));
    }
    text.push_str("provenance = \"\"   # where are the data from?\n");
    let is_table = is_table(&found.sources);
    for (k, (source, time)) in found.sources.iter().zip(&times).enumerate() {
        text.push_str(&files(source, found, is_table, by));
        if source.format.is_table() {
            text.push_str(&time_line(time.as_ref()));
        }
        text.push_str(&periods(signals.iter().filter(|signal| std::ptr::eq(signal.source, source)).collect()));
        if !is_table {
            text.push_str(&clock_line((k > 0).then(|| clocks::located(folder, reference, &outputs, source))));
        }
    }
    write_signals(&mut text, &signals, is_table);
    let of_files = || reference.trials().into_iter().map(str::to_string).collect();
    text + &roles(trial.map_or_else(of_files, |(_, trials)| trials))
}

/// Whether a [table] describes all.
fn is_table(sources: &[Found]) -> bool {
    let is_known = |path: &str| [".csv", ".parquet"].iter().any(|end| path.to_lowercase().ends_with(end));
    sources.len() == 1 && sources[0].format.is_table() && sources[0].files.iter().all(|file| is_known(&file.path))
}

/// Which files, and where their trials are named.
fn files(source: &Found, found: &Folder, is_table: bool, by: Option<&str>) -> String {
    let list = |patterns: Vec<String>| list(patterns.iter().map(String::as_str));
    let paths: Vec<&str> = source.files.iter().map(|file| file.path.as_str()).collect();
    let patterns = list(names::patterns(&paths, &source.ends, &found.paths));
    let table = |path: &&str| !path.contains('/') && (path.ends_with(".csv") || path.ends_with(".parquet"));
    let ignored: Vec<&str> = found.left.iter().map(|(path, _)| path.as_str()).filter(table).collect();
    let ignored = list(names::patterns(&ignored, &Default::default(), &found.paths));
    let (before, after) = &source.ends;
    let mut text = match is_table {
        true if ignored == "[]" => format!("\n[table]\nfiles  = {patterns}\n"),
        true => format!("\n[table]\nfiles  = {patterns}\nignore = {ignored}\n"),
        false => {
            let (name, format) = (quoted(&source.name), quoted(source.format.name()));
            format!("\n[[source]]\nname   = {name}\nfiles  = {patterns}\nformat = {format}\n")
        }
    };
    if let Some(column) = by {
        let _ = writeln!(text, "trial  = {{ column = {} }}   # does it name the trials?", quoted(column));
    } else if source.shared {
        text.push_str("shared = true   # does this one file hold all trials?\n");
    } else if !(before.is_empty() && after.is_empty()) {
        let pattern = format!("{}(.*){}", regex::escape(before), regex::escape(after));
        let _ = writeln!(text, "trial  = {{ file = {} }}", quoted(&pattern));
    }
    text
}

fn time_line(time: Option<&Time>) -> String {
    let Some(Time { column, unit, guessed }) = time else {
        return "time   = { rate_hz = 100.0 }   # no column looks like time: what is the rate?\n".into();
    };
    let unit = unit.as_ref().map_or(String::new(), |unit| format!(", unit = {}", quoted(unit)));
    let question = if *guessed { "   # is this its unit?" } else { "" };
    format!("time   = {{ column = {}{unit} }}{question}\n", quoted(column))
}

/// Proposed signals that start again at their other end.
fn periods(mut signals: Vec<&Signal>) -> String {
    signals.retain(|signal| signal.part != Part::Unknown && signal.period.is_some());
    let (angles, counters): (Vec<&Signal>, Vec<&Signal>) = signals.into_iter().partition(|signal| signal.is_angle());
    let mut text = String::new();
    if !angles.is_empty() {
        let _ = writeln!(text, "angles = {}   # each jumps by a full turn", list(angles.iter().map(|s| s.of.name)));
    }
    if !counters.is_empty() {
        let of = |s: &&Signal| format!("{} = {}", quoted(s.of.name), s.period.unwrap_or_default());
        let counters = counters.iter().map(of).collect::<Vec<_>>().join(", ");
        let _ = writeln!(text, "counters = {{ {counters} }}   # each starts again after so many");
    }
    text
}

/// The clock of the reference, or that of another source and what is known of it.
fn clock_line(located: Option<Option<Located>>) -> String {
    let same = "or clock = \"same\", where one computer stamped both";
    match located {
        None => "clock  = \"reference\"   # its samples are those of the trials\n".into(),
        Some(None) => format!("offset = \"estimate\"   # {same}\n"),
        Some(Some(Located { by, found })) => {
            let by = list(by.iter().map(String::as_str));
            format!("offset = {{ estimate = \"estimate\", by = {by} }}   # {found}; {same}\n")
        }
    }
}

fn write_signals(text: &mut String, signals: &[Signal], is_table: bool) {
    let of = |part: Part| signals.iter().filter(move |signal| signal.part == part && signal.flaw.is_none());
    text.push('\n');
    for (part, table, question) in [
        (Part::Actuator, "actuator", "commanded, or read back from the drive,"),
        (Part::Measured, "measured", "an output of the robot, for a model to predict,"),
    ] {
        let _ = writeln!(text, "# Is each of these {question} in this unit?");
        of(part).for_each(|signal| text.push_str(&signal_text(signal, table, is_table, "")));
        if of(part).next().is_none() {
            let _ = writeln!(text, "# No column is left for it: [[{table}]] needs `column` and `unit`.\n");
        }
    }
    if of(Part::Unknown).next().is_some() {
        text.push_str("# What else is known at each sample, such as a load? Delete the # before it.\n");
    }
    of(Part::Unknown).take(LISTED).for_each(|signal| text.push_str(&signal_text(signal, "context", is_table, "# ")));
    of(Part::Unknown).skip(LISTED).for_each(|signal| {
        let _ = writeln!(text, "# {}", column(signal, is_table));
    });
    for (signal, flaw) in signals.iter().filter_map(|signal| Some((signal, signal.flaw.as_ref()?))) {
        let _ = writeln!(text, "# not used: {}, {flaw}", column(signal, is_table));
    }
    if !text.ends_with("\n\n") {
        text.push('\n');
    }
}

/// Name of a column in the manifest, in quotes.
fn column(signal: &Signal, is_table: bool) -> String {
    let (source, name) = (&signal.source.name, signal.of.name);
    if is_table { quoted(name) } else { quoted(&format!("{source}.{name}")) }
}

fn signal_text(signal: &Signal, table: &str, is_table: bool, comment: &str) -> String {
    let (column, unit) = (column(signal, is_table), signal.unit.unwrap_or("1"));
    let question = if unit == "1" { "   # which unit?" } else { "" };
    let mut text =
        format!("{comment}[[{table}]]\n{comment}column = {column}\n{comment}unit   = {}{question}\n", quoted(unit));
    if let Some(name) = signal.plain_name() {
        let _ = writeln!(text, "{comment}name   = {}", quoted(name));
    }
    if signal.of.empty() > 0 && table == "context" {
        let _ = writeln!(text, "# it has {} empty cells, which only an output may have", signal.of.empty());
    }
    text + "\n"
}

/// The last of three trials or more is held out. Of fewer, the programs hold out the last part of each.
fn roles(mut trials: Vec<String>) -> String {
    trials.sort_by(|a, b| natural::compare(a, b));
    let held_out = trials.split_off(if trials.len() > 2 { trials.len() - 1 } else { trials.len() });
    let of = |trials: &[String]| list(trials.iter().map(String::as_str));
    let (trials, held_out) = (of(&trials), of(&held_out));
    let question = "# which trials calibrate the nominal model, and which test the result?";
    format!("[roles]   {question}\ncalibration = []\ndevelopment = {trials}\nheld_out    = {held_out}\n")
}
