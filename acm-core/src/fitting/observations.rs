//! Data of a calibration: actuators and measured markers of each sample.

use nalgebra::DMatrix;

use crate::arm::ArmError;
use crate::tip_model::ModelError;

/// Largest magnitude: its ninth power, squared and summed, is still finite.
const LARGEST: f64 = 1e15;

/// Samples of a quasi-static arm (or of any rig, for the polynomial).
#[derive(Debug, Clone, PartialEq)]
pub struct Observations {
    /// Actuators [T×A], SI.
    pub actuators: DMatrix<f64>,
    /// Measured outputs [T×M]; for an arm M = 3K, x y z of each marker, m.
    pub measured: DMatrix<f64>,
    /// `[K]` s/L of each marker; empty where the outputs are no markers.
    pub at: Vec<f64>,
}

/// Reasons why a calibration cannot start.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CalibrationError {
    /// Actuators and measurements of different length.
    #[error("{actuators} rows of actuators but {measured} rows of measurements; each sample needs both")]
    Rows {
        /// Rows of actuators.
        actuators: usize,
        /// Rows of measurements.
        measured: usize,
    },
    /// Number of measured columns does not fit the markers.
    #[error(
        "{columns} measured columns for {markers} marker(s); a strain model needs x, y and z of each marker, {needed} columns, or choose model = \"polynomial\""
    )]
    Columns {
        /// As given.
        columns: usize,
        /// Number of markers.
        markers: usize,
        /// 3 per marker.
        needed: usize,
    },
    /// A value is NaN or infinite.
    #[error("{table} row {row}, column {column} is {value}; drop the sample or repair the recording")]
    NotFinite {
        /// `actuators` or `measured`.
        table: &'static str,
        /// Row, counted from 1.
        row: usize,
        /// Column, counted from 1.
        column: usize,
        /// As given.
        value: f64,
    },
    /// A value is so large that its powers would overflow.
    #[error(
        "{table} row {row}, column {column} is {value:e}, beyond {LARGEST:e} in SI units; check the unit, or drop the sample"
    )]
    TooLarge {
        /// `actuators` or `measured`.
        table: &'static str,
        /// Row, counted from 1.
        row: usize,
        /// Column, counted from 1.
        column: usize,
        /// As given.
        value: f64,
    },
    /// There are fewer samples than unknowns.
    #[error(
        "{samples} samples cannot determine {parameters} parameters: {needed} samples are needed; calibrate on more trials, or lower the degree of the actuation map or the polynomial"
    )]
    TooFewSamples {
        /// As given.
        samples: usize,
        /// Unknowns per fit.
        parameters: usize,
        /// Least number that is accepted.
        needed: usize,
    },
    /// The model has too many parameters.
    #[error("the model has {parameters} parameters, more than {most}; lower the degree, or the number of segments")]
    TooManyParameters {
        /// Asked for.
        parameters: usize,
        /// Accepted.
        most: usize,
    },
    /// There is no column.
    #[error("no {what}; give at least one")]
    Nothing {
        /// `actuator column`, `measured column`.
        what: &'static str,
    },
    /// Degree of the polynomial out of range.
    #[error("polynomial degree is {degree}; choose 1 to {most}")]
    Degree {
        /// As given.
        degree: usize,
        /// Largest accepted.
        most: usize,
    },
    /// Number of bins of the order study.
    #[error(
        "{bins} bins with at least 3 samples each are left; choose other bins or more samples (at least {needed} are needed)"
    )]
    Bins {
        /// Bins left.
        bins: usize,
        /// Least number.
        needed: usize,
    },
    /// The fit's residuals were not finite where it started.
    #[error("the model has no finite error at the start of the fit ({what}); check units and actuator ranges")]
    Diverged {
        /// Which stage.
        what: String,
    },
    /// The arm is refused.
    #[error(transparent)]
    Model(#[from] ModelError),
}

impl From<ArmError> for CalibrationError {
    fn from(error: ArmError) -> Self {
        Self::Model(error.into())
    }
}

impl Observations {
    /// Number of samples T.
    pub fn samples(&self) -> usize {
        self.measured.nrows()
    }

    /// Refuses tables of different length, and NaN or infinity anywhere.
    ///
    /// # Errors
    /// The first fault: different lengths, a table without columns, or a number that is not finite or too large.
    pub fn validate(&self) -> Result<(), CalibrationError> {
        let (actuators, measured) = (self.actuators.nrows(), self.measured.nrows());
        if actuators != measured {
            return Err(CalibrationError::Rows { actuators, measured });
        }
        if self.actuators.ncols() == 0 {
            let what = "actuator column";
            return Err(CalibrationError::Nothing { what });
        }
        if self.measured.ncols() == 0 {
            let what = "measured column";
            return Err(CalibrationError::Nothing { what });
        }
        finite("actuators", &self.actuators)?;
        finite("measured", &self.measured)
    }

    /// The measured columns must be x, y, z of each marker.
    pub(crate) fn validate_markers(&self) -> Result<(), CalibrationError> {
        let (columns, markers) = (self.measured.ncols(), self.at.len());
        let needed = 3 * markers;
        if columns == needed {
            return Ok(());
        }
        Err(CalibrationError::Columns { columns, markers, needed })
    }

    /// At most `count` samples, evenly spread over the record.
    pub(crate) fn thinned(&self, count: usize) -> Observations {
        let samples = self.samples();
        if samples <= count {
            return self.clone();
        }
        let rows: Vec<usize> = (0..count).map(|k| k * samples / count).collect();
        Observations {
            actuators: self.actuators.select_rows(&rows),
            measured: self.measured.select_rows(&rows),
            at: self.at.clone(),
        }
    }
}

fn finite(table: &'static str, values: &DMatrix<f64>) -> Result<(), CalibrationError> {
    // Written so that NaN is found as well.
    let Some(index) = values.iter().position(|value| !(value.abs() <= LARGEST)) else {
        return Ok(());
    };
    let (row, column) = (index % values.nrows() + 1, index / values.nrows() + 1);
    let value = values[index];
    Err(if value.is_finite() {
        CalibrationError::TooLarge { table, row, column, value }
    } else {
        CalibrationError::NotFinite { table, row, column, value }
    })
}
