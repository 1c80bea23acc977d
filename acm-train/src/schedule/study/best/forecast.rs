//! Predictions of runs, from their tables on disk, target by target; the mean over several runs of one part.

use std::path::{Path, PathBuf};

use acm_datasets::DataError;
use acm_datasets::files::table::{Column, read_parquet};

use crate::{
    run::{RunError, record::RunRecord},
    schedule::error::ScheduleError,
    store::hashed,
};

/// Targets of predictions, with the measured values.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Targets {
    /// Trial of each target.
    pub trial: Vec<String>,
    /// Time stamp of each target, s.
    pub time: Vec<f64>,
    /// Measured outputs, target by target [T·O], SI.
    pub measured: Vec<f64>,
}

/// Targets with predictions, target by target [T·O], SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Forecast {
    /// Targets of the predictions.
    pub targets: Targets,
    /// Prediction of the nominal model.
    pub nominal: Vec<f64>,
    /// Prediction of nominal model and network together.
    pub predicted: Vec<f64>,
}

/// Returns the mean over some runs of one experiment whose parts called `part` are the same trials; none without runs.
///
/// # Errors
/// A table is missing or was changed; two runs are not of the same targets.
pub fn mean(folder: &Path, records: &[&RunRecord], part: &str) -> Result<Option<Forecast>, ScheduleError> {
    let mut sum: Option<Forecast> = None;
    for record in records {
        let one = read(folder, record, part)?;
        match &mut sum {
            None => sum = Some(one),
            Some(sum) => {
                same(&sum.targets, &one.targets, &record.id)?;
                add(&mut sum.nominal, &one.nominal);
                add(&mut sum.predicted, &one.predicted);
            }
        }
    }
    let count = records.len() as f64;
    Ok(sum.map(|mut sum| {
        sum.nominal.iter_mut().chain(&mut sum.predicted).for_each(|value| *value /= count);
        sum
    }))
}

/// Adds value by value.
pub fn add(sum: &mut [f64], values: &[f64]) {
    sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
}

/// Refuses predictions of other targets.
///
/// # Errors
/// The targets differ; `who` names the second.
pub fn same(a: &Targets, b: &Targets, who: &str) -> Result<(), ScheduleError> {
    match a == b {
        true => Ok(()),
        false => Err(ScheduleError::Usage {
            what: format!("{who} is not scored at the time stamps of the others"),
            help: "give all experiments of a study of the best the same data, folds, windows.reach, windows.max_gap, \
                   windows.evaluation_stride and inputs.domain_filter"
                .into(),
        }),
    }
}

fn read(folder: &Path, record: &RunRecord, part: &str) -> Result<Forecast, ScheduleError> {
    let path = folder.join(&record.predictions);
    hashed::same_file(&path, &record.predictions_sha256, &hashed::record_of(&path))?;
    let columns = read_parquet(&path).map_err(RunError::from)?;
    let of = |name: &str| columns.iter().find(|(known, _)| known == name).map(|(_, column)| column);
    let text = |name: &str| match of(name) {
        Some(Column::Text(text)) => Ok(text),
        _ => Err(missing(&path, name)),
    };
    let numbers = |name: String| match of(&name) {
        Some(Column::Number(numbers)) => Ok(numbers),
        _ => Err(missing(&path, &name)),
    };
    let parts = text("part")?;
    let rows: Vec<usize> = (0..parts.len()).filter(|&row| parts[row] == part).collect();
    let interleaved = |estimate: &str| -> Result<Vec<f64>, ScheduleError> {
        let each = record.outputs.iter().map(|output| numbers(format!("{estimate}_{output}")));
        let each: Vec<&Vec<f64>> = each.collect::<Result<_, _>>()?;
        Ok(rows.iter().flat_map(|&row| each.iter().map(move |values| values[row])).collect())
    };
    let trials = text("trial")?;
    let times = numbers("time".into())?;
    let targets = Targets {
        trial: rows.iter().map(|&row| trials[row].clone()).collect(),
        time: rows.iter().map(|&row| times[row]).collect(),
        measured: interleaved("measured")?,
    };
    Ok(Forecast { targets, nominal: interleaved("nominal")?, predicted: interleaved("predicted")? })
}

fn missing(path: &Path, column: &str) -> ScheduleError {
    let reason = format!("there is no column `{column}`");
    RunError::from(DataError::Damaged { path: PathBuf::from(path), reason }).into()
}
