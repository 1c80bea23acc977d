//! A chapter of the page: runs on one data set, or a study.

pub mod best;
pub mod best_sequences;
mod chosen;
pub mod list;
pub mod nominal;
pub mod residual;
mod runs;
pub mod sequences;
pub mod studies;
mod study_table;

pub use runs::of_section;

use acm_train::run::record::DataStamp;
use maud::{Markup, html};

use crate::{figures::Drawing, tables::Table};

/// Chapter of a report: the tables and figures of runs on one data set, or of a study.
pub struct Chapter {
    /// Prefix of the names of its files, unique on the page.
    pub slug: String,
    /// Heading of the chapter.
    pub title: String,
    /// Origin of its numbers.
    pub data: DataStamp,
    /// Result in one sentence; may be empty.
    pub lead: Markup,
    /// Runs that were planned and are not there, in sentences; the lead has them as well.
    pub missing: Vec<String>,
    /// Parts that were left out, with reasons.
    pub notes: Vec<String>,
    /// Runs or studies, each with its question.
    pub questions: Vec<(String, String)>,
    /// Tables of the chapter; the first stands above the figures.
    pub tables: Vec<Table>,
    /// Figures of the chapter.
    pub figures: Vec<Shown>,
    /// Origin of the numbers, and commands that reproduce them.
    pub provenance: Vec<(&'static str, Markup)>,
    /// Name of the table that the terminal prints.
    pub main: &'static str,
}

/// Writes missing runs as a list on the page.
fn missing(sentences: &[String]) -> Markup {
    html! { @for sentence in sentences { p.note role="note" { strong { "Incomplete. " } (sentence) } } }
}

/// A figure that is drawn.
pub struct Shown {
    /// Name of the files, and of the anchor on the page.
    pub name: &'static str,
    /// Question that the figure answers.
    pub question: String,
    /// Drawing of the figure.
    pub drawing: Drawing,
}

/// Returns letters, digits and hyphens of a name; a number where another chapter has the same.
pub fn slug(name: &str, before: &[Chapter]) -> String {
    let name = name.to_ascii_lowercase();
    let words: Vec<&str> = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let name = if words.is_empty() { "data".to_string() } else { words.join("-") };
    let taken = |slug: &String| before.iter().any(|chapter| chapter.slug == *slug);
    let numbered = (2..).map(|n| format!("{name}-{n}"));
    std::iter::once(name.clone()).chain(numbered).find(|slug| !taken(slug)).unwrap_or(name)
}
