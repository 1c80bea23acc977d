//! A first manifest for a folder of recordings: what can be seen is written, what cannot is a question in a comment.
//!
//! Files of one format whose names end alike, as in `a_mocap.csv` and `b_mocap.csv`, are one source; what stands before is the
//! trial. Motion capture is taken for the reference. Which columns are commanded and which are measured nobody can see: the first
//! positions are proposed as outputs, the first columns of another source as actuators.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

use crate::error::DataError;
use crate::formats::{self, Format, Keep};
use crate::recording::dialect::{self, Told};

/// Columns that are listed of a source.
const LISTED: usize = 24;

/// Columns that are proposed.
const PROPOSED: usize = 3;

/// Files that look alike.
struct Found {
    name: String,
    format: Format,
    /// File names, sorted.
    files: Vec<String>,
    /// Between the trial's name and the extension.
    end: String,
    /// Column and unit, as far as the first file says it.
    columns: Vec<(String, Option<String>)>,
}

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
    for (i, source) in sources.iter().enumerate() {
        write_source(&mut text, source, i == 0, &reference);
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

impl Found {
    fn trials(&self) -> BTreeSet<&str> {
        self.files.iter().map(|file| trial(file, &self.end)).collect()
    }
}

/// What stands before the end that the files share.
fn trial<'a>(file: &'a str, end: &str) -> &'a str {
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    stem.strip_suffix(end).unwrap_or(stem)
}

fn sources(folder: &Path) -> Result<Vec<Found>, DataError> {
    let failed = |e: &std::io::Error| DataError::file_system("read", folder, e);
    let mut groups: BTreeMap<(Format, String), Vec<String>> = BTreeMap::new();
    for entry in std::fs::read_dir(folder).map_err(|e| failed(&e))? {
        let path = entry.map_err(|e| failed(&e))?.path();
        let Some(name) = path.file_name().and_then(|name| name.to_str()).filter(|_| path.is_file()) else { continue };
        let Some(format) = formats::recognise(&path)? else { continue };
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        let end = stem.rfind('_').map_or(String::new(), |at| stem[at..].to_string());
        groups.entry((format, end)).or_default().push(name.to_string());
    }
    let mut sources: Vec<Found> = Vec::new();
    for ((format, end), mut files) in groups {
        files.sort();
        // an end with digits is part of the trial's name
        let end = if end.contains(|c: char| c.is_ascii_digit()) { String::new() } else { end };
        let known = end.trim_start_matches('_').chars().filter(|c| c.is_alphanumeric()).collect::<String>();
        let name = if known.is_empty() { format.name().to_string() } else { known };
        match sources.iter_mut().find(|source| source.format == format && source.end == end) {
            Some(before) => before.files.extend(files),
            None => {
                let columns = columns(&folder.join(&files[0]), format)?;
                sources.push(Found { name, format, files, end, columns });
            }
        }
    }
    Ok(sources)
}

/// Columns of a file and their units.
fn columns(path: &Path, format: Format) -> Result<Vec<(String, Option<String>)>, DataError> {
    match format {
        Format::Csv => {
            let bytes = std::fs::read(path).map_err(|e| DataError::file_system("read", path, &e))?;
            let plain = dialect::plain(path, bytes, &Told::default())?;
            let text = String::from_utf8_lossy(&plain.bytes);
            let names = text.lines().next().unwrap_or_default().split(',').map(|name| name.trim().to_string());
            Ok(names.map(|name| (name.clone(), plain.units.get(&name).cloned())).collect())
        }
        Format::Parquet => Ok(Vec::new()),
        _ => {
            let take = formats::read(path, format, Keep::Nothing)?;
            let columns = take.groups.into_iter().flat_map(|group| group.columns);
            Ok(columns.map(|column| (column.name, column.unit.map(str::to_string))).collect())
        }
    }
}

fn write_source(text: &mut String, source: &Found, first: bool, trials: &BTreeSet<&str>) {
    let extension = source.files[0].rsplit_once('.').map_or("*", |(_, extension)| extension);
    let shared = source.files.len() == 1 && trials.len() > 1;
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
        let named = |name: &str| {
            ["t", "time", "timestamp", "stamp", "seconds"].iter().any(|known| name.to_lowercase().starts_with(known))
        };
        match source.columns.iter().find(|(name, _)| named(name)) {
            Some((name, unit)) => {
                let unit = unit.clone().unwrap_or_else(|| "s".into());
                let _ = writeln!(text, "time   = {{ column = {name:?}, unit = {unit:?} }}   # is this its unit?");
            }
            None => text.push_str("time   = { rate_hz = 100.0 }   # which column is the time, or what is the rate?\n"),
        }
    }
    match first {
        true => text.push_str("clock  = \"reference\"   # its samples are those of the trials\n"),
        false => text.push_str("offset = \"estimate\"   # or clock = \"same\", where one computer stamped both\n"),
    }
    let listed: Vec<&str> = source.columns.iter().take(LISTED).map(|(name, _)| name.as_str()).collect();
    let more = source.columns.len().saturating_sub(LISTED);
    let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
    let _ = writeln!(text, "# columns: {}{rest}", listed.join(", "));
}

/// Actuators of a source that is not the reference, outputs of the reference.
fn propose(text: &mut String, sources: &[Found]) {
    let is_time = |name: &str| ["t", "time", "timestamp", "stamp", "seconds"].contains(&name.to_lowercase().as_str());
    let of = |source: &Found, fits: &dyn Fn(&str) -> bool| -> Vec<(String, String)> {
        let all = source.columns.iter().filter(|(name, _)| !is_time(name) && fits(name));
        let named =
            all.map(|(name, unit)| (format!("{}.{name}", source.name), unit.clone().unwrap_or_else(|| "1".into())));
        named.take(PROPOSED).collect()
    };
    let inputs = of(sources.get(1).unwrap_or(&sources[0]), &|_| true);
    let positions = of(&sources[0], &|name| name.contains("Position") || name.ends_with(".X"));
    let outputs = if positions.is_empty() { of(&sources[0], &|_| true) } else { positions };
    let outputs = outputs.into_iter().filter(|output| !inputs.contains(output));
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
}
