//! Case: a rig, its nominal model, and recordings that may be searched; held-out trials are a type of their own,
//! [`crate::holdout::Holdout`].

use std::borrow::Cow;
use std::ops::Range;

use acm_core::nominal::NominalSpec;
use acm_core::record::Record;
use acm_core::rig::Rig;
use nalgebra::DMatrix;

/// One recorded trial of T samples.
#[derive(Debug, Clone)]
pub struct Trial {
    /// Unique name.
    pub name: String,
    /// Signals.
    pub record: Record,
    /// Signals right before the trial, where it was cut from a longer record: they set the initial memory of effects.
    pub lead: Option<Record>,
    /// Measured outputs [T×M], SI; a row of NaN where none was measured: effects remember the signals of these samples, and
    /// nothing is compared there.
    pub measured: DMatrix<f64>,
    /// The prediction that came with the data [T×M].
    pub predicted: Option<DMatrix<f64>>,
    /// Difference s − g [T×M] between the given prediction s and the polynomial g that approximates it, once there is
    /// one; see `acm_core::nominal`.
    pub offset: Option<DMatrix<f64>>,
}

impl Trial {
    /// Returns the samples whose outputs were measured.
    pub fn measured_rows(&self) -> Vec<usize> {
        (0..self.measured.nrows()).filter(|&t| self.measured.row(t).iter().all(|y| y.is_finite())).collect()
    }

    /// Returns the lead and the trial joined, and the number of lead samples: a multiple of `stride`.
    pub fn led(&self, stride: usize) -> (Cow<'_, Record>, usize) {
        // Given predictions begin with the trial.
        let Some(lead) = self.lead.as_ref().filter(|_| self.predicted.is_none()) else {
            return (Cow::Borrowed(&self.record), 0);
        };
        let rows: Vec<usize> = (lead.samples() % stride..lead.samples()).collect();
        (Cow::Owned(lead.select(&rows).followed_by(&self.record)), rows.len())
    }
}

/// A rig and what was recorded on it.
#[derive(Debug, Clone)]
pub struct Case {
    /// Signals and mechanics.
    pub rig: Rig,
    /// The nominal model, to be calibrated; ignored where predictions come with the data.
    pub nominal: NominalSpec,
    /// Position s/L of each marker; empty where the outputs are not markers.
    pub at: Vec<f64>,
    /// Outputs whose errors are reported: those of the tip, or all.
    pub reported: Range<usize>,
    /// Calibration trials; where empty, the development trials calibrate.
    pub calibration: Vec<Trial>,
    /// Trials on which effects are found.
    pub development: Vec<Trial>,
}

impl Case {
    /// Returns whether predictions come with the data.
    pub fn is_predicted(&self) -> bool {
        self.development.iter().all(|trial| trial.predicted.is_some()) && !self.development.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn what_leads_up_to_a_trial_comes_before_it() {
        let record =
            |time: &[f64]| Record::new(time.to_vec(), vec![time.iter().map(|t| 2.0 * t).collect()], vec![], vec![]);
        let lead = Some(record(&[0.0, 0.1, 0.2]));
        let measured = DMatrix::zeros(2, 1);
        let trial =
            Trial { name: String::new(), record: record(&[0.3, 0.4]), lead, measured, predicted: None, offset: None };
        let led = |stride: usize| {
            let (led, lead) = trial.led(stride);
            (lead, led.into_owned())
        };
        assert_eq!(led(1), (3, record(&[0.0, 0.1, 0.2, 0.3, 0.4])));
        assert_eq!(led(2), (2, record(&[0.1, 0.2, 0.3, 0.4])));
        let alone = Trial { lead: None, ..trial.clone() };
        assert_eq!((alone.led(1).1, alone.led(1).0.samples()), (0, 2));
    }
}
