//! A first manifest for a folder of recordings: recognized facts are written, the rest are questions in comments.
//!
//! Files of one format whose names end alike, as in `a_mocap.csv` and `b_mocap.csv`, are one source; what stands before is the
//! trial. Motion capture is taken for the reference, and where its clock can be found in the columns of another source, those are
//! named. Which columns are commands and which are measured cannot be seen: the first positions are proposed as outputs, the first
//! columns of a table as actuators.

mod clocks;
mod found;

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

use crate::error::DataError;
use crate::formats::Format;

use self::clocks::Located;
use self::found::{Found, is_time, sources};

/// Columns that are listed of a source.
const LISTED: usize = 24;

/// Columns that are proposed.
const PROPOSED: usize = 3;

/// The text of a manifest for a folder, with questions as comments.
///
/// # Errors
/// The file system; a folder without recordings; a first file that cannot be read.
pub fn manifest(folder: &Path) -> Result<String, DataError> {
    let mut sources = sources(folder)?;
    if sources.is_empty() {
        let message = format!("{}: there are no recordings; put the files there, and try again", folder.display());
        return Err(DataError::Usage(message));
    }
    sources.sort_by_key(|source| (source.format.is_table(), source.format == Format::Ulog, source.name.clone()));
    let reference: BTreeSet<&str> = sources[0].trials();
    let mut text = String::from(
        "# A first draft: answer the questions, then run acm-data check.\nprovenance = \"\"   # where are the data from?\n",
    );
    let outputs = outputs(&sources[0]);
    for (i, source) in sources.iter().enumerate() {
        let located = (i > 0).then(|| clocks::located(folder, &sources[0], &outputs, source)).flatten();
        write_source(&mut text, source, i == 0, located.as_ref(), &reference);
    }
    propose(&mut text, &sources);
    let trials: Vec<String> = reference.iter().map(|trial| format!("{trial:?}")).collect();
    let _ = writeln!(
        text,
        "\n[roles]   # which trials calibrate, which are held out?\ndevelopment = [{}]",
        trials.join(", ")
    );
    Ok(text)
}

fn write_source(text: &mut String, source: &Found, first: bool, located: Option<&Located>, trials: &BTreeSet<&str>) {
    let extension = source.files[0].rsplit_once('.').map_or("*", |(_, extension)| extension);
    let shared = source.is_shared(trials);
    let files = if shared { source.files[0].clone() } else { format!("*{}.{extension}", source.end) };
    let _ = writeln!(
        text,
        "\n[[source]]\nname   = {:?}\nfiles  = [{files:?}]\nformat = {:?}",
        source.name,
        source.format.name()
    );
    if shared {
        let _ = writeln!(text, "shared = true   # does this one file hold all trials?");
    } else if !source.end.is_empty() {
        let _ = writeln!(text, "trial  = {{ file = \"(.*){}\" }}", source.end);
    }
    if source.format.is_table() {
        match source.time() {
            Some((name, unit)) => {
                let _ = writeln!(text, "time   = {{ column = {name:?}, unit = {unit:?} }}   # is this its unit?");
            }
            None => text.push_str("time   = { rate_hz = 100.0 }   # which column is the time, or what is the rate?\n"),
        }
    }
    let same = "or clock = \"same\", where one computer stamped both";
    let _ = match (first, located) {
        (true, _) => writeln!(text, "clock  = \"reference\"   # its samples are those of the trials"),
        (false, None) => writeln!(text, "offset = \"estimate\"   # {same}"),
        (false, Some(Located { by: [reference, own], found })) => {
            writeln!(text, "offset = {{ estimate = \"estimate\", by = [{reference:?}, {own:?}] }}   # {found}; {same}")
        }
    };
    let listed: Vec<&str> = source.columns.iter().take(LISTED).map(|(name, _)| name.as_str()).collect();
    let more = source.columns.len().saturating_sub(LISTED);
    let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
    let _ = writeln!(text, "# columns: {}{rest}", listed.join(", "));
}

/// The first positions of the reference, or its first columns, with units.
fn outputs(reference: &Found) -> Vec<(String, String)> {
    let positions = named(reference, |name| name.contains("Position") || name.ends_with(".X"));
    if positions.is_empty() { named(reference, |_| true) } else { positions }
}

/// Some columns with the source's name before them, and their units.
fn named(source: &Found, fits: impl Fn(&str) -> bool) -> Vec<(String, String)> {
    let all = source.columns.iter().filter(|(name, _)| !is_time(name) && fits(name));
    let full = all.map(|(name, unit)| (format!("{}.{name}", source.name), unit.clone().unwrap_or_else(|| "1".into())));
    full.take(PROPOSED).collect()
}

/// Actuators of a table that is not the reference, outputs of the reference, and what else may be known.
fn propose(text: &mut String, sources: &[Found]) {
    let others = || sources.iter().skip(1);
    let commands = others().find(|source| source.format.is_table()).or(others().next()).unwrap_or(&sources[0]);
    let inputs = named(commands, |_| true);
    let outputs = outputs(&sources[0]).into_iter().filter(|output| !inputs.contains(output));
    for (column, unit) in &inputs {
        let _ = writeln!(
            text,
            "\n[[actuator]]   # is this commanded, in this unit?\ncolumn = {column:?}\nunit   = {unit:?}"
        );
    }
    for (column, unit) in outputs {
        let _ = writeln!(
            text,
            "\n[[measured]]   # is this an output, in this unit?\ncolumn = {column:?}\nunit   = {unit:?}"
        );
    }
    for source in others().filter(|source| source.name != commands.name) {
        let Some((column, unit)) = named(source, |_| true).into_iter().next() else { continue };
        let _ = writeln!(
            text,
            "\n# [[context]]   # what else is known at each sample, such as a voltage or a throttle?\n# column = {column:?}\n# unit   = {unit:?}"
        );
    }
}
