//! Names: what file names share, patterns of files, units and words in the names of columns, and text in TOML.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use glob::Pattern;

use crate::ingest::locate;
use crate::units::{Dimension, Unit};

/// Characters between the words of a name.
const BORDERS: [char; 4] = ['_', '-', ' ', '.'];

/// Units that the last word of a name may be without brackets; one letter is seldom a unit (`motor_A`).
const BARE: &str = "rad mrad deg m cm mm um km s ms us ns Hz kg mN kN Nm Pa hPa kPa MPa mbar bar psi V mV mA rpm";

/// Longest beginning and end that names share, cut at the borders of words. A word with digits belongs to the trial, if `digits` does
/// not say otherwise.
pub(super) fn common(names: &[&str], digits: bool) -> (String, String) {
    let [first, _, ..] = names else { return Default::default() };
    let shared = |part: &str, has: fn(&str, &str) -> bool| {
        (digits || !part.contains(|c: char| c.is_ascii_digit()))
            && names.iter().all(|name| name.len() > part.len() && has(name, part))
    };
    let borders = || first.match_indices(BORDERS).map(|(at, _)| at);
    let before = borders().map(|at| &first[..=at]).rfind(|part| shared(part, |name, part| name.starts_with(part)));
    let after = borders().map(|at| &first[at..]).find(|part| shared(part, |name, part| name.ends_with(part)));
    let (before, after) = (before.unwrap_or_default(), after.unwrap_or_default());
    let has_room = names.iter().all(|name| name.len() > before.len() + after.len());
    (before.to_string(), if has_room { after.to_string() } else { String::new() })
}

/// Patterns that match these files of a folder and no others: one with a star, or each file by its name.
pub(super) fn patterns(folder: &Path, files: &[&str], ends: &(String, String)) -> Vec<String> {
    let (below, extension) = files[0].rsplit_once('.').unwrap_or((files[0], ""));
    let below = below.rsplit_once('/').map_or(String::new(), |(below, _)| format!("{below}/"));
    let pattern = format!("{}*{}.{extension}", escaped(&(below + &ends.0)), escaped(&ends.1));
    let matched: BTreeSet<PathBuf> = locate::matches(folder, &pattern).into_iter().collect();
    let is_exact = matched == files.iter().map(PathBuf::from).collect();
    if files.len() > 1 && is_exact { vec![pattern] } else { files.iter().map(|file| escaped(file)).collect() }
}

/// A name as a pattern; characters that a pattern of a manifest must not have become `?`.
pub(super) fn escaped(name: &str) -> String {
    let pattern = Pattern::escape(name).replace([':', '\\'], "?");
    if pattern.starts_with('~') { pattern.replacen('~', "?", 1) } else { pattern }
}

/// A text in TOML, on one line.
pub(super) fn quoted(text: &str) -> String {
    let escaped = |c: char| match c {
        '"' | '\\' => format!("\\{c}"),
        c if c.is_control() => format!("\\u{:04X}", u32::from(c)),
        c => c.to_string(),
    };
    format!("\"{}\"", text.chars().map(escaped).collect::<String>())
}

/// Texts in TOML, as a list.
pub(super) fn list(texts: impl IntoIterator<Item: AsRef<str>>) -> String {
    format!("[{}]", texts.into_iter().map(|text| quoted(text.as_ref())).collect::<Vec<_>>().join(", "))
}

/// The name of a column without its unit, and that unit: `x [mm]`, `t (s)`, `q1_rad`, or the unit alone.
pub(super) fn unit(name: &str) -> Option<(&str, String)> {
    let name = name.trim();
    let inner = name.strip_suffix([']', ')']).and_then(|open| open.rsplit_once(['[', '(']));
    if let Some((base, unit)) = inner {
        return Some((base.trim_end_matches(BORDERS), known(unit)?));
    }
    let (base, last) = name.rsplit_once(['_', ' ']).unwrap_or(("", name));
    let unit = known(last).filter(|unit| has(BARE, last) || (last.len() > 4 && unit != "sample"))?;
    (!base.is_empty() || is_time(&unit)).then_some((base, unit))
}

/// A unit as a manifest may have it.
pub(super) fn known(unit: &str) -> Option<String> {
    let unit = unit.trim();
    match Unit::parse(unit) {
        Ok(_) => Some(unit.to_string()),
        Err(unknown) => unknown.meant().map(str::to_string),
    }
}

/// Whether a unit is one of time.
pub(super) fn is_time(unit: &str) -> bool {
    Unit::parse(unit).is_ok_and(|unit| unit.dimension == Dimension::Time)
}

/// The words of a name in small letters, without digits: `tipPos_x1` has `tip`, `pos` and `x`.
pub(super) fn words(name: &str) -> Vec<String> {
    let (mut spaced, mut lower) = (String::new(), false);
    for c in name.chars() {
        if lower && c.is_uppercase() {
            spaced.push(' ');
        }
        lower = c.is_lowercase();
        spaced.extend(c.to_lowercase());
    }
    let words = spaced.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty());
    words.map(str::to_string).collect()
}

/// Whether a list of words has a word.
pub(super) fn has(list: &str, word: &str) -> bool {
    list.split(' ').any(|listed| listed == word)
}

/// Whether a list of words has one of some words.
pub(super) fn any(words: &[String], list: &str) -> bool {
    words.iter().any(|word| has(list, word))
}
