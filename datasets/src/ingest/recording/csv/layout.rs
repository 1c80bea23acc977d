//! Layout of a text table: its separator and its header, which other lines may precede.
//!
//! Each separator splits the first rows. The header is the first row with all wanted columns; else the first row that holds more than
//! numbers and has as many cells as most rows, or fewer if the rows below end in empty cells. The separator is the one under which
//! a header is found and most rows fit below it; blanks only if no other fits as well.

use std::path::Path;

use super::instant::is_instant;
use super::rows::{BLANKS, Rows, bare, width};
use crate::error::DataError;

/// Rows that are looked at.
const LOOKED_AT: usize = 200;

/// Separators, in the order in which they are tried.
const KNOWN: [char; 5] = [',', ';', '\t', '|', BLANKS];

/// Where the table begins, and how its cells are separated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Layout {
    pub separator: char,
    /// Lines before the header.
    pub before: usize,
}

/// One separator's view of the first rows.
struct View {
    layout: Layout,
    /// Number of cells of the header.
    cells: usize,
    /// Whether the header has all wanted columns, whether there is one of several cells, whether rows have several cells, and how
    /// many rows fit.
    fit: (bool, bool, bool, usize),
}

/// A row of the first ones: number, cells, and the number of cells up to the last that is not empty.
type Seen = (usize, Vec<String>, usize);

/// Finds the layout of a text; a `given` separator is taken as it is.
///
/// # Errors
/// Several separators that fit as well.
pub(super) fn find(path: &Path, text: &str, given: Option<char>, wanted: &[&str]) -> Result<Layout, DataError> {
    let (named, skipped) = named(text);
    let head = head(text);
    let tried = given.or(named).map_or(KNOWN.to_vec(), |separator| vec![separator]);
    let (mut views, mut refused) = (Vec::new(), None);
    for separator in tried {
        match view(path, head, separator, skipped, wanted) {
            Ok(view) => views.push(view),
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    if let Some(error) = refused.filter(|_| views.iter().all(|view| view.cells < 2)) {
        return Err(error);
    }
    let best = views.iter().map(|view| view.fit).max().unwrap_or_default();
    let several = views.iter().filter(|view| view.fit == best && view.cells > 1);
    let shown: Vec<char> = several.map(|view| view.layout.separator).filter(|s| *s != BLANKS).collect();
    if shown.len() > 1 {
        let what = format!("{shown:?} each separate as many cells in every row");
        let remedy = "write separator = \",\" or another in [table], [[source]] or [data]";
        return Err(DataError::BadText { path: path.to_path_buf(), row: 1, what, remedy });
    }
    let first = Layout { separator: given.or(named).unwrap_or(','), before: skipped };
    Ok(views.iter().find(|view| view.fit == best).map_or(first, |view| view.layout))
}

/// The separator that a first row `sep=;` names, as spreadsheets write it, and the number of lines that it takes.
fn named(text: &str) -> (Option<char>, usize) {
    let first = bare(text.lines().next().unwrap_or_default()).to_ascii_lowercase();
    let mut named = first.strip_prefix("sep=").unwrap_or_default().chars();
    match (named.next(), named.next()) {
        (Some(separator), None) if KNOWN.contains(&separator) => (Some(separator), 1),
        _ => (None, 0),
    }
}

/// The first lines, up to a line end outside of quotes.
fn head(text: &str) -> &str {
    let (mut quotes, mut lines, mut end) = (0, 0, 0);
    for at in memchr::memchr2_iter(b'\n', b'"', text.as_bytes()) {
        match text.as_bytes()[at] {
            b'"' => quotes += 1,
            _ => {
                lines += 1;
                end = if quotes % 2 == 0 { at } else { end };
            }
        }
        if lines > LOOKED_AT && end > 0 {
            return &text[..end];
        }
    }
    text
}

fn view(path: &Path, head: &str, separator: char, skipped: usize, wanted: &[&str]) -> Result<View, DataError> {
    let mut rows = Rows::new(path, head, separator, 1);
    let mut all: Vec<Seen> = Vec::new();
    while rows.next()? {
        all.push((rows.number, names(rows.record.iter()), width(&rows.record)));
    }
    all.retain(|(number, ..)| *number > skipped);
    let has_wanted = |(_, cells, _): &Seen| wanted.iter().all(|name| cells.iter().any(|cell| cell == name));
    let asked = all.iter().position(has_wanted).filter(|_| !wanted.is_empty());
    let found = asked.or_else(|| header(&all));
    let (before, cells) = found.map_or((skipped, most_cells(&all)), |k| (all[k].0 - 1, all[k].1.len()));
    let fits = |(_, row, width): &&Seen| row.len() == cells || (row.len() > cells && *width <= cells);
    let matched = all[found.unwrap_or(0).min(all.len())..].iter().filter(fits).count();
    Ok(View {
        layout: Layout { separator, before },
        cells,
        fit: (asked.is_some(), found.is_some() && cells > 1, cells > 1, matched),
    })
}

/// The number of cells, above 1, that most rows have.
fn most_cells(rows: &[Seen]) -> usize {
    let count = |w: usize| rows.iter().filter(|(_, cells, _)| cells.len() == w).count();
    let counts = rows.iter().map(|(_, cells, _)| cells.len()).filter(|count| *count > 1);
    counts.max_by_key(|w| (count(*w), *w)).unwrap_or(1)
}

/// Index of the first row that looks like a header.
fn header(rows: &[Seen]) -> Option<usize> {
    let w = most_cells(rows);
    let is_header = |k: &usize| {
        let (_, cells, _) = &rows[*k];
        let below = rows.get(k + 1).is_some_and(|(_, below, width)| below.len() == w && *width <= cells.len());
        let fits = cells.len() == w || (cells.len() > 1 && cells.len() < w && below);
        fits && cells.iter().any(|cell| is_name(cell))
    };
    (0..rows.len()).find(is_header)
}

/// Names of a header: without blanks and quotes around them, and without the `#` of a comment before the first.
pub(super) fn names<'r>(cells: impl Iterator<Item = &'r str>) -> Vec<String> {
    let mut names: Vec<String> = cells.map(|cell| bare(cell).to_string()).collect();
    if names.len() > 1 && names[0] == "#" {
        names.remove(0);
    } else if let Some(first) = names.first_mut() {
        *first = first.trim_start_matches(['#', '\u{feff}']).trim_start().to_string();
    }
    names
}

/// Whether a cell says something that is neither a number nor a time.
fn is_name(cell: &str) -> bool {
    !cell.is_empty() && cell.replace(',', ".").parse::<f64>().is_err() && !is_instant(cell)
}
