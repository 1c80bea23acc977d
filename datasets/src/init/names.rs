//! Names: what file names share, patterns of files, units and words in the names of columns, and text in TOML.

use glob::{MatchOptions, Pattern};

use crate::units::{Dimension, Unit};

/// Characters between the words of a name.
const BORDERS: [char; 4] = ['_', '-', ' ', '.'];

/// Units that the last word of a name may be without brackets; one letter is seldom a unit (`motor_A`).
const BARE: &str = "rad mrad deg m cm mm um km s ms us ns Hz kg mN kN Nm Pa hPa kPa MPa mbar bar psi V mV mA rpm";

/// Beginning and end that names share, cut at the borders of words. A word with digits belongs to the trial.
pub(super) fn common(names: &[&str]) -> (String, String) {
    let (before, after) = split(names, &|part| !part.contains(|c: char| c.is_ascii_digit()));
    let room = names.iter().all(|name| name.len() > before.len() + after.len());
    (before.to_string(), if room { after.to_string() } else { String::new() })
}

/// Longest beginning and longest end of the first of several names that all of them have and that `fits`.
pub(super) fn split<'a>(names: &[&'a str], fits: &dyn Fn(&str) -> bool) -> (&'a str, &'a str) {
    let [first, _, ..] = names else { return ("", "") };
    let borders = || first.match_indices(BORDERS).map(|(at, _)| at);
    let all =
        |part: &str, has: &dyn Fn(&str) -> bool| fits(part) && names.iter().all(|n| n.len() > part.len() && has(n));
    let begins = borders().map(|at| &first[..=at]).rfind(|part| all(part, &|name| name.starts_with(part)));
    let ends = borders().map(|at| &first[at..]).find(|part| all(part, &|name| name.ends_with(part)));
    (begins.unwrap_or_default(), ends.unwrap_or_default())
}

/// Patterns that match these files and none of the others: one with a star, or each file by its name.
pub(super) fn patterns(files: &[&str], ends: &(String, String), all: &[String]) -> Vec<String> {
    let folder = |file: &str| file.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
    let Some(first) = files.first() else { return Vec::new() };
    let extension = first.rsplit_once('.').map_or("", |(_, extension)| extension);
    let pattern = format!("{}*{}.{extension}", escaped(&(folder(first) + &ends.0)), escaped(&ends.1));
    let options = MatchOptions { require_literal_separator: true, ..MatchOptions::new() };
    let exact = Pattern::new(&pattern).is_ok_and(|pattern| {
        all.iter().all(|name| pattern.matches_with(name, options) == files.contains(&name.as_str()))
    });
    if files.len() > 1 && exact { vec![pattern] } else { files.iter().map(|file| escaped(file)).collect() }
}

/// A name as a pattern; characters that a pattern of a manifest must not have become `?`.
fn escaped(name: &str) -> String {
    let pattern = Pattern::escape(name).replace([':', '\\'], "?");
    if pattern.starts_with('~') { pattern.replacen('~', "?", 1) } else { pattern }
}

/// A text in TOML, on one line.
pub(super) fn quoted(text: &str) -> String {
    let inner = text.chars().map(|c| match c {
        '"' | '\\' => format!("\\{c}"),
        c if c.is_control() => format!("\\u{:04X}", u32::from(c)),
        c => c.to_string(),
    });
    format!("\"{}\"", inner.collect::<String>())
}

/// Texts in TOML, as a list.
pub(super) fn list<'a>(texts: impl IntoIterator<Item = &'a str>) -> String {
    format!("[{}]", texts.into_iter().map(quoted).collect::<Vec<_>>().join(", "))
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
    let (mut words, mut lower) = (vec![String::new()], false);
    for c in name.chars() {
        if !c.is_alphabetic() || (lower && c.is_uppercase()) {
            words.push(String::new());
        }
        lower = c.is_lowercase();
        if let Some(word) = words.last_mut().filter(|_| c.is_alphabetic()) {
            word.extend(c.to_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Whether a list of words has a word.
pub(super) fn has(list: &str, word: &str) -> bool {
    list.split(' ').any(|listed| listed == word)
}

/// Whether a list of words has one of some words.
pub(super) fn any(words: &[String], list: &str) -> bool {
    words.iter().any(|word| has(list, word))
}
