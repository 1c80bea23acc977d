//! A row of units below the header: every cell is a unit or empty, and one is more than a number.

use std::collections::BTreeMap;

use csv::StringRecord;

use crate::units::Unit;

/// Units by column, if a row is one of units.
pub(super) fn units(names: &[String], row: &StringRecord) -> Option<BTreeMap<String, String>> {
    let cells: Vec<&str> = row.iter().map(|cell| cell.trim().trim_matches(['[', ']', '(', ')'])).collect();
    let unit = |cell: &&str| cell.parse::<f64>().is_err() && Unit::parse(cell).is_ok();
    // "1" is both a unit and a number: a row of numbers is not a row of units
    let all = cells.iter().all(|cell| unit(cell) || ["", "1", "-"].contains(cell));
    let named = names.iter().zip(&cells).filter(|(_, unit)| !["", "-"].contains(unit));
    (all && cells.iter().any(unit)).then(|| named.map(|(name, unit)| (name.clone(), unit.to_string())).collect())
}
