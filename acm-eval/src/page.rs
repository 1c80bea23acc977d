//! The page: one HTML file that needs nothing else, in light, dark and print.

use acm_train::{record::DataStamp, summary::count};
use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::{
    chapter::{Chapter, Shown},
    report::Report,
    tables::{Cell, Column, Row, Table, grouped},
};

const STYLE: &str = include_str!("style.css");

/// The whole page.
pub fn html(report: &Report) -> String {
    let names: Vec<&str> = report.chapters.iter().map(|chapter| chapter.title.as_str()).collect();
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Tip error report: " (names.join(", ")) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { "Where the tip really goes" }
                    p.lead { "What the nominal model misses, and how much of it each network learned." }
                    (sources(report))
                }
                @if report.chapters.len() > 1 { (contents(report)) }
                @for chapter in &report.chapters { (section(chapter, report)) }
                footer {
                    p { "Made from run records by " code { (report.command) } "." }
                }
            }
        }
    };
    page.into_string()
}

/// The data sets, each once.
fn sources(report: &Report) -> Markup {
    let mut sets: Vec<&DataStamp> = vec![];
    for chapter in &report.chapters {
        if !sets.iter().any(|known| known.hash == chapter.data.hash) {
            sets.push(&chapter.data);
        }
    }
    html! {
        dl {
            @for data in sets {
                dt { (data.name) (badge(data)) }
                dd {
                    (data.title) "; " (data.licence) "; " (data.source) ". SHA-256 " code.hash { (data.hash) }
                }
            }
        }
    }
}

/// Links to the chapters, and in each to its tables and figures.
fn contents(report: &Report) -> Markup {
    html! {
        nav aria-label="Contents" {
            ol {
                @for chapter in &report.chapters {
                    li {
                        a href={ "#" (chapter.slug) } { (chapter.title) } (badge(&chapter.data))
                        details {
                            summary { (count(chapter.figures.len(), "figure")) ", " (count(chapter.tables.len(), "table")) }
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
                }
            }
        }
    }
}

fn section(chapter: &Chapter, report: &Report) -> Markup {
    let main = |table: &&Table| table.name == chapter.main;
    let (first, rest): (Vec<&Table>, Vec<&Table>) = chapter.tables.iter().partition(main);
    html! {
        section id=(chapter.slug) {
            h2 { (chapter.title) }
            @if chapter.data.synthetic { (banner(&chapter.data)) }
            (chapter.lead)
            (questions(chapter))
            @for shown in first { (table(shown, chapter)) }
            @for shown in &chapter.figures { (figure(shown, chapter, report)) }
            @for shown in rest { (table(shown, chapter)) }
            h3 { "Provenance" }
            dl { @for (term, meaning) in &chapter.provenance { dt { (term) } dd { (meaning) } } }
        }
    }
}

/// What was asked: a list where several asked.
fn questions(chapter: &Chapter) -> Markup {
    html! {
        @if let [(who, question)] = chapter.questions.as_slice() && who.is_empty() {
            p { (question) }
        } @else {
            ul.questions { @for (who, question) in &chapter.questions { li { code { (who) } " " (question) } } }
        }
    }
}

fn figure(shown: &Shown, chapter: &Chapter, report: &Report) -> Markup {
    let Shown { name, question, drawing } = shown;
    let id = format!("{}-{name}", chapter.slug);
    let (least, most) = (drawing.width().min(736.0), 1.1 * drawing.width());
    html! {
        figure id=(id) {
            h3 { (question) (badge(&chapter.data)) }
            div.card tabindex="0" {
                div.sheet style={ "min-width:" (least) "px;max-width:" (most) "px" } {
                    (PreEscaped(drawing.svg(&id, question, &report.command)))
                }
            }
            figcaption {
                p { (drawing.explanation) }
                p.made { code { (report.command) } " → figures/" (id) ".svg, .png" }
            }
        }
    }
}

/// The mark that no reader can miss.
fn banner(data: &DataStamp) -> Markup {
    html! {
        p.synthetic role="note" {
            strong { "Synthetic data." }
            " A simulator made the data set " (data.name) ". Every number and figure of this section describes the \
            simulator, not a robot, and must not stand beside measured results as if it were the same data."
        }
    }
}

/// The same mark, small.
fn badge(data: &DataStamp) -> Markup {
    html! { @if data.synthetic { " " span.badge { "synthetic data" } } }
}

fn table(table: &Table, chapter: &Chapter) -> Markup {
    let id = format!("{}-table-{}", chapter.slug, table.name);
    let body = html! {
        p.note { (table.note) }
        div.scroll tabindex="0" role="region" aria-labelledby=(id) {
            table {
                thead { tr { @for column in &table.columns { (heading(column)) } } }
                tbody { (rows(table)) }
            }
        }
        p.made { "tables/" (chapter.slug) "-" (table.name) ".csv, .tex" }
    };
    let title = html! { (table.title) (badge(&chapter.data)) };
    html! {
        @if table.folded {
            details { summary { h3 id=(id) { (title) } } (body) }
        } @else {
            h3 id=(id) { (title) }
            (body)
        }
    }
}

/// Rows of a table on the page, at most; its CSV has all of them.
const ROWS: usize = 300;

fn rows(table: &Table) -> Markup {
    let (shown, last) = table.rows.split_at(table.rows.len().min(ROWS));
    // A sum at the end is shown in any case.
    let left = last.len() - usize::from(last.last().is_some_and(|row| row.opens));
    html! {
        @for row in shown { (cells(row, table)) }
        @if left > 0 {
            tr.opens {
                th.text scope="row" colspan=(table.columns.len()) { (grouped(left)) " more rows are in the CSV file" }
            }
        }
        @for row in &last[left..] { (cells(row, table)) }
    }
}

fn heading(column: &Column) -> Markup {
    html! {
        th.text[column.text] scope="col" {
            (column.title)
            @let unit = &column.display.symbol;
            @if !unit.is_empty() { " " span.unit { "[" (unit) "]" } }
        }
    }
}

fn cells(row: &Row, table: &Table) -> Markup {
    html! {
        tr.opens[row.opens].bound[row.bound] {
            @for (index, (cell, column)) in row.cells.iter().zip(&table.columns).enumerate() {
                @let shown = column.show(cell);
                @if index == 0 {
                    th.text scope="row" { (shown) }
                } @else if matches!(cell, Cell::Best(_)) {
                    td { b { (shown) } }
                } @else {
                    td.text[column.text] { (shown) }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_of_thousands_is_cut_and_keeps_its_sum() {
        let row = |k: usize| Row { cells: vec![Cell::Text(format!("trial {k}"))], opens: k == 999, ..Row::default() };
        let (name, title, note, folded) = ("data", String::new(), String::new(), true);
        let columns = vec![Column::text("Trial")];
        let mut table = Table { name, title, note, columns, rows: (0..1000).map(row).collect(), folded };
        let page = rows(&table).into_string();
        assert_eq!(page.matches("<tr").count(), ROWS + 2);
        assert!(page.contains("trial 299") && !page.contains("trial 300") && page.contains("trial 999"), "{page}");
        assert!(page.contains("699 more rows"), "{page}");
        table.rows.truncate(ROWS);
        assert!(!rows(&table).into_string().contains("more rows"));
    }
}
