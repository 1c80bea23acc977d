//! The main table: error of each estimator on the held-out trials, mean ± sd over seeds.
//!
//! ```text
//! improvement = 1 − RMSE / RMSE_nominal      (3-D, per seed, then mean ± sd)
//! ```

use std::collections::BTreeMap;

use acm_train::run::{
    names::some,
    record::{PartScores, Score},
};

use super::{BOLD, Cell, Column, Repeated, Row, Table};
use crate::section::Section;
use crate::section::estimator::Estimator;

/// Returns the table with baselines and networks in rows, then the floors where the data's maker knows them.
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
    let total = section.total();
    let names = section.outputs.iter().map(String::as_str).chain([total]);
    let errors = names.map(|name| Column::measure(name, &section.display));
    let improvement = Column::number("Improvement", "%", 1);
    std::iter::once(Column::text("Model")).chain(errors).chain([improvement]).collect()
}

fn row(section: &Section, estimator: &Estimator) -> Option<Row> {
    let head = [Cell::Text(estimator.label.clone())];
    let cells = errors(section, estimator, |part| Some(&part.estimators))?;
    Some(Row { cells: head.into_iter().chain(cells).collect(), ..Row::default() })
}

/// Returns the cells of one estimator: each output's error, that over all outputs, and the improvement over the nominal
/// model.
pub fn errors<'a>(
    section: &'a Section,
    estimator: &'a Estimator,
    pick: impl Fn(&'a PartScores) -> Option<&'a BTreeMap<String, Score>> + Copy + 'a,
) -> Option<Vec<Cell>> {
    let scores: Vec<(String, &Score)> = section.scores(estimator, pick).collect();
    let repeated = |runs| Repeated::of(runs).map_or(Cell::Empty, Cell::Repeated);
    let of = |value: &dyn Fn(&Score) -> f64| repeated(scores.iter().map(|(run, s)| (run.clone(), value(s))).collect());
    let outputs = scores.first()?.1.rmse.len();
    let each = (0..outputs).map(|o| of(&|score: &Score| score.rmse[o]));
    let gain = match estimator.key.as_str() {
        "nominal" => Cell::Empty,
        _ => repeated(section.improvements(estimator, pick)),
    };
    Some(each.chain([of(&|score: &Score| score.rmse_total), gain]).collect())
}

fn floors(section: &Section, columns: usize) -> Vec<Row> {
    let Some(floors) = &section.data.floors else { return vec![] };
    let metres = |mm: f64| Cell::number(mm / 1000.0);
    let row = |label: &str, components: &[f64], total: f64| {
        let mut cells = vec![Cell::Empty; columns];
        cells[0] = Cell::Text(label.into());
        let outputs = section.outputs.len();
        cells[1..=outputs].iter_mut().zip(components).for_each(|(cell, &mm)| *cell = metres(mm));
        cells[outputs + 1] = metres(total);
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
         Improvement: share of the nominal {} error that is gone, per seed. {BOLD}{floors}",
        super::grouped(samples.unwrap_or(0)),
        trials(&section.held_out_trials()),
        section.total(),
    )
}

fn trials(names: &[&str]) -> String {
    match names {
        [one] => format!("trial {one}"),
        several => format!("trials {}", some(several, ", ")),
    }
}
