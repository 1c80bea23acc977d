//! `predictions/residual.parquet`: every sample with the prediction of the nominal model.
//!
//! Columns: `trial`, `role`, `time`, `altitude` where there is one, `actuator_q` for each, then `measured_o` and
//! `nominal_o` for each output. Values are SI.

use acm_datasets::files::table::Column;
use nalgebra::DMatrix;

use super::{described::Described, record::ResidualStudy};
use crate::schedule::descriptive::rms::stacked;

/// Returns the columns, rows in the order of the trials.
pub fn residual(described: &[Described], altitude: Option<usize>, record: &ResidualStudy) -> Vec<(String, Column)> {
    let text = |of: &dyn Fn(&Described) -> String| {
        Column::Text(described.iter().flat_map(|d| std::iter::repeat_n(of(d), d.trial.samples())).collect())
    };
    let time = described.iter().flat_map(|d| d.trial.time.iter().copied()).collect();
    let mut columns = vec![
        ("trial".to_string(), text(&|d| d.trial.name.clone())),
        ("role".into(), text(&|d| d.trial.role.name().into())),
        ("time".into(), Column::Number(time)),
    ];
    let all = |of: &dyn Fn(&Described) -> DMatrix<f64>| {
        let tables: Vec<DMatrix<f64>> = described.iter().map(of).collect();
        stacked(&tables)
    };
    let mut add = |name: String, table: &DMatrix<f64>, column: usize| {
        columns.push((name, Column::Number(table.column(column).iter().copied().collect())));
    };
    if let Some(column) = altitude {
        add("altitude".into(), &all(&|d| d.trial.context.clone()), column);
    }
    let actuators = all(&|d| d.trial.actuators.clone());
    record.actuators.iter().enumerate().for_each(|(a, signal)| add(format!("actuator_{}", signal.name), &actuators, a));
    for (estimate, table) in [("measured", all(&|d| d.measured.clone())), ("nominal", all(&|d| d.nominal.clone()))] {
        record.outputs.iter().enumerate().for_each(|(o, output)| add(format!("{estimate}_{output}"), &table, o));
    }
    columns
}
