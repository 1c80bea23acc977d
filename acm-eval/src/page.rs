//! The page: one HTML file that needs nothing else, in light, dark and print.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::{
    provenance::provenance,
    report::{Chapter, Report},
    section::Section,
    spread::Spread,
    tables::{Cell, Column, Digits, Row, Table, fixed},
    unit::total_name,
};

const STYLE: &str = include_str!("style.css");

/// The whole page.
pub fn html(report: &Report) -> String {
    let names: Vec<&str> = report.chapters.iter().map(|chapter| chapter.section.data.name.as_str()).collect();
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

/// Links to the data sets, with a word on why they stand apart.
fn contents(report: &Report) -> Markup {
    html! {
        nav {
            p { "The runs are on different data, so each data set has a section and tables of its own:" }
            ul {
                @for chapter in &report.chapters {
                    li { a href={ "#" (chapter.slug) } { (chapter.section.data.title) } (badge(&chapter.section)) }
                }
            }
        }
    }
}

fn section(chapter: &Chapter, report: &Report) -> Markup {
    let Chapter { section, slug, tables, figures } = chapter;
    let (first, rest): (Vec<&Table>, Vec<&Table>) = tables.iter().partition(|table| table.name == "errors");
    html! {
        section id=(slug) {
            h2 { (section.data.title) }
            @if section.data.synthetic { (banner(section)) }
            (headline(section))
            (questions(section))
            @for shown in first { (table(shown, chapter)) }
            @for (figure, drawing) in figures {
                @let id = format!("{slug}-{}", figure.name);
                figure id=(id) {
                    h3 { (figure.question) (badge(section)) }
                    div.card tabindex="0" {
                        @let (least, most) = (drawing.width().min(736.0), 1.1 * drawing.width());
                        div.sheet style={ "min-width:" (least) "px;max-width:" (most) "px" } {
                            (PreEscaped(drawing.svg(&id, figure.question, &report.command)))
                        }
                    }
                    figcaption {
                        p { (drawing.explanation) }
                        p.made { code { (report.command) } " → figures/" (id) ".svg, .png" }
                    }
                }
            }
            @for shown in rest { (table(shown, chapter)) }
            (provenance(section))
        }
    }
}

/// The mark that no reader can miss.
fn banner(section: &Section) -> Markup {
    html! {
        p.synthetic role="note" {
            strong { "Synthetic data." }
            " A simulator made the data set " (section.data.name) ". Every number and figure of this section describes the \
            simulator, not a robot, and must not stand beside measured results as if it were the same data."
        }
    }
}

/// The same mark, small.
pub fn badge(section: &Section) -> Markup {
    html! { @if section.data.synthetic { " " span.badge { "synthetic data" } } }
}

/// The result in a sentence: the network with the smallest held-out error against the nominal model.
fn headline(section: &Section) -> Markup {
    let total = |estimator| {
        let errors: Vec<f64> = section.held_out(estimator).map(|s| s.rmse_total * section.display.factor).collect();
        Spread::of_constant(&errors)
    };
    let networks = section.networks().filter_map(|network| Some((network, total(network)?)));
    let best = networks.min_by(|a, b| a.1.mean.total_cmp(&b.1.mean));
    let Some((best, error)) = best else {
        return html! { p.lead { "No run has been scored on held-out trials yet." } };
    };
    let nominal = section.estimators.iter().find(|e| e.key == "nominal").and_then(total);
    let gone = Spread::of(&section.improvements(best, |part| Some(&part.estimators)));
    let show = |spread: Spread, decimals| Cell::Number(spread).show(Digits::Fixed(decimals));
    let unit = &section.display.symbol;
    html! {
        p.lead {
            "On trials that took no part in learning, the "
            @if let Some(nominal) = nominal { "nominal model misses the tip by " (show(nominal, 1)) "\u{a0}" (unit) "; with " }
            (best.label) @if nominal.is_some() { " it is " } @else { " misses by " }
            b { (show(error, 1)) "\u{a0}" (unit) }
            @match gone.map(|gone| gone.mean) {
                Some(gone) if gone >= 0.0 => { ": " (fixed(gone, 0)) "\u{a0}% of the error is gone" }
                Some(grown) => { ": learning made it worse by " (fixed(-grown, 0)) "\u{a0}%" }
                None => {}
            }
            " (" (total_name(section.outputs.len())) " RMSE)."
        }
    }
}

/// What was asked, by which runs.
fn questions(section: &Section) -> Markup {
    let mut asked: Vec<(&str, Vec<&str>)> = Vec::new();
    for run in &section.runs {
        let question = run.records[0].experiment.question.as_str();
        match asked.iter_mut().find(|(known, _)| *known == question) {
            Some((_, runs)) => runs.push(&run.name),
            None => asked.push((question, vec![&run.name])),
        }
    }
    html! {
        ul.questions {
            @for (question, runs) in &asked { li { code { (runs.join(", ")) } " " (question) } }
        }
    }
}

fn table(table: &Table, chapter: &Chapter) -> Markup {
    let id = format!("{}-table-{}", chapter.slug, table.name);
    let body = html! {
        p.note { (table.note) }
        div.scroll tabindex="0" role="region" aria-labelledby=(id) {
            table {
                thead { tr { @for column in &table.columns { (heading(column)) } } }
                tbody { @for row in &table.rows { (cells(row, table)) } }
            }
        }
        p.made { "tables/" (chapter.slug) "-" (table.name) ".csv" }
    };
    let title = html! { (table.title) (badge(&chapter.section)) };
    html! {
        @if table.folded {
            details { summary { h3 id=(id) { (title) } } (body) }
        } @else {
            h3 id=(id) { (title) }
            (body)
        }
    }
}

fn heading(column: &Column) -> Markup {
    html! {
        th.text[column.text] scope="col" {
            (column.title)
            @if !column.unit.is_empty() { " " span.unit { "[" (column.unit) "]" } }
        }
    }
}

fn cells(row: &Row, table: &Table) -> Markup {
    html! {
        tr.opens[row.opens].bound[row.bound] {
            @for (index, (cell, column)) in row.cells.iter().zip(&table.columns).enumerate() {
                @let shown = cell.show(column.digits);
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
