//! One recorded run.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::manifest::Role;

/// Why samples of a trial take no part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DropReason {
    /// A measured cell is empty: the marker was lost.
    MissingMarker,
    /// A cell of the vehicle's position or attitude is empty.
    MissingVehicle,
    /// Another source has no sample there: before its start, behind its end, or in a gap.
    MissingSource,
    /// The actuators are outside of what the calibration trials cover.
    OutsideDomain,
}

/// One recorded run in SI units: `T` samples, `A` actuators, `E` context signals, `M` outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// Name, unique in the campaign.
    pub name: String,
    /// Role of the trial.
    pub role: Role,
    /// Time stamps `[T]`, s, increasing.
    pub time: Vec<f64>,
    /// `[T×A]`.
    pub actuators: DMatrix<f64>,
    /// `[T×E]`.
    pub context: DMatrix<f64>,
    /// `[T×M]`.
    pub measured: DMatrix<f64>,
    /// `[T×M]`, the user's own prediction.
    pub predicted: Option<DMatrix<f64>>,
    /// `[T×3]` position, or `[T×6]` or `[T×7]` with attitude.
    pub vehicle: Option<DMatrix<f64>>,
    /// Constants, SI.
    pub conditions: BTreeMap<String, f64>,
    /// Samples that were left out, by reason.
    pub dropped: BTreeMap<DropReason, usize>,
    /// File relative to the data folder.
    pub file: PathBuf,
}

impl Trial {
    /// Number of samples `T`.
    pub fn samples(&self) -> usize {
        self.time.len()
    }

    /// Duration from the first sample to the last, s.
    pub fn duration(&self) -> f64 {
        match (self.time.first(), self.time.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        }
    }

    /// The samples of `rows`, which are increasing; what was left out before stays counted.
    pub fn select(&self, rows: &[usize]) -> Trial {
        Trial {
            name: self.name.clone(),
            role: self.role,
            time: rows.iter().map(|t| self.time[*t]).collect(),
            actuators: self.actuators.select_rows(rows),
            context: self.context.select_rows(rows),
            measured: self.measured.select_rows(rows),
            predicted: self.predicted.as_ref().map(|m| m.select_rows(rows)),
            vehicle: self.vehicle.as_ref().map(|m| m.select_rows(rows)),
            conditions: self.conditions.clone(),
            dropped: self.dropped.clone(),
            file: self.file.clone(),
        }
    }
}

impl fmt::Display for DropReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            DropReason::MissingMarker => "lost marker",
            DropReason::MissingVehicle => "lost vehicle",
            DropReason::MissingSource => "without another source",
            DropReason::OutsideDomain => "outside of the calibrated domain",
        })
    }
}
