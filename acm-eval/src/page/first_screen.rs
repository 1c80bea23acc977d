//! The first screen: which data, the answer, the main table in brief, and one figure.

use acm_train::run::evaluation::summary::count;
use maud::{Markup, html};

use super::{badge, figure_files, heading, rows, sheet};
use crate::{
    chapter::{Chapter, Shown},
    report::Report,
    tables::Table,
};

/// Rows of the table in brief, at most.
const ROWS: usize = 10;

/// First screen of the page.
pub struct FirstScreen<'a> {
    /// The chapter that it is of: the first with errors on held-out trials, else the first.
    pub chapter: &'a Chapter,
    /// Figure of the first screen, which is then left out of the chapter.
    pub figure: Option<&'a Shown>,
}

impl<'a> FirstScreen<'a> {
    /// Returns the first screen of a report with any chapter.
    pub fn of(report: &'a Report) -> Option<Self> {
        let scored = report.chapters.iter().find(|chapter| chapter.main == "errors");
        let chapter = scored.or(report.chapters.first())?;
        Some(Self { chapter, figure: chapter.figures.first() })
    }

    /// Writes the top of the page.
    pub fn show(&self) -> Markup {
        let chapter = self.chapter;
        let main = chapter.tables.iter().find(|table| table.name == chapter.main);
        let asked = chapter.questions.first().map_or("", |(_, question)| question.as_str());
        html! {
            header {
                h1 { (chapter.data.title) (badge(&chapter.data)) }
                @if chapter.title != chapter.data.title { p.chapter { (chapter.title) } }
                @if chapter.lead.0.is_empty() { p.lead { (asked) } } @else { (chapter.lead) }
                div.answer {
                    @if let Some(main) = main { div { (brief(main, chapter)) } }
                    @if let Some(shown) = self.figure { (figure(shown, chapter)) }
                }
                @for note in &chapter.notes { p { (note) } }
            }
        }
    }
}

fn figure(shown: &Shown, chapter: &Chapter) -> Markup {
    html! {
        figure id={ (chapter.slug) "-" (shown.name) } {
            h3 { (shown.question) }
            (sheet(shown, chapter))
            figcaption {
                details { summary { "How to read it" } p { (shown.drawing.explanation) } }
                (figure_files(shown, chapter))
            }
        }
    }
}

/// Returns the summary columns, and the first rows.
fn brief(main: &Table, chapter: &Chapter) -> Markup {
    let mut table = main.clone();
    let summing = main.columns.iter().position(|column| column.title == "Improvement").filter(|column| *column > 1);
    if let Some(last) = summing {
        let keep = |column: usize| column == 0 || column == last || column + 1 == last;
        table.columns = kept(&main.columns, keep);
        table.rows.iter_mut().for_each(|row| row.cells = kept(&row.cells, keep));
    }
    table.rows.truncate(ROWS);
    let id = format!("{}-table-{}", chapter.slug, main.name);
    html! {
        h3 id={ (id) "-brief" } { (main.title) }
        div.scroll tabindex="0" role="region" aria-labelledby={ (id) "-brief" } {
            table {
                thead { tr { @for column in &table.columns { (heading(column)) } } }
                tbody { (rows(&table)) }
            }
        }
        p.made { a href={ "#" (id) } { (whole(main, &table)) } }
    }
}

fn kept<T: Clone>(of: &[T], keep: impl Fn(usize) -> bool) -> Vec<T> {
    of.iter().enumerate().filter(|(index, _)| keep(*index)).map(|(_, item)| item.clone()).collect()
}

fn whole(main: &Table, shown: &Table) -> String {
    match main.rows.len() - shown.rows.len() {
        0 => "The whole table, and what its numbers are".into(),
        more => format!("The whole table ({} more), and what its numbers are", count(more, "row")),
    }
}
