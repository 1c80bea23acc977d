//! The scores of the test part: a line for each row of the question, mean ± standard deviation over seeds.

use acm_train::run::sequences::record::SequenceRecord;

use super::Study;
use crate::{
    spread::Spread,
    tables::{Cell, Column, Row, Table},
};

/// Returns the one table.
pub fn scores(study: &Study) -> Table {
    let labels = study.runs.iter().all(|run| run.scored().accuracy.is_some());
    let data = &study.record.data;
    let mut columns = vec![Column::text("Network")];
    match labels {
        true => columns.push(Column::number("Right", "%", 2)),
        false => columns.extend(data.outputs.iter().map(|output| Column::significant(format!("RMSE {output}")))),
    }
    columns.push(Column::significant(if labels { "Cross-entropy" } else { "MSE" }));
    columns.extend(["Seeds", "Parameters", "Epochs"].map(|title| Column::number(title, "", 0)));
    columns.push(Column::number("Training", "min", 1));
    let mut rows: Vec<Row> = study.rows().iter().map(|(told, runs)| line(told, runs, labels)).collect();
    let width = columns.len();
    let mut bound = |name: &str, values: Vec<f64>| {
        let numbers = values.into_iter().map(Cell::number);
        let mut cells: Vec<Cell> = std::iter::once(Cell::Text(name.into())).chain(numbers).collect();
        cells.resize(width, Cell::Empty);
        rows.push(Row { cells, bound: true, ..Row::default() });
    };
    if let Some(limit) = data.limit_without_time {
        bound("best possible without elapsed time", vec![100.0 * limit]);
    }
    if let Some(errors) = data.persistence.clone().filter(|_| !labels) {
        bound("the last value, repeated", errors);
    }
    let tested = data.sequences.get("test").copied().unwrap_or_default();
    Table {
        name: "sequences",
        title: "Sequences that took no part".into(),
        note: format!(
            "Scores on {tested} sequences, looked at once, after the epoch was chosen on others; mean ± standard deviation \
             over seeds. MSE is the mean square error over all targets, in the square of their own unit. The best possible without elapsed time is counted from the rule that makes the sequences."
        ),
        columns,
        rows,
        folded: false,
    }
}

fn line(told: &str, runs: &[&SequenceRecord], labels: bool) -> Row {
    let spread = |of: &dyn Fn(&SequenceRecord) -> f64| {
        Cell::of(Spread::of(&runs.iter().map(|run| of(run)).collect::<Vec<f64>>()))
    };
    let outputs = runs[0].scored().rmse.as_ref().map_or(0, Vec::len);
    let mut cells = vec![Cell::Text(format!("{}, {told}", runs[0].question.network.kind()))];
    match labels {
        true => cells.push(spread(&|run| 100.0 * run.scored().accuracy.unwrap_or(f64::NAN))),
        false => {
            cells.extend((0..outputs).map(|o| spread(&|run| run.scored().rmse.as_ref().map_or(f64::NAN, |e| e[o]))));
        }
    }
    cells.push(spread(&|run| run.scored().loss));
    cells.extend([Cell::Count(runs.len()), Cell::Count(runs[0].parameters)]);
    cells.push(spread(&|run| run.epochs.len() as f64));
    cells.push(spread(&|run| run.seconds / 60.0));
    Row { cells, ..Row::default() }
}
