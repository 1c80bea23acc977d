//! Building blocks of the pages: head, headings with the mark of synthetic data, figures and tables.

use acm_trace::finding::Data;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::beside::{figure_files, numbers_file, table_file};
use crate::figures::Drawing;
use crate::figures::canvas::dark;
use crate::page::{answers, files};

const STYLE: &str = concat!(include_str!("../../style.css"), include_str!("style.css"));

/// Returns a whole page around its body.
pub fn document(title: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) (PreEscaped(answers::STYLE)) (PreEscaped(dark::rules())) }
            }
            body { (body) (answers::script()) }
        }
    };
    page.into_string()
}

/// Writes the mark of simulated data.
pub fn banner(data: &Data) -> Markup {
    html! {
        @if data.synthetic {
            p.synthetic role="note" {
                strong { "Synthetic data." }
                " A simulator made the data set " (data.name) ". Every number and figure of this page describes the \
                simulator, not a robot, and must not stand beside measured results as if it were the same data."
            }
        }
    }
}

/// Writes a small mark of the origin of the data.
pub fn badge(data: &Data) -> Markup {
    html! { @if data.synthetic { " " span.badge { "synthetic data" } } }
}

/// Writes the heading of a section.
pub fn heading(id: &str, title: &str, data: &Data) -> Markup {
    html! { h2 id=(id) { (title) (badge(data)) } }
}

/// Writes a figure with its question above and how to read it below. Wide figures are shown in full size, and scroll.
pub fn figure(id: &str, question: &str, drawing: &Drawing, data: &Data) -> Markup {
    let width = drawing.width();
    let numbers = drawing.has_numbers().then(|| numbers_file(id));
    let kinds: Vec<String> = figure_files(id).into_iter().chain(numbers).collect();
    let (least, most) = (if width > 920.0 { width } else { width.min(736.0) }, 1.1 * width);
    html! {
        figure id=(id) {
            h3 { (question) (badge(data)) }
            div.card tabindex="0" {
                div.sheet style={ "min-width:" (least) "px;max-width:" (most) "px" } {
                    (PreEscaped(drawing.svg(&format!("{id}-svg"), question, &data.name)))
                }
            }
            (answers::plotted(id, &data.name, drawing))
            figcaption {
                @for (index, line) in drawing.explanation.lines().enumerate() {
                    p { @if index == 0 { b { "How to read it. " } } @else { b { "What to look for. " } } (line) }
                }
                (files(&kinds))
            }
        }
    }
}

/// A column: its heading, and whether it holds words.
pub type Column<'a> = (&'a str, bool);

/// Writes a table that scrolls where it is too wide, with a link to the file `name` that has all digits. The first cell
/// of a row names it.
pub fn table(name: &str, label: &str, columns: &[Column], rows: &[Vec<Markup>]) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label=(label) {
            table {
                thead { tr { @for (title, text) in columns { th.text[*text] scope="col" { (title) } } } }
                tbody {
                    @for row in rows {
                        tr {
                            @for (index, (cell, (_, text))) in row.iter().zip(columns).enumerate() {
                                @if index == 0 { th.text scope="row" { (cell) } } @else { td.text[*text] { (cell) } }
                            }
                        }
                    }
                }
            }
        }
        (files(&[table_file(name)]))
    }
}

/// Writes a term and its meaning, in a list of terms.
pub fn entry(term: &str, meaning: &Markup) -> Markup {
    html! { dt { (term) } dd { (meaning) } }
}

/// Writes a collapsible block.
pub fn folded(title: &str, body: &Markup) -> Markup {
    html! { details { summary { h3 { (title) } } (body) } }
}

/// Writes words as a cell.
pub fn cell(words: impl AsRef<str>) -> Markup {
    html! { (words.as_ref()) }
}

/// Writes a name from the data as a cell: it may be long, and wraps.
pub fn named(name: &str) -> Markup {
    html! { @if name.chars().count() > 32 { span.wrap { (name) } } @else { (name) } }
}
