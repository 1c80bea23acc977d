//! The table of predictions of one run: what was measured, and what each estimator says, at every target time stamp.
//!
//! Columns: `trial`, `part` (`validation` or `held_out`), `time` in s, then for each output `o` of the manifest
//! `measured_o`, `nominal_o`, `polynomial_o`, `predicted_o`, in the unit of the data stamp (m for a tip).

use acm_datasets::table::Column;
use nalgebra::DMatrix;

use crate::score::TrialPrediction;

/// The columns of the table, rows in the order of parts and trials.
pub fn columns(parts: &[(&str, &[TrialPrediction])], outputs: &[String]) -> Vec<(String, Column)> {
    let rows: Vec<(&str, &TrialPrediction)> =
        parts.iter().flat_map(|(part, trials)| trials.iter().map(move |trial| (*part, trial))).collect();
    let text = |of: &dyn Fn(&(&str, &TrialPrediction)) -> String| {
        Column::Text(rows.iter().flat_map(|row| std::iter::repeat_n(of(row), row.1.time.len())).collect())
    };
    let time = rows.iter().flat_map(|(_, trial)| trial.time.iter().copied()).collect();
    let mut columns = vec![
        ("trial".into(), text(&|(_, trial)| trial.trial.clone())),
        ("part".into(), text(&|(part, _)| part.to_string())),
        ("time".into(), Column::Number(time)),
    ];
    for (o, output) in outputs.iter().enumerate() {
        let estimates: [(&str, fn(&TrialPrediction) -> &DMatrix<f64>); 4] = [
            ("measured", |t| &t.measured),
            ("nominal", |t| &t.nominal),
            ("polynomial", |t| &t.polynomial),
            ("predicted", |t| &t.predicted),
        ];
        for (name, of) in estimates {
            let values = rows.iter().flat_map(|(_, trial)| of(trial).column(o).iter().copied().collect::<Vec<_>>());
            columns.push((format!("{name}_{output}"), Column::Number(values.collect())));
        }
    }
    columns
}
