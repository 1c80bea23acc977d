//! The residual characterisation as tables and figures.
//!
//! ```text
//! study.json ─ read ─▶ Study ─┬─ tables  ─▶ groups, trials, curves
//!                             └─ figures ─▶ (a) … (f), and the arm in space
//! ```

mod figures;
mod tables;

use std::path::Path;

use acm_train::{
    config::Kind,
    schedule::descriptive::{
        residual::{ResidualStudy, Slice},
        show::display,
        sweep::Signal,
    },
};

use crate::{chapter::study_table::record, error::EvalError, figures::Drawing, tables::Table, unit::Display};

/// Study of the residual, with its tables.
#[derive(Debug)]
pub struct Study {
    /// Record with request and results.
    pub record: ResidualStudy,
    /// Display of residuals.
    pub display: Display,
}

/// Reads the folder of a residual study.
///
/// # Errors
/// It is none, or the record is damaged.
pub fn read(folder: &Path) -> Result<Study, EvalError> {
    let record: ResidualStudy = record(folder, Kind::Residual, "residual")?;
    let widths = record.slices.iter().flat_map(|slice| &slice.bins).flat_map(|bin| [bin.mean.len(), bin.sd.len()]);
    let whole = widths.chain([record.overall.components.len()]).all(|width| width == record.outputs.len());
    let placed = record.backbones.iter().all(|arm| {
        record.slices.get(arm.slice).is_some_and(|slice| arm.bin < slice.bins.len()) && arm.points.len() > 1
    });
    match whole && placed {
        true => Ok(Study { display: display(&record.data, [&record.overall]), record }),
        false => Err(EvalError::Record {
            file: folder.join("study.json"),
            reason: "a slice, a bin or an arm does not fit the outputs".into(),
        }),
    }
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

    /// Writes the held values of a slice: `q2 = 1.20 rad`.
    fn held(&self, slice: &Slice) -> String {
        self.record.held(slice)
    }

    /// Returns the shown value of an SI value.
    fn shown(&self, value: f64) -> f64 {
        value * self.display.factor
    }
}
