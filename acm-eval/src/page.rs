//! The page: one HTML file that needs nothing else, in light, dark and print.

pub mod answers;
mod contents;
mod first_screen;
mod origin;
pub(crate) mod provenance;

use acm_train::run::record::DataStamp;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::chapter::{Chapter, Shown};
use crate::figures::canvas::dark;
use crate::report::Report;
use crate::tables::{Cell, Column, Row, Table, grouped};
use first_screen::FirstScreen;

const STYLE: &str = include_str!("style.css");

/// Returns the whole page: the answer, contents, chapters, and at the end the origin of the data.
pub fn html(report: &Report) -> String {
    let names: Vec<&str> = report.chapters.iter().map(|chapter| chapter.title.as_str()).collect();
    let first = FirstScreen::of(report);
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (names.join(", ")) " – report" }
                style { (PreEscaped(STYLE)) (PreEscaped(answers::STYLE)) (PreEscaped(dark::rules())) }
            }
            body {
                @if let Some(first) = &first { (first.show()) }
                (contents::show(report, first.as_ref()))
                @for chapter in &report.chapters { (section(chapter, first.as_ref())) }
                (origin::show(report))
                (answers::script())
            }
        }
    };
    page.into_string()
}

fn section(chapter: &Chapter, first: Option<&FirstScreen>) -> Markup {
    let main = |table: &&Table| table.name == chapter.main;
    let (main, rest): (Vec<&Table>, Vec<&Table>) = chapter.tables.iter().partition(main);
    let is_first = first.is_some_and(|first| first.chapter.slug == chapter.slug);
    let above = first.and_then(|first| first.figure).filter(|_| is_first);
    let below = chapter.figures.iter().filter(|shown| above.is_none_or(|above| above.name != shown.name));
    html! {
        section id=(chapter.slug) {
            h2 { @if is_first { "All tables and figures" } @else { (chapter.title) } }
            @if chapter.data.synthetic { (banner(&chapter.data)) }
            @if !is_first { (chapter.lead) }
            @if !is_first { @for note in &chapter.notes { p { (note) } } }
            (questions(chapter))
            @for shown in main { (table(shown, chapter)) }
            @if let Some(above) = above {
                p.note { a href={ "#" (chapter.slug) "-" (above.name) } { (above.question) } " stands at the top of the page." }
            }
            @for shown in below { (figure(shown, chapter)) }
            @for shown in rest { (table(shown, chapter)) }
        }
    }
}

/// Writes the questions: a list where there are several.
fn questions(chapter: &Chapter) -> Markup {
    html! {
        @if let [(who, question)] = chapter.questions.as_slice() && who.is_empty() {
            p { (question) }
        } @else {
            ul.questions { @for (who, question) in &chapter.questions { li { code { (who) } " " (question) } } }
        }
    }
}

fn figure(shown: &Shown, chapter: &Chapter) -> Markup {
    html! {
        figure id={ (chapter.slug) "-" (shown.name) } {
            h3 { (shown.question) (badge(&chapter.data)) }
            (sheet(shown, chapter))
            figcaption {
                p { (shown.drawing.explanation) }
                (figure_files(shown, chapter))
            }
        }
    }
}

/// Writes the drawing, which scrolls where the window is too narrow for its words.
fn sheet(shown: &Shown, chapter: &Chapter) -> Markup {
    let Shown { name, question, drawing } = shown;
    let (least, most) = (drawing.width().min(736.0), 1.1 * drawing.width());
    html! {
        div.card tabindex="0" {
            div.sheet style={ "min-width:" (least) "px;max-width:" (most) "px" } {
                (PreEscaped(drawing.svg(&format!("{}-{name}", chapter.slug), question, &chapter.data.name)))
            }
        }
        (answers::plotted(&format!("{}-{name}", chapter.slug), &chapter.data.hash, drawing))
    }
}

fn figure_files(shown: &Shown, chapter: &Chapter) -> Markup {
    let name = format!("{}-{}", chapter.slug, shown.name);
    let numbers = shown.drawing.has_numbers().then_some("csv");
    let kinds = ["svg", "png"].into_iter().chain(numbers);
    html! { (files(&kinds.map(|kind| format!("figures/{name}.{kind}")).collect::<Vec<_>>())) }
}

/// Writes links to files beside the page.
pub fn files(paths: &[String]) -> Markup {
    html! {
        p.made {
            @for (index, path) in paths.iter().enumerate() { @if index > 0 { " · " } a href=(path) { (path) } }
        }
    }
}

/// Writes the mark of simulated data.
fn banner(data: &DataStamp) -> Markup {
    html! {
        p.synthetic role="note" {
            strong { "Synthetic data." }
            " A simulator made the data set " (data.name) ". Every number and figure of this section describes the \
            simulator, not a robot, and must not stand beside measured results as if it were the same data."
        }
    }
}

/// Writes the mark of simulated data, small.
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
        (table_files(table, chapter))
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

fn table_files(table: &Table, chapter: &Chapter) -> Markup {
    let name = format!("{}-{}", chapter.slug, table.name);
    let file = format!("tables/{name}.csv");
    html! {
        (files(&[file.clone(), format!("tables/{name}.tex")]))
        (answers::csv(&file, &table.csv()))
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
