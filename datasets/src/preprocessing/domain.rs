//! Domain filter: samples whose actuators lie where the nominal model was calibrated.
//!
//! Outside of the calibration trials' actuator coordinates the nominal model extrapolates, and its residual says more
//! about the extrapolation than about the robot. The domain is the convex hull of those coordinates for one or two
//! actuators (`hull`), the box of their ranges for any number (`box`), or everything (`none`). Lost markers were
//! skipped on reading; how many samples were dropped stays with each trial, by reason.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::error::DataError;
use crate::preprocessing::hull::{contains, convex_hull};
use crate::trial::{DropReason, Trial};

/// Samples this close to the border are inside, as a part of each actuator's range.
const TOLERANCE: f64 = 1e-9;

/// More points than these are replaced by the corners of their hull.
const POINTS: usize = 1 << 18;

/// Bounds of the domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DomainFilter {
    /// Convex hull, for one or two actuators.
    #[default]
    Hull,
    /// Range of each actuator.
    Box,
    /// No bounds.
    None,
}

/// Domain that the calibration trials cover.
#[derive(Debug, Clone, PartialEq)]
pub struct Domain {
    bounds: Bounds,
}

#[derive(Debug, Clone, PartialEq)]
enum Bounds {
    All,
    /// Least and greatest value of each actuator.
    Box(Vec<(f64, f64)>),
    /// Corners, with the coordinates scaled to their ranges.
    Hull {
        range: Vec<(f64, f64)>,
        corners: Vec<[f64; 2]>,
    },
}

/// Keeps the samples of `trials` within the domain of `calibration`; where there are no calibration trials, all.
///
/// # Errors
/// A hull of more than two actuators.
pub fn domain_filter(filter: DomainFilter, calibration: &[&Trial], trials: &[&Trial]) -> Result<Vec<Trial>, DataError> {
    let domain = Domain::fit(filter, calibration)?;
    Ok(trials.iter().map(|t| domain.keep(t)).collect())
}

impl Domain {
    /// The domain of the calibration trials.
    ///
    /// # Errors
    /// A hull of more than two actuators.
    pub fn fit(filter: DomainFilter, calibration: &[&Trial]) -> Result<Domain, DataError> {
        Domain::fit_stream(filter, || calibration.iter().map(|trial| Ok(Cow::Borrowed(*trial))))
    }

    /// As [`Domain::fit`], for trials that `calibration` reads one after the other, each time it is called.
    ///
    /// # Errors
    /// A hull of more than two actuators; a trial that cannot be read.
    pub fn fit_stream<'a, I>(filter: DomainFilter, calibration: impl Fn() -> I) -> Result<Domain, DataError>
    where
        I: Iterator<Item = Result<Cow<'a, Trial>, DataError>>,
    {
        let mut range: Vec<(f64, f64)> = Vec::new();
        for trial in calibration() {
            let trial = trial?;
            range.resize(range.len().max(trial.actuators.ncols()), (f64::INFINITY, f64::NEG_INFINITY));
            for ((least, greatest), column) in range.iter_mut().zip(trial.actuators.column_iter()) {
                *least = column.iter().copied().fold(*least, f64::min);
                *greatest = column.iter().copied().fold(*greatest, f64::max);
            }
        }
        let empty = range.iter().any(|(least, greatest)| least > greatest);
        if filter == DomainFilter::None || range.is_empty() || empty {
            return Ok(Domain { bounds: Bounds::All });
        }
        let bounds = match (filter, range.len()) {
            (DomainFilter::Hull, 2) => Bounds::Hull { corners: corners(calibration(), &range)?, range },
            (DomainFilter::Hull, actuators @ 3..) => {
                let message =
                    format!("domain_filter = \"hull\" takes one or two actuators and the set has {actuators}");
                return Err(DataError::NoHull(message + "; choose \"box\" or \"none\""));
            }
            _ => Bounds::Box(range),
        };
        Ok(Domain { bounds })
    }

    /// Whether actuators `[A]` lie within.
    pub fn contains(&self, actuators: &[f64]) -> bool {
        match &self.bounds {
            Bounds::All => true,
            Bounds::Box(range) => range.iter().zip(actuators).all(|((least, greatest), q)| {
                let margin = TOLERANCE * (greatest - least);
                (least - margin..=greatest + margin).contains(q)
            }),
            Bounds::Hull { range, corners } => match actuators {
                [a, b] => contains(corners, scaled(range, [*a, *b]), TOLERANCE),
                _ => false,
            },
        }
    }

    /// The trial's samples within; the others are counted.
    pub fn keep(&self, trial: &Trial) -> Trial {
        let inside = |t: &usize| self.contains(&trial.actuators.row(*t).iter().copied().collect::<Vec<_>>());
        let rows: Vec<usize> = (0..trial.samples()).filter(inside).collect();
        let mut kept = trial.select(&rows);
        kept.unmeasured = kept.unmeasured.and_then(|lost| Trial::some(self.keep(&lost)));
        if rows.len() < trial.samples() {
            *kept.dropped.entry(DropReason::OutsideDomain).or_insert(0) += trial.samples() - rows.len();
        }
        kept
    }
}

/// The convex hull of all samples. Of many points only the corners so far are kept.
fn corners<'a>(
    trials: impl Iterator<Item = Result<Cow<'a, Trial>, DataError>>,
    range: &[(f64, f64)],
) -> Result<Vec<[f64; 2]>, DataError> {
    let mut points = Vec::new();
    for trial in trials {
        points.extend(trial?.actuators.row_iter().map(|q| scaled(range, [q[0], q[1]])));
        if points.len() > POINTS {
            points = convex_hull(points);
        }
    }
    Ok(convex_hull(points))
}

/// Coordinates as parts of their ranges, so that a tolerance means the same along both.
fn scaled(range: &[(f64, f64)], q: [f64; 2]) -> [f64; 2] {
    let one = |a: usize| match range[a].1 - range[a].0 {
        0.0 => q[a] - range[a].0,
        width => (q[a] - range[a].0) / width,
    };
    [one(0), one(1)]
}
