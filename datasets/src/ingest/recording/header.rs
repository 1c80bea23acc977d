//! Header names: missing or duplicate columns, with the likely name.

use std::path::Path;

use super::Wanted;
use crate::error::{DataError, shown};

/// Columns that are missing or doubled in a header.
pub(super) fn check(path: &Path, header: &[String], wanted: &Wanted) -> Vec<DataError> {
    let problem = |column: &str| {
        let (path, name) = (path.to_path_buf(), shown(&visible(column)));
        match count(header, column) {
            1 => None,
            0 => Some(DataError::MissingColumn { path, known: list(header, column), column: name }),
            count => Some(DataError::DoubledColumn { path, column: name, count }),
        }
    };
    wanted.columns().into_iter().filter_map(problem).collect()
}

/// The wanted columns that are there once.
pub(super) fn present<'a>(header: &[String], wanted: &'a Wanted) -> Vec<&'a str> {
    wanted.columns().into_iter().filter(|column| count(header, column) == 1).collect()
}

fn count(header: &[String], column: &str) -> usize {
    header.iter().filter(|name| *name == column).count()
}

/// The names of a header, and the one that was meant.
fn list(header: &[String], wanted: &str) -> String {
    let names: Vec<String> = header.iter().take(40).map(|h| format!("`{}`", shown(&visible(h)))).collect();
    let more = if header.len() > 40 { format!(" and {} more", header.len() - 40) } else { String::new() };
    let alike = |name: &&String| *name != wanted && bare(name) == bare(wanted);
    let meant = header.iter().find(alike).or_else(|| {
        let name = crate::text::spelling::meant(wanted, header.iter().map(String::as_str))?;
        header.iter().find(|h| *h == name)
    });
    let meant = meant.map_or(String::new(), |name| format!(" (did you mean `{}`?)", shown(&visible(name))));
    names.join(" ") + &more + &meant
}

/// A name whose letters can all be seen: others are written by their number, as `\u{200b}`.
pub(crate) fn visible(name: &str) -> String {
    name.chars().map(|c| if unseen(c) { c.escape_unicode().to_string() } else { c.to_string() }).collect()
}

/// Letters that take no room, or turn the order of others: controls, joiners, marks, selectors, spaces but the usual one.
fn unseen(c: char) -> bool {
    c.is_control()
        || (c.is_whitespace() && c != ' ')
        || matches!(c, '\u{ad}' | '\u{300}'..='\u{36f}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}'
            | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{fe00}'..='\u{fe0f}' | '\u{feff}'
            | '\u{e0000}'..='\u{e007f}')
}

/// A name as it looks: small letters, without what cannot be seen.
fn bare(name: &str) -> String {
    name.chars().filter(|c| !unseen(*c) && *c != ' ').flat_map(char::to_lowercase).collect()
}
