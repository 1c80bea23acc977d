//! From findings and truths to answers: the only place of the newer scores that knows how either is written.

use acm_sim::small_rigs::{self, Kind, Oracle, Recorded};
use acm_sim::twin::undeclared::{TrueEffect, Truth};
use acm_trace::finding::{Finding, FoundEffect, FoundParameter, Level};

use super::{
    claim::{Answer, Claim, Interval, TrueCause},
    parameters::parameters,
};

/// Half the width of a 95 % interval in standard errors.
const NORMAL: f64 = 1.96;

/// What a finding claims.
pub fn claims(finding: &Finding) -> Vec<Claim> {
    let claim = |effect: &FoundEffect| Claim {
        name: effect.name.clone(),
        signal: effect.carrier.clone(),
        sure: effect.confidence.level == Level::Sure,
        share: effect.confidence.share,
    };
    finding.effects.iter().map(claim).collect()
}

/// The answer to a campaign of the arm.
pub fn undeclared(truth: &Truth, finding: &Finding) -> Answer {
    let cause = |effect: &TrueEffect| TrueCause {
        name: effect.name.clone(),
        signal: None,
        also: effect.also.iter().map(|alias| alias.name.clone()).collect(),
        absence_shows: effect.separable,
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
        removed: finding.removed,
    }
}

/// The answer to a small rig.
pub fn small_rig(kind: Kind, rig: &Recorded, oracle: &Oracle, finding: &Finding) -> Answer {
    let cause = |(cause, separable): (&small_rigs::Cause, &bool)| TrueCause {
        name: cause.counterpart.as_ref().map(|counterpart| counterpart.effect.clone()),
        signal: cause.counterpart.as_ref().and_then(|counterpart| counterpart.signal.clone()),
        also: cause.also.clone(),
        absence_shows: *separable,
    };
    Answer {
        kind: kind.name().into(),
        causes: rig.truth.causes.iter().zip(&oracle.separable).map(cause).collect(),
        claims: claims(finding),
        intervals: intervals(rig, oracle, finding),
        removed: finding.removed,
    }
}

/// Intervals of values that were found under their own names, beside the width that the oracle would give.
fn intervals(rig: &Recorded, oracle: &Oracle, finding: &Finding) -> Vec<Interval> {
    let free = rig.truth.plant.free.iter().zip(&oracle.standard_errors);
    let found = |effect: &str, name: &str| -> Option<&FoundParameter> {
        let effect = finding.effects.iter().find(|found| found.name == effect)?;
        effect.parameters.iter().find(|parameter| parameter.name == name && parameter.depends_on.is_none())
    };
    let one = |(free, error): (&small_rigs::plant::Free, &f64)| {
        let counterpart = rig.truth.causes[free.cause?].counterpart.as_ref()?;
        let parameter = found(&counterpart.effect, &free.name)?;
        let ideal = Some(2.0 * NORMAL * error).filter(|width| width.is_finite() && *width > 0.0);
        Some(Interval { truth: free.value, tolerance: 0.0, interval: parameter.interval, ideal })
    };
    free.filter_map(one).collect()
}
