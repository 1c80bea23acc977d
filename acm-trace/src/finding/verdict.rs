//! The verdict, from the explained and the remaining error.

use serde::{Deserialize, Serialize};

use crate::finding::{Event, FoundEffect, Probe};

/// Verdict of the search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Verdict {
    /// Only noise is left.
    #[serde(rename = "no effect")]
    NoEffect,
    /// One effect (or several) explains what the model missed.
    #[serde(rename = "named")]
    Named,
    /// The effect is clear; its form is not quite that of the library.
    #[serde(rename = "named, form imperfect")]
    FormImperfect,
    /// An effect explains a part; the rest has another cause.
    #[serde(rename = "partial")]
    Partial,
    /// The inputs explain the remaining residual, but no known effect does.
    #[serde(rename = "unknown structure")]
    UnknownStructure,
    /// A slip, a spectral line, the offset of one trial.
    #[serde(rename = "event")]
    Event,
    /// The residual is not noise, and neither effects nor the probes of [`super::Left`] explain it.
    #[serde(rename = "unmeasured disturbance")]
    UnmeasuredDisturbance,
}

/// Whether a value rests on a bound that its effect admits: the effect imitates something else.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AtBound {
    /// No value.
    Nothing,
    /// A value of an effect that is not the largest: with a small residual the other effects stay named.
    Smaller,
    /// A value of the largest effect.
    Largest,
}

impl AtBound {
    /// Returns which of the effects, the largest first, rests on a bound.
    pub fn of(effects: &[FoundEffect]) -> Self {
        match effects.iter().position(FoundEffect::is_at_bound) {
            None => Self::Nothing,
            Some(0) => Self::Largest,
            Some(_) => Self::Smaller,
        }
    }
}

/// Evidence for a verdict; mean squares in the same unit.
#[derive(Debug, Clone)]
pub struct Evidence<'e> {
    /// Number of effects that were accepted.
    pub effects: usize,
    /// Which effect rests on a bound.
    pub at_bound: AtBound,
    /// Mean square left out, without effects.
    pub before: f64,
    /// Mean square left out, with the named effects.
    pub after: f64,
    /// Mean square of the white noise.
    pub noise: f64,
    /// Results of the probes that were run: whether inputs predict the remaining residual.
    pub probes: [Option<&'e Probe>; 2],
    /// Events sorted by share, the largest first.
    pub events: &'e [Event],
}

/// Family-wise error rate of the probes, shared equally. Bonferroni.
const BY_CHANCE: f64 = 0.05;

/// Multiple of the noise that still counts as noise.
const AT_FLOOR: f64 = 1.2;

impl Evidence<'_> {
    /// Returns the share of the removable error that was removed; none where nothing was to be removed.
    pub fn explained(&self) -> Option<f64> {
        let removable = self.before - self.noise;
        (removable > 0.09 * self.noise).then(|| (self.before - self.after) / removable)
    }

    /// Returns whether inputs predict a part of the remaining residual that matters.
    pub fn is_structured(&self) -> bool {
        let removable = (self.before - self.noise).max(0.0);
        let asked = self.probes.iter().flatten().count() as f64;
        self.probes.iter().flatten().any(|probe| {
            let power = probe.rms * probe.rms;
            probe.p <= BY_CHANCE / asked && power > 0.0625 * self.noise && power > 0.1 * removable
        })
    }

    fn is_at_floor(&self) -> bool {
        self.after <= AT_FLOOR * AT_FLOOR * self.noise
    }

    /// Returns the verdict.
    pub fn verdict(&self) -> Verdict {
        let explained = self.explained().unwrap_or(0.0);
        let event = self.events.first().is_some_and(|event| event.share > 0.6) && !self.is_at_floor();
        if self.effects > 0 {
            return match explained {
                e if self.is_at_floor() || e >= 0.95 => match self.at_bound {
                    AtBound::Largest => Verdict::Partial,
                    AtBound::Nothing | AtBound::Smaller => Verdict::Named,
                },
                e if self.at_bound != AtBound::Nothing && e >= 0.5 => Verdict::Partial,
                e if e >= 0.9 => Verdict::FormImperfect,
                _ if event => Verdict::Event,
                e if e >= 0.5 => Verdict::Partial,
                _ if self.is_structured() => Verdict::UnknownStructure,
                _ => Verdict::Partial,
            };
        }
        if self.is_at_floor() {
            Verdict::NoEffect
        } else if event {
            Verdict::Event
        } else if self.is_structured() {
            Verdict::UnknownStructure
        } else {
            Verdict::UnmeasuredDisturbance
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn probe(p: f64, rms: f64) -> Probe {
        Probe { explained: 0.5, by_chance: 0.05, p, rms }
    }

    fn slip(share: f64) -> Vec<Event> {
        vec![Event { kind: "slip".into(), share, what: String::new() }]
    }

    #[test]
    fn every_verdict_has_its_evidence() {
        let verdict = |effects, before, after, probe: Option<Probe>, events: &[Event]| {
            let at_bound = AtBound::Nothing;
            Evidence { effects, at_bound, before, after, noise: 1.0, probes: [probe.as_ref(), None], events }.verdict()
        };
        assert_eq!(verdict(0, 1.02, 1.02, None, &[]), Verdict::NoEffect);
        assert_eq!(verdict(1, 50.0, 1.1, None, &[]), Verdict::Named);
        assert_eq!(verdict(1, 50.0, 2.5, Some(probe(0.02, 1.0)), &[]), Verdict::Named);
        assert_eq!(verdict(1, 50.0, 5.0, None, &[]), Verdict::FormImperfect);
        assert_eq!(verdict(1, 50.0, 20.0, None, &[]), Verdict::Partial);
        assert_eq!(verdict(0, 50.0, 50.0, Some(probe(0.02, 5.0)), &[]), Verdict::UnknownStructure);
        assert_eq!(verdict(0, 50.0, 50.0, Some(probe(0.4, 5.0)), &[]), Verdict::UnmeasuredDisturbance);
        assert_eq!(verdict(0, 50.0, 50.0, Some(probe(0.02, 5.0)), &slip(0.9)), Verdict::Event);
    }

    /// Either probe is enough; of two each needs half the probability.
    #[test]
    fn a_network_sees_what_a_regression_does_not() {
        let verdict = |linear: &Probe, network: &Probe| {
            let (before, after, probes) = (50.0, 50.0, [Some(linear), Some(network)]);
            Evidence { effects: 0, at_bound: AtBound::Nothing, before, after, noise: 1.0, probes, events: &[] }
                .verdict()
        };
        let (seen, doubtful, nothing) = (probe(0.01, 5.0), probe(0.04, 5.0), probe(0.4, 5.0));
        assert_eq!(verdict(&nothing, &seen), Verdict::UnknownStructure);
        assert_eq!(verdict(&seen, &nothing), Verdict::UnknownStructure);
        assert_eq!(verdict(&doubtful, &nothing), Verdict::UnmeasuredDisturbance);
    }

    #[test]
    fn what_rests_on_a_bound_is_not_named() {
        let of = |at_bound, after| {
            let before = 50.0;
            Evidence { effects: 2, at_bound, before, after, noise: 1.0, probes: [None; 2], events: &[] }.verdict()
        };
        let all = [AtBound::Nothing, AtBound::Smaller, AtBound::Largest];
        assert_eq!(all.map(|of_all| of(of_all, 1.1)), [Verdict::Named, Verdict::Named, Verdict::Partial]);
        assert_eq!(all.map(|of_all| of(of_all, 5.0)), [Verdict::FormImperfect, Verdict::Partial, Verdict::Partial]);
    }
}
