//! The nominal study as tables and figures.
//!
//! ```text
//! study.json, predictions/*.parquet ─ read ─▶ Study ─┬─ tables  ─▶ orders, models, trials
//!                                                    └─ figures ─▶ (a) … (j)
//! ```

mod figures;
mod tables;

use std::path::Path;

use acm_train::{
    config::Kind,
    schedule::descriptive::{nominal::NominalStudy, show::display, sweep::Signal},
};

use crate::{
    chapter::study_table::{StudyTable, columns, record},
    error::EvalError,
    figures::Drawing,
    tables::Table,
    unit::Display,
};

/// A study with its tables.
#[derive(Debug)]
pub struct Study {
    /// Configuration and results.
    pub record: NominalStudy,
    /// Display of errors.
    pub display: Display,
    /// Bins of the order study.
    bins: StudyTable,
    /// All calibration samples.
    calibration: StudyTable,
}

/// Reads the folder of a nominal study.
///
/// # Errors
/// It is none, or a file is missing or damaged.
pub fn read(folder: &Path) -> Result<Study, EvalError> {
    let record: NominalStudy = record(folder, Kind::Nominal, "nominal")?;
    let actuators = record.actuators.iter().map(|signal| format!("actuator_{}", signal.name));
    let measured = columns(&["measured".into()], &record.outputs);
    let common: Vec<String> = actuators.chain(measured).collect();
    let orders: Vec<String> = record
        .orders
        .rows
        .iter()
        .flat_map(|row| ["frozen", "refitted"].map(|protocol| format!("order{}_{protocol}", row.order)))
        .collect();
    let models: Vec<String> = record.models.iter().map(|model| model.key.clone()).collect();
    let needed = |estimates: &[String]| [common.clone(), columns(estimates, &record.outputs)].concat();
    Ok(Study {
        bins: StudyTable::read(folder, "bins", &record.tables, &needed(&orders))?,
        calibration: StudyTable::read(folder, "calibration", &record.tables, &needed(&models))?,
        display: display(&record.data, record.models.iter().map(|model| &model.fitted.all)),
        record,
    })
}

/// Returns the tables in the order of the page.
pub fn tables(study: &Study) -> Vec<Table> {
    tables::all(study)
}

/// Returns the figures in the order of the page: name of the files, question, drawing.
pub fn figures(study: &Study) -> Vec<(&'static str, &'static str, Drawing)> {
    figures::all(study)
}

impl Study {
    /// Returns the swept actuator.
    fn swept(&self) -> Signal {
        Signal::at(&self.record.actuators, self.record.swept)
    }
}
