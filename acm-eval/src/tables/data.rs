//! Table of the trials: role, used samples, and dropped samples by reason.

use std::collections::BTreeSet;

use acm_train::run::record::TrialStamp;

use super::{Cell, Column, Row, Table};
use crate::section::{Section, natural};

/// Returns the table with trials by role in rows, then a sum.
pub fn table(section: &Section) -> Option<Table> {
    let trials = &section.data.trials;
    let reasons: BTreeSet<&String> = trials.values().flat_map(|trial| trial.dropped.keys()).collect();
    let mut columns = vec![Column::text("Trial"), Column::text("Role"), Column::number("Samples used", "", 0)];
    columns.extend(reasons.iter().map(|reason| Column::number(format!("Dropped: {}", words(reason)), "", 0)));
    let mut names: Vec<&String> = trials.keys().collect();
    names.sort_by_key(|name| (role_order(&trials[*name].role), natural(name)));
    let mut rows: Vec<Row> = names.iter().map(|name| row(name, &trials[*name], &reasons)).collect();
    rows.push(sum(trials.values(), &reasons));
    (rows.len() > 1).then(|| Table {
        name: "data",
        title: "Trials and samples".into(),
        note: "Samples that were read and not used are counted by reason.".into(),
        columns,
        rows,
        folded: true,
    })
}

fn row(name: &str, trial: &TrialStamp, reasons: &BTreeSet<&String>) -> Row {
    let mut cells = vec![Cell::Text(name.into()), Cell::Text(words(&trial.role)), Cell::Count(trial.samples)];
    cells.extend(reasons.iter().map(|&reason| Cell::Count(trial.dropped.get(reason).copied().unwrap_or(0))));
    Row { cells, ..Row::default() }
}

fn sum<'a>(trials: impl Iterator<Item = &'a TrialStamp> + Clone, reasons: &BTreeSet<&String>) -> Row {
    let dropped = |reason: &String| trials.clone().filter_map(|trial| trial.dropped.get(reason)).sum();
    let samples = trials.clone().map(|trial| trial.samples).sum();
    let mut cells = vec![Cell::Text("all".into()), Cell::Empty, Cell::Count(samples)];
    cells.extend(reasons.iter().map(|&reason| Cell::Count(dropped(reason))));
    Row { cells, opens: true, ..Row::default() }
}

fn role_order(role: &str) -> usize {
    ["calibration", "development", "held_out"].iter().position(|known| *known == role).unwrap_or(3)
}

fn words(snake: &str) -> String {
    snake.replace('_', " ")
}
