//! Case: a rig, its nominal model, and recordings that may be searched; held-out trials are a type of their own,
//! [`crate::holdout::Holdout`].

use acm_core::nominal::NominalSpec;
use acm_core::record::Record;
use acm_core::rig::Rig;
use nalgebra::DMatrix;
use std::ops::Range;

/// One recorded trial of T samples.
#[derive(Debug, Clone)]
pub struct Trial {
    /// Unique name.
    pub name: String,
    /// Signals.
    pub record: Record,
    /// Measured outputs [T×M], SI.
    pub measured: DMatrix<f64>,
    /// The prediction that came with the data [T×M].
    pub predicted: Option<DMatrix<f64>>,
    /// Difference s − g [T×M] between the given prediction s and the polynomial g that approximates it, once there is
    /// one; see `acm_core::nominal`.
    pub offset: Option<DMatrix<f64>>,
}

/// A rig and what was recorded on it.
#[derive(Debug, Clone)]
pub struct Case {
    /// Signals and mechanics.
    pub rig: Rig,
    /// The nominal model, to be calibrated; ignored where predictions come with the data.
    pub nominal: NominalSpec,
    /// Position s/L of each marker; empty where the outputs are no markers.
    pub at: Vec<f64>,
    /// Outputs that errors are reported of: those of the tip, or all.
    pub reported: Range<usize>,
    /// Trials that calibrate; may be empty: then the development trials do.
    pub calibration: Vec<Trial>,
    /// Trials that an effect is found on.
    pub development: Vec<Trial>,
}

impl Case {
    /// Returns whether predictions come with the data.
    pub fn is_predicted(&self) -> bool {
        self.development.iter().all(|trial| trial.predicted.is_some()) && !self.development.is_empty()
    }
}
