//! Tables of a sweep: the best settings of each base, and all of them.

use acm_train::schedule::study::record::MemberRecord;

use super::{
    List,
    differences::{against, errors, headings},
};
use crate::tables::{Cell, Column, Row, Table};

/// Settings that the first table shows of each base.
const BEST: usize = 3;

/// Returns the tables of the best and of all settings.
pub fn tables(list: &List) -> Vec<Table> {
    let note = "Settings in the order of their root mean square error in cross-validation, mean ± sample standard deviation \
        over folds; these errors chose the epochs and the settings, so they are no claims. Difference: to the best, fold by \
        fold, with Student's 95 % interval of the mean; where it holds zero, these folds cannot tell the two apart.";
    let best = table(list, "best", "Best settings", note, BEST);
    let all = table(list, "settings", "All settings", note, usize::MAX);
    vec![best, Table { folded: true, ..all }]
}

fn table(list: &List, name: &'static str, title: &str, note: &str, most: usize) -> Table {
    let keys: Vec<String> =
        list.study.members.first().map_or(vec![], |member| member.values.iter().map(|(key, _)| key.clone()).collect());
    let mut columns = vec![Column::text("Model")];
    columns.extend(keys.iter().map(|key| Column::significant(last(key))));
    columns.push(Column::number("Parameters", "", 0));
    columns.extend(headings(list));
    let mut rows = vec![];
    for group in list.groups() {
        let first = group.rows.first().map(|(_, runs)| *runs);
        for (index, (_, runs)) in group.rows.iter().take(most).enumerate() {
            let mut cells = vec![Cell::Text(group.title.clone())];
            cells.extend(keys.iter().map(|key| value(runs.member, key)));
            cells.push(runs.records.first().map_or(Cell::Empty, |record| Cell::Count(record.parameters)));
            cells.extend(errors(list, runs));
            cells.extend(against(first.filter(|_| index > 0), runs));
            rows.push(Row { cells, opens: index == 0, bound: false });
        }
    }
    Table { name, title: title.into(), note: note.into(), columns, rows, folded: false }
}

/// Returns the last part of a dotted key, as words.
pub fn last(key: &str) -> String {
    key.rsplit('.').next().unwrap_or(key).replace('_', " ")
}

fn value(member: &MemberRecord, key: &str) -> Cell {
    let Some((_, text)) = member.values.iter().find(|(known, _)| known == key) else { return Cell::Empty };
    match (text.parse::<usize>(), text.parse::<f64>()) {
        (Ok(count), _) => Cell::Count(count),
        (_, Ok(mean)) => Cell::number(mean),
        _ => Cell::Text(text.trim_matches('"').into()),
    }
}
