//! Error on each held-out trial by itself: an average can hide a trial on which learning does harm.

use acm_train::record::Score;

use super::{Cell, Column, Row, Table};
use crate::{estimator::Estimator, section::Section, unit::total_name};

/// Rows: trial by trial, each estimator. `None` for a single trial, which the main table shows.
pub fn table(section: &Section) -> Option<Table> {
    let trials = section.held_out_trials();
    let unit = &section.display.symbol;
    let mut columns = vec![Column::text("Trial"), Column::text("Model"), Column::number("Samples", "", 0)];
    columns.extend(section.outputs.iter().map(|output| Column::number(output, unit, 2)));
    columns.push(Column::number(total_name(section.outputs.len()), unit, 2));
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

fn row(section: &Section, estimator: &Estimator, trial: &str) -> Option<Row> {
    let scores: Vec<&Score> = section.on_trial(estimator, trial).collect();
    let samples = scores.first()?.samples;
    let spread = |values: Vec<f64>| Cell::of(estimator.spread(&values));
    let shown = |value: f64| value * section.display.factor;
    let mut cells = vec![Cell::Text(trial.into()), Cell::Text(estimator.label.clone()), Cell::Count(samples)];
    cells.extend((0..section.outputs.len()).map(|o| spread(scores.iter().map(|score| shown(score.rmse[o])).collect())));
    cells.push(spread(scores.iter().map(|score| shown(score.rmse_total)).collect()));
    cells.push(if estimator.key == "nominal" {
        Cell::Empty
    } else {
        spread(section.improvements(estimator, |part| part.trials.get(trial)))
    });
    Some(Row { cells, ..Row::default() })
}
