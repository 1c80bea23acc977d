//! Runs on one data set as a chapter.

use maud::{Markup, html};

use acm_train::run::evaluation::summary::names_of_trials;
use acm_train::run::evaluation::verdict;
use acm_train::run::record::RunRecord;
use acm_train::schedule::study::record::Runs;

use super::{Chapter, Shown, chosen};
use crate::figures;
use crate::page::provenance::provenance;
use crate::run::{Run, missing};
use crate::section::Section;
use crate::spread::Spread;
use crate::tables::{self, fixed};
use crate::unit::subject;

/// Returns a chapter with every table and figure that the records have the data for.
pub fn of_section(section: &Section, slug: String) -> Chapter {
    let shown = |figure: &figures::Figure| {
        let drawing = (figure.draw)(section)?;
        Some(Shown { name: figure.name, question: figure.question.into(), drawing })
    };
    let mut tables: Vec<tables::Table> = tables::ALL.iter().filter_map(|make| make(section)).collect();
    tables.extend(choices(&section.runs));
    let scored = tables.iter().find(|table| matches!(table.name, "errors" | "folds"));
    let missing: Vec<String> = section.runs.iter().filter_map(missing::sentence).collect();
    Chapter {
        slug,
        title: section.data.title.clone(),
        data: section.data.clone(),
        lead: html! { (headline(section)) (super::missing(&missing)) },
        missing,
        notes: verdicts(section).into_iter().chain(protocol(section)).collect(),
        questions: questions(section),
        main: scored.map_or("", |table| table.name),
        tables,
        figures: figures::ALL.iter().filter_map(shown).collect(),
        provenance: provenance(&section.runs),
    }
}

/// Describes how the inputs of the runs were chosen, one run below the other.
fn choices(runs: &[Run]) -> Option<tables::Table> {
    let all = runs.iter().filter_map(choice);
    all.reduce(|mut table, other| {
        let alike = table.columns.len() == other.columns.len();
        table.rows.extend(other.rows.into_iter().filter(|_| alike));
        table
    })
}

fn choice(run: &Run) -> Option<tables::Table> {
    let (study, records) = run.choice.as_ref()?;
    let of = |(member, records)| {
        let records: &Vec<RunRecord> = records;
        Runs { member, records }
    };
    let runs: Vec<Runs> = study.members.iter().zip(records).map(of).collect();
    let mut table = chosen::table(study, &runs)?;
    table.rows.iter_mut().for_each(|row| row.cells[0] = tables::Cell::Text(run.name.clone()));
    Some(table)
}

/// Describes folds and inputs of each run, and inputs that a network could use to identify a trial.
fn protocol(section: &Section) -> Vec<String> {
    let first = |run: &Run| {
        let record = &run.records[0];
        let made = record.folds.as_ref().map_or(String::new(), |folds| format!("folds: {}; ", folds.made));
        let names = names_of_trials(record).map_or(String::new(), |sentence| format!("; {sentence}"));
        format!("{made}inputs: {}{names}", record.channels.join(", "))
    };
    section.runs.iter().map(|run| format!("{}: {}.", run.name, first(run))).collect()
}

/// Writes the result in a sentence: the network with the smallest held-out error against the nominal model.
fn headline(section: &Section) -> Markup {
    let total = |estimator| {
        Spread::of_constant(&section.held_out(estimator).map(|score| score.rmse_total).collect::<Vec<f64>>())
    };
    let networks = section.networks().filter_map(|network| Some((network, total(network)?)));
    let best = networks.min_by(|a, b| a.1.mean.total_cmp(&b.1.mean));
    let Some((best, error)) = best else {
        return html! { p.lead { "No run has been scored on held-out trials yet." } };
    };
    let nominal = section.estimators.iter().find(|e| e.key == "nominal").and_then(total);
    let gains: Vec<f64> =
        section.improvements(best, |part| Some(&part.estimators)).into_iter().map(|(_, gain)| gain).collect();
    let gone = Spread::of(&gains);
    let show = |spread: Spread| section.display.with_symbol(&spread.text(section.display.factor));
    html! {
        p.lead {
            "On trials that took no part in learning, the "
            @if let Some(nominal) = nominal { "nominal model misses the " (subject(&section.data.unit)) " by " (show(nominal)) "; with " }
            (best.label) @if nominal.is_some() { " it is " } @else { " misses by " }
            b { (show(error)) }
            @match gone.map(|gone| gone.mean) {
                Some(gone) if gone >= 0.0 => { ": " (fixed(gone, 0)) "\u{a0}% of the error is gone" }
                Some(grown) => { ": learning made it worse by " (fixed(-grown, 0)) "\u{a0}%" }
                None => {}
            }
            " (" (section.total()) " RMSE)."
        }
    }
}

/// Returns the verdicts by run.
fn verdicts(section: &Section) -> Vec<String> {
    let of_run = |run: &Run| {
        let records: Vec<&RunRecord> = run.records.iter().collect();
        Some(format!("Verdict on {}: {}", run.name, verdict::of(&records)?.sentence(&records)))
    };
    section.runs.iter().filter_map(of_run).collect()
}

/// Returns the questions of the runs.
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
