//! The nominal model's parameters: value ± standard deviation from the fit's covariance, with units.

use super::{Cell, Column, Row, Table};
use crate::{
    section::{Section, calibrations},
    spread::Spread,
};

/// Returns the table with the parameters of every nominal calibration in rows.
pub fn table(section: &Section) -> Option<Table> {
    let columns = vec![
        Column::text("Calibrated on"),
        Column::text("Parameter"),
        Column::significant("Value"),
        Column::text("Unit"),
    ];
    let mut rows = Vec::new();
    for (label, pair) in calibrations(section) {
        let first = rows.len();
        for parameter in pair.nominal.iter().flat_map(|nominal| &nominal.parameters) {
            let value = Spread { mean: parameter.value, sd: parameter.sd };
            let cells = vec![
                Cell::Text(label.clone()),
                Cell::Text(parameter.name.clone()),
                Cell::Number(value),
                Cell::Text(parameter.unit.clone()),
            ];
            rows.push(Row { cells, opens: rows.len() == first && first > 0, ..Row::default() });
        }
    }
    let table = Table {
        name: "calibration",
        title: "Parameters of the nominal model".into(),
        note: "Value ± standard deviation from the covariance of the fit, which takes the model for true and the \
               samples for independent: a lower bound of the doubt. SI units."
            .into(),
        columns,
        rows,
        folded: true,
    };
    (!table.rows.is_empty()).then(|| table.say_once())
}
