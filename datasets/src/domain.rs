//! Domain filter: samples whose actuators lie where the nominal model was calibrated.
//!
//! Outside of the calibration trials' actuator coordinates the nominal model extrapolates, and its residual says more
//! about the extrapolation than about the robot. The domain is the convex hull of those coordinates for one or two
//! actuators (`hull`), the box of their ranges for any number (`box`), or everything (`none`). Lost markers were
//! skipped on reading; how many samples were dropped stays with each trial, by reason.

use serde::{Deserialize, Serialize};

use crate::error::DataError;
use crate::hull::{contains, convex_hull};
use crate::trial::{DropReason, Trial};

/// Samples this close to the border are inside, as a part of each actuator's range.
const TOLERANCE: f64 = 1e-9;

/// How the domain is bounded.
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

/// What the calibration trials cover.
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
    pub fn fit(filter: DomainFilter, calibration: &[&Trial]) -> Result<Domain, DataError> {
        let actuators = calibration.iter().map(|t| t.actuators.ncols()).max().unwrap_or(0);
        let samples: usize = calibration.iter().map(|t| t.samples()).sum();
        if filter == DomainFilter::None || actuators == 0 || samples == 0 {
            return Ok(Domain { bounds: Bounds::All });
        }
        let column = |a: usize| calibration.iter().flat_map(move |t| t.actuators.column(a).into_iter().copied());
        let least = |a| column(a).fold(f64::INFINITY, f64::min);
        let greatest = |a| column(a).fold(f64::NEG_INFINITY, f64::max);
        let range: Vec<(f64, f64)> = (0..actuators).map(|a| (least(a), greatest(a))).collect();
        let bounds = match (filter, actuators) {
            (DomainFilter::Hull, 2) => {
                let points = calibration.iter().flat_map(|t| t.actuators.row_iter());
                let points = points.map(|q| scaled(&range, [q[0], q[1]])).collect();
                Bounds::Hull { corners: convex_hull(points), range }
            }
            (DomainFilter::Hull, 3..) => {
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
        if rows.len() < trial.samples() {
            *kept.dropped.entry(DropReason::OutsideDomain).or_insert(0) += trial.samples() - rows.len();
        }
        kept
    }
}

/// Coordinates as parts of their ranges, so that a tolerance means the same along both.
fn scaled(range: &[(f64, f64)], q: [f64; 2]) -> [f64; 2] {
    let one = |a: usize| match range[a].1 - range[a].0 {
        0.0 => q[a] - range[a].0,
        width => (q[a] - range[a].0) / width,
    };
    [one(0), one(1)]
}
