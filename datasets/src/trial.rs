//! One recorded run.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::ops::Range;
use std::path::PathBuf;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::manifest::Role;

/// Why samples of a trial are not compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DropReason {
    /// A measured cell is empty: the marker was lost. The inputs of the sample are used ([`Trial::unmeasured`]).
    MissingMarker,
    /// A cell of the vehicle's position or attitude is empty.
    MissingVehicle,
    /// Another source has no sample there: before its start, behind its end, or in a gap.
    MissingSource,
    /// The actuators are outside of what the calibration trials cover.
    OutsideDomain,
}

/// One recorded run in SI units: `T` samples, `A` actuators, `E` context signals, `M` outputs.
///
/// All its samples have all signals. Whatever has a memory (effects, windows) takes [`Trial::with_unmeasured`] instead.
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
    /// Samples before or between these that have all inputs and no output; its `measured` has no columns.
    pub unmeasured: Option<Box<Trial>>,
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

    /// Returns the number of samples, including those without an output.
    pub fn recorded(&self) -> usize {
        self.samples() + self.unmeasured.as_ref().map_or(0, |lost| lost.samples())
    }

    /// Returns all samples in the order of time, and the rows of this trial's own samples among them; in all other rows
    /// `measured` is NaN.
    pub fn with_unmeasured(&self) -> (Cow<'_, Trial>, Vec<usize>) {
        let own = self.samples();
        let Some(lost) = &self.unmeasured else { return (Cow::Borrowed(self), (0..own).collect()) };
        let time = |row: usize| if row < own { self.time[row] } else { lost.time[row - own] };
        let mut order: Vec<usize> = (0..self.recorded()).collect();
        order.sort_by(|a, b| time(*a).total_cmp(&time(*b)));
        let join = |own_part: &DMatrix<f64>, lost_part: &DMatrix<f64>| {
            let value = |row: usize, column: usize| {
                if row < own { own_part[(row, column)] } else { lost_part[(row - own, column)] }
            };
            DMatrix::from_fn(order.len(), own_part.ncols(), |row, column| value(order[row], column))
        };
        let both = |a: &Option<DMatrix<f64>>, b: &Option<DMatrix<f64>>| Some(join(a.as_ref()?, b.as_ref()?));
        let nothing = DMatrix::from_element(lost.samples(), self.measured.ncols(), f64::NAN);
        let whole = Trial {
            time: order.iter().map(|row| time(*row)).collect(),
            actuators: join(&self.actuators, &lost.actuators),
            context: join(&self.context, &lost.context),
            measured: join(&self.measured, &nothing),
            predicted: both(&self.predicted, &lost.predicted),
            vehicle: both(&self.vehicle, &lost.vehicle),
            unmeasured: None,
            ..self.select(&[])
        };
        (Cow::Owned(whole), (0..order.len()).filter(|row| order[*row] < own).collect())
    }

    /// Returns the samples of `rows`, which are increasing, and those without an output that lead up to the first of them or lie
    /// between them; what was left out before stays counted.
    pub fn select(&self, rows: &[usize]) -> Trial {
        let lost = self.unmeasured.as_ref().zip(rows.first().zip(rows.last()));
        let unmeasured = lost.and_then(|(lost, (first, last))| {
            let from = first.checked_sub(1).map_or(f64::NEG_INFINITY, |before| self.time[before]);
            let between = |row: &usize| from < lost.time[*row] && lost.time[*row] < self.time[*last];
            Trial::some(lost.select(&(0..lost.samples()).filter(between).collect::<Vec<_>>()))
        });
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
            unmeasured,
        }
    }

    /// Returns the samples of `rows` with the inputs of all samples before them, so that whatever has a memory begins at the start of
    /// the trial.
    pub fn select_with_past(&self, rows: Range<usize>) -> Trial {
        let part = self.select(&rows.clone().collect::<Vec<_>>());
        let (whole, own) = self.with_unmeasured();
        let (Some(first), Some(last)) = (own.get(rows.start), own.get(rows.end.wrapping_sub(1))) else { return part };
        let chosen: BTreeSet<usize> = own[rows.clone()].iter().copied().collect();
        let own: BTreeSet<usize> = own.iter().copied().collect();
        let leads = |row: &usize| row < first || !own.contains(row);
        let past = whole.select(&(0..*last).filter(|row| !chosen.contains(row) && leads(row)).collect::<Vec<_>>());
        let measured = DMatrix::zeros(past.samples(), 0);
        Trial { unmeasured: Trial::some(Trial { measured, unmeasured: None, ..past }), ..part }
    }

    /// Separates the inputs before the first sample with an output, where there are some, from the rest.
    pub fn apart_from_past(&self) -> (Option<Trial>, Trial) {
        let Some((lost, begins)) = self.unmeasured.as_ref().zip(self.time.first()) else { return (None, self.clone()) };
        let (before, within): (Vec<usize>, Vec<usize>) =
            (0..lost.samples()).partition(|sample| lost.time[*sample] < *begins);
        let with = |own: Trial, lost: Trial| Trial { unmeasured: Trial::some(lost), ..own };
        let past = (!before.is_empty()).then(|| with(self.select(&[]), lost.select(&before)));
        (past, with(self.clone(), lost.select(&within)))
    }

    /// Returns a trial of samples without an output, unless it has none.
    pub(crate) fn some(lost: Trial) -> Option<Box<Trial>> {
        (lost.samples() > 0).then(|| Box::new(lost))
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Six samples at 0, 1, 3, 4, 5, 6 s, and one without an output at 2 s; the actuator is the time.
    fn trial() -> Trial {
        let of = |times: &[f64], outputs: usize| Trial {
            name: "a".into(),
            role: Role::Development,
            time: times.to_vec(),
            actuators: DMatrix::from_column_slice(times.len(), 1, times),
            context: DMatrix::zeros(times.len(), 0),
            measured: DMatrix::from_element(times.len(), outputs, 7.0),
            predicted: None,
            vehicle: None,
            conditions: BTreeMap::new(),
            dropped: BTreeMap::new(),
            file: PathBuf::new(),
            unmeasured: None,
        };
        let lost = of(&[2.0], 0);
        Trial { unmeasured: Some(Box::new(lost)), ..of(&[0.0, 1.0, 3.0, 4.0, 5.0, 6.0], 1) }
    }

    /// Oracle: by hand.
    #[test]
    fn a_part_with_its_past_begins_where_the_trial_begins() {
        let part = trial().select_with_past(3..5);
        let (whole, own) = part.with_unmeasured();
        assert_eq!((part.time.as_slice(), own.as_slice()), (&[4.0, 5.0][..], &[4, 5][..]));
        assert_eq!(whole.actuators.as_slice(), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        assert!(whole.measured.iter().take(4).all(|value| value.is_nan()));
        assert_eq!(trial().select_with_past(0..6), trial());
        let (past, own) = part.apart_from_past();
        assert_eq!(past.unwrap().with_unmeasured().0.actuators.as_slice(), [0.0, 1.0, 2.0, 3.0]);
        assert_eq!(own, trial().select(&[3, 4]));
    }
}
