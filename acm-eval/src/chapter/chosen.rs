//! Table of an input selection: every set that was tried.

use acm_train::run::evaluation::summary::display;
use acm_train::schedule::study::record::{Runs, StudyRecord};
use acm_train::schedule::study::steps::{Step, bases, steps};
use maud::{Markup, html};

use crate::{
    tables::{Cell, Column, Row, Table},
    unit::total_name,
};

/// Returns the sets of inputs of each base, one per row, in the order in which they were tried. `None` without runs.
pub fn table(study: &StudyRecord, runs: &[Runs]) -> Option<Table> {
    let first = runs.iter().find_map(|run| run.records.first())?;
    let shown = display(&first.data.unit, runs.iter().flat_map(|run| run.records).map(|record| &record.validation));
    let all: Vec<(&str, Vec<Step>)> = bases(study).into_iter().map(|base| (base, steps(base, runs))).collect();
    let folds = all.iter().flat_map(|(_, steps)| steps).map(|step| step.set.errors.0.len()).max().unwrap_or(0);
    let measure = |title: &str| Column::measure(title, &shown);
    let mut columns = vec![Column::text("Model"), Column::text("Inputs")];
    columns.extend((0..folds).map(|fold| measure(&format!("Fold {fold}"))));
    columns.push(measure(total_name(&first.data.unit, first.outputs.len())));
    columns.extend([measure("More than the best"), measure("Standard error"), Column::text("")]);
    let rows = all.iter().flat_map(|(base, steps)| {
        steps.iter().enumerate().map(move |(place, step)| Row {
            cells: cells(base, step, folds),
            opens: place == 0,
            bound: false,
        })
    });
    let made = first.folds.as_ref().map_or("", |folds| folds.made.as_str());
    Some(Table {
        name: "inputs",
        title: "Which inputs".into(),
        note: format!(
            "Backward elimination: all inputs, then without each group of them (a signal with its rates), and on without the \
             group whose absence errs least. Root mean square error in cross-validation, {made}; no held-out trial was read. \
             Differences to the best set are over folds, with the standard error of their mean. Of the sets within one \
             standard error of the best, the one with the fewest inputs is chosen."
        ),
        columns,
        rows: rows.collect(),
        folded: false,
    })
}

fn cells(base: &str, step: &Step, folds: usize) -> Vec<Cell> {
    let mark = match (step.chosen, step.as_good) {
        (true, _) => "chosen",
        (false, true) => "as good",
        (false, false) => "",
    };
    let fold = |fold: usize| step.set.errors.0.get(fold).map_or(Cell::Empty, |error| Cell::number(*error));
    let (more, se) = step.more;
    [Cell::Text(base.into()), Cell::Text(step.set.inputs.join(" "))]
        .into_iter()
        .chain((0..folds).map(fold))
        .chain([Cell::number(step.set.mean()), Cell::number(more), se.map_or(Cell::Empty, Cell::number)])
        .chain([Cell::Text(mark.into())])
        .collect()
}

/// Names the chosen settings, in a sentence for each base.
pub fn lead(study: &StudyRecord, runs: &[Runs]) -> Markup {
    let chosen = |base: &str| steps(base, runs).into_iter().find(|step| step.chosen);
    html! {
        @for base in bases(study) {
            @if let Some(step) = chosen(base) {
                p.lead { "Inputs of " (base) ": " b { (step.set.inputs.join(", ")) } "." }
            }
        }
    }
}
