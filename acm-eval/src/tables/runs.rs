//! Table of the runs, one row each.

use super::{Cell, Column, Row, Table};
use crate::{run::Run, section::Section, spread::Spread};

/// Returns the table with runs in rows, as given.
pub fn table(section: &Section) -> Option<Table> {
    let columns = vec![
        Column::text("Run"),
        Column::text("Network"),
        Column::number("Parameters", "", 0),
        Column::number("Window", "samples", 0),
        Column::text("Inputs"),
        Column::text("Seeds"),
        Column::number("Folds", "", 0),
        Column::number("Kept epoch", "", 1),
        Column::number("Training", "s", 1),
    ];
    Some(Table {
        name: "runs",
        title: "Runs".into(),
        note: "Kept epoch: the one with the smallest validation loss, mean ± sd over the run’s records. Training: \
               wall-clock time of one record; it depends on the machine."
            .into(),
        columns,
        rows: section.runs.iter().map(row).collect(),
        folded: false,
    })
}

fn row(run: &Run) -> Row {
    let first = &run.records[0];
    let seeds: Vec<String> = run.finals().map(|(record, _)| record.seed.to_string()).collect();
    let over = |value: fn(&acm_train::run::record::RunRecord) -> f64| {
        Cell::of(Spread::of(&run.records.iter().map(value).collect::<Vec<_>>()))
    };
    let cells = vec![
        Cell::Text(run.name.clone()),
        Cell::Text(run.kind()),
        Cell::Count(first.parameters),
        Cell::Count(first.experiment.windows.length),
        Cell::Text(first.channels.join(", ")),
        Cell::Text(if seeds.is_empty() { "–".into() } else { seeds.join(", ") }),
        Cell::Count(run.folds().count()),
        over(|record| record.best_epoch as f64),
        over(|record| record.seconds),
    ];
    Row { cells, ..Row::default() }
}
