//! Share of the residual's variance that each estimator explains, by output.
//!
//! ```text
//! R² = 1 − Σe² / Σ(r − r̄)²        e = measured − estimate,  r = measured − nominal
//! ```

use acm_train::run::record::Score;

use super::{Cell, Column, Repeated, Row, Table};
use crate::section::Section;
use crate::section::estimator::Estimator;

/// Returns the table with polynomial and networks in rows; the nominal model explains none of its own residual.
pub fn table(section: &Section) -> Option<Table> {
    let shown = section.estimators.iter().filter(|estimator| estimator.key != "nominal");
    let rows: Vec<Row> = shown.filter_map(|estimator| row(section, estimator)).collect();
    let mut columns = vec![Column::text("Model")];
    columns.extend(section.outputs.iter().map(|output| Column::number(format!("R² {output}"), "", 3)));
    let mut table = Table {
        name: "explained",
        title: "Share of the residual that is explained".into(),
        note:
            "R² = 1 − Σe² / Σ(r − r̄)² on the held-out trials, with r = measured − nominal. 1: all of it; 0: no better \
               than adding its mean; below 0: worse than that."
                .into(),
        columns,
        rows,
        folded: false,
    };
    (1..table.columns.len()).for_each(|column| table.mark_best(column, true, 0..table.rows.len()));
    (!table.rows.is_empty()).then_some(table)
}

fn row(section: &Section, estimator: &Estimator) -> Option<Row> {
    let scores: Vec<(String, &Score)> = section.scores(estimator, |part| Some(&part.estimators)).collect();
    let outputs = 0..scores.first()?.1.r2.len();
    let of = |o: usize| Repeated::of(scores.iter().map(|(run, score)| (run.clone(), score.r2[o])).collect());
    let cells = outputs.map(|o| of(o).map_or(Cell::Empty, Cell::Repeated));
    Some(Row { cells: std::iter::once(Cell::Text(estimator.label.clone())).chain(cells).collect(), ..Row::default() })
}
