//! Table of predictions of one run: measured values and each estimator's predictions, at every target time stamp.
//!
//! Columns: `trial`, `part` (`validation` or `held_out`), `time` in s, then for each output `o` of the manifest
//! `measured_o`, `nominal_o`, `polynomial_o`, `predicted_o`, in the unit of the data stamp (m for a tip).

use acm_datasets::files::table::Column;
use nalgebra::DMatrix;

use crate::run::evaluation::score::TrialPrediction;

/// Rows of one group of the table, at least, where it has more.
const GROUP: usize = 1 << 17;

/// Returns the table in groups of rows, as its trials come, each with the part that it is of. There is at least one
/// group.
pub fn groups<'a, E>(
    rows: impl Iterator<Item = Result<(&'a str, TrialPrediction), E>>,
    outputs: &[String],
) -> impl Iterator<Item = Result<Vec<(String, Column)>, E>> {
    let (mut rows, mut first) = (rows.fuse(), true);
    std::iter::from_fn(move || {
        let (mut group, mut length) = (vec![], 0);
        while length < GROUP
            && let Some(row) = rows.next()
        {
            match row {
                Ok(row) => {
                    length += row.1.time.len();
                    group.push(row);
                }
                Err(error) => return Some(Err(error)),
            }
        }
        let more = first || !group.is_empty();
        first = false;
        more.then(|| Ok(columns(&group, outputs)))
    })
}

/// Returns the columns of the table, rows in the order of trials.
fn columns(rows: &[(&str, TrialPrediction)], outputs: &[String]) -> Vec<(String, Column)> {
    let text = |of: &dyn Fn(&(&str, TrialPrediction)) -> String| {
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
