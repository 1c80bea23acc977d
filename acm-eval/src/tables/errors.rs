//! The main table: error of each estimator on the held-out trials, mean ± sd over seeds.
//!
//! ```text
//! improvement = 1 − RMSE / RMSE_nominal      (3-D, per seed, then mean ± sd)
//! ```

use acm_train::{names::some, record::Score};

use super::{Cell, Column, Row, Table};
use crate::{estimator::Estimator, section::Section, spread::Spread, unit::total_name};

/// Rows: baselines, networks, then the floors where the data's maker knows them.
pub fn table(section: &Section) -> Option<Table> {
    let rows: Vec<Row> = section.estimators.iter().filter_map(|estimator| row(section, estimator)).collect();
    if rows.is_empty() {
        return None;
    }
    let columns = columns(section);
    let mut table = Table {
        name: "errors",
        title: "Error on the held-out trials".into(),
        note: note(section),
        columns,
        rows,
        folded: false,
    };
    for column in 1..table.columns.len() {
        let larger_is_better = column == table.columns.len() - 1;
        table.mark_best(column, larger_is_better, 0..table.rows.len());
    }
    table.rows.extend(floors(section, table.columns.len()));
    Some(table)
}

fn columns(section: &Section) -> Vec<Column> {
    let unit = &section.display.symbol;
    let mut columns = vec![Column::text("Model")];
    columns.extend(section.outputs.iter().map(|output| Column::number(output, unit, 2)));
    columns.push(Column::number(total_name(section.outputs.len()), unit, 2));
    columns.push(Column::number("Improvement", "%", 1));
    columns
}

fn row(section: &Section, estimator: &Estimator) -> Option<Row> {
    let scores: Vec<&Score> = section.held_out(estimator).collect();
    if scores.is_empty() {
        return None;
    }
    let spread = |values: Vec<f64>| Cell::of(estimator.spread(&values));
    let shown = |metres: f64| metres * section.display.factor;
    let mut cells = vec![Cell::Text(estimator.label.clone())];
    cells.extend((0..section.outputs.len()).map(|o| spread(scores.iter().map(|score| shown(score.rmse[o])).collect())));
    cells.push(spread(scores.iter().map(|score| shown(score.rmse_total)).collect()));
    cells.push(if estimator.key == "nominal" {
        Cell::Empty
    } else {
        spread(section.improvements(estimator, |part| Some(&part.estimators)))
    });
    Some(Row { cells, ..Row::default() })
}

fn floors(section: &Section, columns: usize) -> Vec<Row> {
    let Some(floors) = &section.data.floors else { return vec![] };
    let shown = |mm: f64| Cell::Number(Spread { mean: mm / 1000.0 * section.display.factor, sd: None });
    let row = |label: &str, components: &[f64], total: f64| {
        let mut cells = vec![Cell::Empty; columns];
        cells[0] = Cell::Text(label.into());
        let outputs = section.outputs.len();
        cells[1..=outputs].iter_mut().zip(components).for_each(|(cell, &mm)| *cell = shown(mm));
        cells[outputs + 1] = shown(total);
        Row { cells, bound: true, ..Row::default() }
    };
    let memoryless = row("Memoryless floor", &floors.memoryless_component_mm, floors.memoryless_mm);
    let oracle = row("Oracle floor", &floors.oracle_component_mm, floors.oracle_mm);
    vec![Row { opens: true, ..memoryless }, oracle]
}

fn note(section: &Section) -> String {
    let networks: Vec<usize> = section.networks().map(|network| section.held_out(network).count()).collect();
    let (fewest, most) = (networks.iter().min().copied().unwrap_or(0), networks.iter().max().copied().unwrap_or(0));
    let seeds = match (fewest, most) {
        (1, 1) => "one seed".to_string(),
        (a, b) if a == b => format!("mean ± sample standard deviation over {a} seeds"),
        (a, b) => format!("mean ± sample standard deviation over {a} to {b} seeds, see Runs"),
    };
    let samples = section.estimators.iter().find_map(|estimator| Some(section.held_out(estimator).next()?.samples));
    let floors = match &section.data.floors {
        Some(_) => {
            " The floors are estimates by the simulator that made the data: what is left when all recorded inputs are \
             known at one instant (memoryless), or with their whole past (oracle). They come from random redraws, so \
             a single coordinate may fall a little on either side."
        }
        None => "",
    };
    format!(
        "Root mean square error; {seeds}; {} identical target time stamps in {} that took no part in learning. \
         Improvement: share of the nominal {} error that is gone, per seed. The best of each column is bold.{floors}",
        super::grouped(samples.unwrap_or(0)),
        trials(&section.held_out_trials()),
        total_name(section.outputs.len()),
    )
}

fn trials(names: &[&str]) -> String {
    match names {
        [one] => format!("trial {one}"),
        several => format!("trials {}", some(several, ", ")),
    }
}
