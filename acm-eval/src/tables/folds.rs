//! Cross-validation: the error on each fold's validation trials, and mean ± sd over folds.

use acm_train::run::{
    names::some,
    record::{Score, Stage},
};

use super::{BOLD, Cell, Column, Repeated, Row, Table};
use crate::section::Section;
use crate::section::estimator::Estimator;

/// Returns the table with estimators that have cross-validation records in rows. Columns are each fold, then mean ± sd
/// of every output.
pub fn table(section: &Section) -> Option<Table> {
    let mut folds: Vec<usize> = section.runs.iter().flat_map(|run| run.folds().map(|(fold, _)| fold)).collect();
    folds.sort_unstable();
    folds.dedup();
    let rows: Vec<Row> = section.estimators.iter().filter_map(|e| row(section, e, &folds)).collect();
    if rows.is_empty() {
        return None;
    }
    let total = section.total();
    let measure = |title: &str| Column::measure(title, &section.display);
    let mut columns = vec![Column::text("Model")];
    columns.extend(folds.iter().map(|fold| measure(&format!("Fold {fold}"))));
    columns.push(measure(total));
    columns.extend(section.outputs.iter().map(|output| measure(output)));
    let mut table =
        Table { name: "folds", title: "Cross-validation".into(), note: note(section), columns, rows, folded: false };
    (1..table.columns.len()).for_each(|column| table.mark_best(column, false, 0..table.rows.len()));
    Some(table)
}

fn row(section: &Section, estimator: &Estimator, folds: &[usize]) -> Option<Row> {
    let of_fold = |fold: usize| -> Vec<(&str, &Score)> {
        let run = &section.runs[estimator.run];
        let records = run.records.iter().filter(|record| record.stage == Stage::CrossValidation { fold });
        records
            .filter_map(|record| Some((record.id.as_str(), record.validation.estimators.get(&estimator.key)?)))
            .collect()
    };
    let all: Vec<(&str, &Score)> = folds.iter().flat_map(|&fold| of_fold(fold)).collect();
    if all.is_empty() {
        return None;
    }
    let cell = |scores: &[(&str, &Score)], value: &dyn Fn(&Score) -> f64| {
        let runs = scores.iter().map(|(run, score)| (run.to_string(), value(score))).collect();
        Repeated::of(runs).map_or(Cell::Empty, Cell::Repeated)
    };
    let total = |scores: &[(&str, &Score)]| cell(scores, &|score: &Score| score.rmse_total);
    let mut cells = vec![Cell::Text(estimator.label.clone())];
    cells.extend(folds.iter().map(|&fold| total(&of_fold(fold))));
    cells.push(total(&all));
    cells.extend((0..section.outputs.len()).map(|o| cell(&all, &|score: &Score| score.rmse[o])));
    Some(Row { cells, ..Row::default() })
}

fn note(section: &Section) -> String {
    let runs = section.runs.iter().find(|run| run.folds().next().is_some());
    let trials: Vec<String> = runs.map_or(vec![], |run| {
        run.folds().map(|(fold, record)| format!("fold {fold}: {}", some(&record.split.validation, ", "))).collect()
    });
    format!(
        "{} root mean square error on the trials that each fold leaves out of training; these errors also chose the epoch, \
         so they are for choosing settings, not for claims. Then, mean ± sample standard deviation over folds, over all coordinates and by coordinate. Validation \
         trials: {}. {BOLD}",
        section.total(),
        trials.join("; ")
    )
}
