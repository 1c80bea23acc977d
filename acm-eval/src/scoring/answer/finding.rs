//! Conversion of findings and truths to answers.

use acm_sim::small_rigs::{self, Kind, Oracle, Recorded};
use acm_sim::twin::undeclared::{TrueEffect, Truth};
use acm_trace::finding::{Errors, Finding, FoundEffect, FoundParameter, Level};

use super::claim::{Alias, Answer, Claim, Interval, TrueCause};
use crate::scoring::aliases::Table;
use crate::scoring::single::parameters;

/// Returns the claims of a finding.
pub fn claims(finding: &Finding) -> Vec<Claim> {
    let claim = |effect: &FoundEffect| Claim {
        name: effect.name.clone(),
        signal: effect.carrier.clone(),
        sure: effect.confidence.level == Level::Sure,
        share: effect.confidence.share,
        doubts: effect.doubts.clone(),
    };
    finding.effects.iter().map(claim).collect()
}

/// Returns the answer to a campaign of the arm.
pub fn undeclared(truth: &Truth, finding: &Finding) -> Answer {
    let place = truth.design.name();
    let cause = |effect: &TrueEffect| TrueCause {
        signal: None,
        absence_shows: effect.separable,
        missed: effect.missed,
        ..named(place, effect.name.as_deref()).contained_in(&effect.contained_in)
    };
    let intervals = parameters(&truth.effects, &finding.effects).into_iter().map(|row| Interval {
        truth: row.truth,
        tolerance: row.tolerance,
        interval: row.interval,
        ideal: None,
    });
    Answer {
        kind: truth.kind.clone(),
        causes: truth.effects.iter().map(cause).collect(),
        claims: claims(finding),
        intervals: intervals.collect(),
        removed: removed(finding.errors.baselines.best().value, finding.errors.after.value, truth.irreducible_mm / MM),
        over_best: over_best(&finding.errors),
    }
}

/// Share of the floor's mean square below which there is nothing to remove.
const NOTHING: f64 = 0.09;

/// Number of millimetres in a metre.
const MM: f64 = 1e3;

/// Computes F = (b² − a²)/(b² − floor²), b of the best baseline.
fn removed(best: f64, after: f64, floor: f64) -> Option<f64> {
    let removable = best * best - floor * floor;
    (removable > NOTHING * floor * floor).then(|| (best * best - after * after) / removable)
}

/// Returns the answer to a small rig. `scatter`: standard deviations of the oracle's values over redraws of the noise,
/// which are computed where an interval is claimed.
pub fn small_rig(
    kind: Kind,
    rig: &Recorded,
    oracle: &Oracle,
    finding: &Finding,
    scatter: impl FnOnce() -> Vec<f64>,
) -> Answer {
    let cause = |(k, cause): (usize, &small_rigs::Cause)| {
        let counterpart = cause.counterpart.as_ref();
        TrueCause {
            signal: counterpart.and_then(|counterpart| counterpart.signal.clone()),
            absence_shows: oracle.separable[k],
            missed: oracle.missed[k],
            ..named(kind.name(), counterpart.map(|counterpart| counterpart.effect.as_str()))
        }
    };
    Answer {
        kind: kind.name().into(),
        causes: rig.truth.causes.iter().enumerate().map(cause).collect(),
        claims: claims(finding),
        intervals: intervals(rig, finding, scatter),
        removed: finding.removed,
        over_best: over_best(&finding.errors),
    }
}

/// Returns a cause with the entry of its name in the committed table.
fn named(place: &str, name: Option<&str>) -> TrueCause {
    let table = Table::committed();
    let also = name.map(|name| table.mutual(place, name)).unwrap_or_default();
    TrueCause {
        name: name.map(Into::into),
        signal: None,
        also: also.into_iter().map(|(name, share)| Alias { name, share }).collect(),
        absence_shows: false,
        missed: 0.0,
        imitated: name.map_or(0.0, |name| table.imitated(place, name)),
    }
}

fn over_best(errors: &Errors) -> Option<f64> {
    let ratio = errors.after.value / errors.baselines.best().value;
    ratio.is_finite().then_some(ratio)
}

/// Half width of a 95 % interval in standard deviations.
const NORMAL: f64 = 1.96;

/// Returns the intervals of values that were found under their own names, beside the ideal width.
fn intervals(rig: &Recorded, finding: &Finding, scatter: impl FnOnce() -> Vec<f64>) -> Vec<Interval> {
    let found = |effect: &str, name: &str| -> Option<&FoundParameter> {
        let effect = finding.effects.iter().find(|found| found.name == effect)?;
        // A rig states a size that depends on a signal at the signal's middle, the library where the signal is zero.
        if effect.parameters.iter().any(|size| size.depends_on.is_some() && size.name.starts_with(name)) {
            return None;
        }
        effect.parameters.iter().find(|parameter| parameter.name == name && parameter.depends_on.is_none())
    };
    let one = |(k, free): (usize, &small_rigs::plant::Free)| {
        let counterpart = rig.truth.causes[free.cause?].counterpart.as_ref()?;
        let parameter = found(&counterpart.effect, &free.name)?;
        Some((k, Interval { truth: free.value, tolerance: 0.0, interval: parameter.interval, ideal: None }))
    };
    let claimed: Vec<(usize, Interval)> = rig.truth.plant.free.iter().enumerate().filter_map(one).collect();
    if claimed.is_empty() {
        return vec![];
    }
    let scatter = scatter();
    let ideal = |k: usize| scatter.get(k).map(|s| 2.0 * NORMAL * s).filter(|width| width.is_finite() && *width > 0.0);
    claimed.into_iter().map(|(k, interval)| Interval { ideal: ideal(k), ..interval }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: hand arithmetic.
    #[test]
    fn share_of_the_removable_error() {
        let share = removed(5.0, 3.5, 3.0).unwrap_or(f64::NAN);
        assert!((share - (25.0 - 12.25) / 16.0).abs() < 1e-12);
        assert_eq!(removed(3.1, 3.0, 3.0), None);
    }
}
