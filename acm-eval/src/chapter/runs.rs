//! Runs on one data set as a chapter.

use maud::{Markup, html};

use super::{Chapter, Shown};
use crate::{
    figures,
    provenance::provenance,
    section::Section,
    spread::Spread,
    tables::{self, Cell, Digits, fixed},
    unit::total_name,
};

/// Every table and figure that the records carry.
pub fn of_section(section: &Section, slug: String) -> Chapter {
    let shown = |figure: &figures::Figure| {
        let drawing = (figure.draw)(section)?;
        Some(Shown { name: figure.name, question: figure.question.into(), drawing })
    };
    let tables: Vec<tables::Table> = tables::ALL.iter().filter_map(|make| make(section)).collect();
    let scored = tables.iter().find(|table| matches!(table.name, "errors" | "folds"));
    Chapter {
        slug,
        title: section.data.title.clone(),
        data: section.data.clone(),
        lead: headline(section),
        notes: vec![],
        questions: questions(section),
        main: scored.map_or("", |table| table.name),
        tables,
        figures: figures::ALL.iter().filter_map(shown).collect(),
        provenance: provenance(&section.runs),
    }
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
fn questions(section: &Section) -> Vec<(String, String)> {
    let mut asked: Vec<(&str, Vec<&str>)> = Vec::new();
    for run in &section.runs {
        let question = run.records[0].experiment.question.as_str();
        match asked.iter_mut().find(|(known, _)| *known == question) {
            Some((_, runs)) => runs.push(&run.name),
            None => asked.push((question, vec![&run.name])),
        }
    }
    asked.into_iter().map(|(question, runs)| (runs.join(", "), question.to_string())).collect()
}
