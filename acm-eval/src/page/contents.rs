//! Contents: a line for each chapter with its answer, and links to its tables and figures.

use acm_train::run::evaluation::summary::count;
use maud::{Markup, html};

use super::{FirstScreen, badge};
use crate::{chapter::Chapter, report::Report};

/// Writes the list; where there is but one chapter, its tables and figures alone.
pub fn show(report: &Report, first: Option<&FirstScreen>) -> Markup {
    // One mark at the top says it of all, where all are alike.
    let mixed = report
        .chapters
        .iter()
        .any(|chapter| first.is_some_and(|first| chapter.data.synthetic != first.chapter.data.synthetic));
    html! {
        nav aria-label="Contents" {
            h2 { "Contents" }
            @if let [chapter] = report.chapters.as_slice() {
                (list(chapter))
            } @else {
                ol {
                    @for chapter in &report.chapters {
                        li {
                            a href={ "#" (chapter.slug) } { (chapter.title) }
                            @if mixed { (badge(&chapter.data)) }
                            (answer(chapter))
                            (links(chapter))
                        }
                    }
                }
            }
        }
    }
}

/// Writes the answer of a chapter, or its question.
fn answer(chapter: &Chapter) -> Markup {
    html! {
        @if chapter.lead.0.is_empty() {
            @for (_, question) in chapter.questions.iter().take(1) { p { (question) } }
        } @else {
            (chapter.lead)
        }
    }
}

fn links(chapter: &Chapter) -> Markup {
    html! {
        details {
            summary { (count(chapter.figures.len(), "figure")) ", " (count(chapter.tables.len(), "table")) }
            (list(chapter))
        }
    }
}

fn list(chapter: &Chapter) -> Markup {
    html! {
        ul {
            @for shown in &chapter.figures {
                li { a href={ "#" (chapter.slug) "-" (shown.name) } { (shown.question) } }
            }
            @for table in &chapter.tables {
                li { a href={ "#" (chapter.slug) "-table-" (table.name) } { (table.title) } }
            }
        }
    }
}
