//! Error on each held-out trial.

use acm_train::run::record::PartScores;

use super::{Cell, Column, Row, Table, errors::errors};
use crate::section::Section;
use crate::section::estimator::Estimator;

/// Returns the table with each estimator trial by trial in rows. `None` for a single trial, which the main table shows.
pub fn table(section: &Section) -> Option<Table> {
    let trials = section.held_out_trials();
    let mut columns = vec![Column::text("Trial"), Column::text("Model"), Column::number("Samples", "", 0)];
    columns.extend(section.outputs.iter().map(|output| Column::measure(output, &section.display)));
    columns.push(Column::measure(section.total(), &section.display));
    columns.push(Column::number("Improvement", "%", 1));
    let mut table = Table {
        name: "trials",
        title: "Error on each held-out trial".into(),
        note: "As in the first table, trial by trial. A negative improvement: learning does harm there.".into(),
        columns,
        rows: vec![],
        folded: trials.len() > 6,
    };
    for trial in &trials {
        add_trial(&mut table, section, trial);
    }
    (trials.len() > 1).then_some(table)
}

fn add_trial(table: &mut Table, section: &Section, trial: &str) {
    let first = table.rows.len();
    for estimator in &section.estimators {
        if let Some(mut row) = row(section, estimator, trial) {
            row.opens = table.rows.len() == first;
            table.rows.push(row);
        }
    }
    for column in 3..table.columns.len() {
        table.mark_best(column, column == table.columns.len() - 1, first..table.rows.len());
    }
}

fn row<'a>(section: &'a Section, estimator: &'a Estimator, trial: &'a str) -> Option<Row> {
    let pick = |part: &'a PartScores| part.trials.get(trial);
    let samples = section.scores(estimator, pick).next()?.1.samples;
    let head = [Cell::Text(trial.into()), Cell::Text(estimator.label.clone()), Cell::Count(samples)];
    let cells = head.into_iter().chain(errors(section, estimator, pick)?).collect();
    Some(Row { cells, ..Row::default() })
}
