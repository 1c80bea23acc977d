//! Table of an ablation: error of each variant, and by how much it is more than the first's.

use acm_train::{
    run::record::Score,
    schedule::study::{
        paired::Difference,
        record::Runs,
        table::{pairs, score},
    },
};

use super::List;
use crate::{
    spread::Spread,
    tables::{BOLD, Cell, Column, Repeated, Row, Table},
};

/// Returns the table with one group of rows for each base.
pub fn table(list: &List) -> Table {
    let total = list.total();
    let mut columns = vec![Column::text("Model"), Column::text("Variant"), Column::number("Runs", "", 0)];
    columns.extend(headings(list));
    let mut rows = vec![];
    for group in list.groups() {
        let first = group.rows.first().map(|(_, runs)| *runs);
        for (index, (name, runs)) in group.rows.iter().enumerate() {
            let mut cells = vec![Cell::Text(group.title.clone()), Cell::Text((*name).into())];
            cells.push(Cell::Count(runs.records.len()));
            cells.extend(errors(list, runs));
            cells.extend(against(first.filter(|_| index > 0), runs));
            rows.push(Row { cells, opens: index == 0, bound: false });
        }
    }
    let mut table = Table {
        name: "ablation",
        title: "Error without one thing at a time".into(),
        note: format!(
            "Root mean square error in cross-validation, mean ± sample standard deviation over folds and seeds. \
             Difference: to the first row of the model, in pairs of the same fold and seed, with Student's 95 % interval \
             of the mean; it is for further folds and seeds drawn as these were. Positive: the error grows. {BOLD} {total}: over all coordinates."
        ),
        columns,
        rows,
        folded: false,
    };
    mark(&mut table);
    table
}

/// Returns the columns for the cells of [`errors`] and [`against`].
pub fn headings(list: &List) -> Vec<Column> {
    let outputs = &list.first().outputs;
    let in_unit = |title: &str| Column::measure(title, &list.display);
    let mut columns = vec![in_unit(list.total())];
    columns.extend(outputs.iter().map(|output| in_unit(output)));
    columns.push(Column::number("Difference", "%", 2));
    columns.extend(["Difference", "95 % from", "to"].map(in_unit));
    columns
}

/// Returns the mean ± sd: over all coordinates, then each.
pub fn errors(list: &List, runs: &Runs) -> Vec<Cell> {
    let scores = || runs.records.iter().filter_map(|record| Some((record.id.clone(), score(record, None)?)));
    let cell = |value: &dyn Fn(&Score) -> f64| {
        Repeated::of(scores().map(|(run, score)| (run, value(score))).collect()).map_or(Cell::Empty, Cell::Repeated)
    };
    let total = cell(&|score: &Score| score.rmse_total);
    std::iter::once(total)
        .chain((0..list.first().outputs.len()).map(|o| cell(&|score: &Score| score.rmse[o])))
        .collect()
}

/// Returns the percentage of the reference's error, the difference, and both ends of its interval.
pub fn against(reference: Option<Runs>, runs: &Runs) -> Vec<Cell> {
    let found = reference.and_then(|reference| {
        let pairs = pairs(reference.records, runs.records);
        let base = Spread::of(&pairs.iter().map(|(a, _)| *a).collect::<Vec<_>>())?.mean;
        Some((Difference::of(&pairs)?, base))
    });
    let Some((difference, base)) = found else { return vec![Cell::Empty; 4] };
    let end = |sign: f64| difference.reach.map_or(Cell::Empty, |reach| Cell::number(difference.mean + sign * reach));
    vec![Cell::number(100.0 * difference.mean / base), Cell::number(difference.mean), end(-1.0), end(1.0)]
}

/// Marks the best of each model.
fn mark(table: &mut Table) {
    let starts: Vec<usize> = (0..table.rows.len()).filter(|&row| table.rows[row].opens).collect();
    for (index, &start) in starts.iter().enumerate() {
        let end = starts.get(index + 1).copied().unwrap_or(table.rows.len());
        table.mark_best(3, false, start..end);
    }
}
