//! Origin of the page: data sets with licence and hash, and commands that reproduce the numbers.

use acm_train::run::record::DataStamp;
use maud::{Markup, html};

use super::badge;
use crate::report::Report;

/// Writes the end of the page.
pub fn show(report: &Report) -> Markup {
    html! {
        section id="provenance" {
            h2 { "Provenance" }
            dl { @for data in sets(report) { dt { (data.name) (badge(data)) } dd { (of(data)) } } }
            @for chapter in &report.chapters {
                @if report.chapters.len() > 1 { h3 { (chapter.title) } }
                dl { @for (term, meaning) in &chapter.provenance { dt { (term) } dd { (meaning) } } }
            }
        }
        footer { p { "Made from run records by " code { (report.command) } "." } }
    }
}

/// Returns the data sets, each once.
fn sets(report: &Report) -> Vec<&DataStamp> {
    let mut sets: Vec<&DataStamp> = vec![];
    for chapter in &report.chapters {
        if !sets.iter().any(|known| known.hash == chapter.data.hash) {
            sets.push(&chapter.data);
        }
    }
    sets
}

fn of(data: &DataStamp) -> Markup {
    html! {
        (data.title) "; "
        @if !data.licence.is_empty() { (data.licence) "; " }
        (data.source) ". SHA-256 " code.hash { (data.hash) }
    }
}
