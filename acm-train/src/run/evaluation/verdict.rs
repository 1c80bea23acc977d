//! Verdict: whether the network improves on the nominal model, over the folds.
//!
//! ```text
//! (e, λ)_f = argmin Σ_{g ≠ f} error_g(e, λ)          gain_f = √error_f(nominal) − √error_f(e_f, λ_f)
//! share_f = gain_f / √error_f(nominal)
//!
//! worth it:   mean_f share_f > t₀.₉₅(F − 1) · sd_f share_f / √F
//! ```
//!
//! | symbol  | meaning                                                                     | unit |
//! | ------- | --------------------------------------------------------------------------- | ---- |
//! | `f, g`  | folds, F of them: the units of the standard error                           | –    |
//! | `error` | mean squared distance on the trials that a fold leaves out ([`Projection`]) | m²   |
//! | `e, λ`  | epoch and factor; λ = 0 is the nominal model                                | –    |
//! | `gain`  | mean over seeds                                                             | m    |
//! | `share` | mean over seeds; folds whose errors differ in size are alike in it          | –    |
//! | `t₀.₉₅` | 95 % quantile of Student's distribution (crate statrs)                      | –    |
//!
//! So where there is nothing to learn, one verdict in twenty at most is wrong, as far as folds are independent. With one standard
//! error in the place of the quantile, networks on coloured noise or offsets pass too often (example `nothing_to_learn`).
//!
//! A fold that chose its own epoch and factor could only gain, so the other folds choose for it: runs of the same seed in
//! cross-validation. Where there is none, the final runs tell, which leave out one fold after the other, each with a seed of
//! its own. Runs without projections (outside baselines, `output_layer = "random"`, records of earlier versions) are evaluated by their
//! scores, which chose the epoch.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::spread::Spread;
use super::summary;
use crate::learn::Projection;
use crate::run::record::{RunRecord, Stage};

/// Share of cases without anything to learn in which the verdict is to be that nothing is.
const CONFIDENCE: f64 = 0.95;

/// Answer of a verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// The gain is larger than chance gives in one case of twenty.
    WorthIt,
    /// The gain is not: the nominal model is to be used.
    NotWorthIt,
    /// There are fewer than two folds.
    CannotBeTold,
}

/// Verdict of the folds on an experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Answer of the verdict.
    pub answer: Answer,
    /// Kind of the learner: `gru`, `ridge`.
    pub kind: String,
    /// Number of folds F.
    pub folds: usize,
    /// Mean gain over the folds, SI; none where there are no folds.
    pub gain: Option<f64>,
    /// Standard error of the gain, SI; none of fewer than two folds.
    pub standard_error: Option<f64>,
}

/// Returns the verdict from the records of one experiment; none without records.
pub fn of(records: &[&RunRecord]) -> Option<Verdict> {
    let kind = records.first()?.experiment.kind();
    Some(Verdict::of_gains(kind, &gains(records)))
}

/// Gain on one fold.
#[derive(Debug, Clone, Copy)]
struct Gain {
    /// Reduction of the error, SI.
    gain: f64,
    /// As a share of the nominal model's error.
    share: f64,
}

impl Gain {
    fn of(nominal: f64, error: f64) -> Self {
        let gain = nominal - error;
        Self { gain, share: if nominal > 0.0 { gain / nominal } else { 0.0 } }
    }
}

/// Returns the answer from the mean share that is gained over so many folds, and its standard error.
fn answer((share, standard_error): (f64, f64), folds: usize) -> Answer {
    let student = StudentsT::new(0.0, 1.0, folds as f64 - 1.0);
    let chance = student.map_or(f64::INFINITY, |student| student.inverse_cdf(CONFIDENCE));
    if share > chance * standard_error { Answer::WorthIt } else { Answer::NotWorthIt }
}

impl Verdict {
    fn of_gains(kind: String, gains: &[Gain]) -> Self {
        let folds = gains.len();
        let over_folds = |of: fn(&Gain) -> f64| {
            let spread = Spread::of(&gains.iter().map(of).collect::<Vec<_>>());
            let standard_error = spread.and_then(|spread| spread.sd).map(|sd| sd / (folds as f64).sqrt());
            (spread.map(|spread| spread.mean), standard_error)
        };
        let ((gain, standard_error), (share, its_error)) = (over_folds(|of| of.gain), over_folds(|of| of.share));
        let answer = share.zip(its_error).map_or(Answer::CannotBeTold, |told| answer(told, folds));
        Self { answer, kind, folds, gain, standard_error }
    }

    /// Returns the answer in words; `records` say in which unit.
    pub fn sentence(&self, records: &[&RunRecord]) -> String {
        let display =
            records.first().map(|first| summary::display(&first.data.unit, records.iter().map(|r| &r.validation)));
        let gain = display.zip(self.gain).map_or(String::new(), |(display, mean)| {
            display.with_symbol(&Spread { mean, sd: self.standard_error }.text(display.factor))
        });
        let (kind, folds) = (&self.kind, summary::count(self.folds, "fold"));
        match self.answer {
            Answer::WorthIt => {
                format!(
                    "The {kind} is worth it here: it gains {gain} (mean ± standard error over {folds} left out in turn)."
                )
            }
            Answer::NotWorthIt => format!(
                "No {} is worth it here: the {kind} gains {gain} (mean ± standard error over {folds} left out in turn), \
                 which chance alone may give. Use the nominal model as it is.",
                if self.is_network() { "network" } else { kind.as_str() }
            ),
            Answer::CannotBeTold => {
                format!("Whether the {kind} is worth it cannot be told from {folds}: it takes two. {}", remedy(records))
            }
        }
    }

    fn is_network(&self) -> bool {
        matches!(self.kind.as_str(), "mlp" | "gru" | "cfc")
    }
}

/// Returns advice on how to get two folds or more.
fn remedy(records: &[&RunRecord]) -> &'static str {
    let lists_one = |record: &&RunRecord| record.folds.as_ref().is_some_and(|folds| folds.count == 1);
    match records.iter().any(lists_one) {
        true => {
            "The manifest lists one: set protocol.leave_out = \"block\" and protocol.cross_validation = true, which leaves out blocks \
             of time in turn."
        }
        false => "Set protocol.cross_validation = true, or give protocol.seeds several.",
    }
}

/// Returns the gain of each fold, mean over seeds, in the order of the folds.
fn gains(records: &[&RunRecord]) -> Vec<Gain> {
    let validated = |record: &RunRecord| record.stage != Stage::Final;
    let final_only = !records.iter().any(|record| validated(record));
    let judges: Vec<&RunRecord> = records.iter().copied().filter(|record| final_only || validated(record)).collect();
    let folds: BTreeSet<usize> = judges.iter().filter_map(|record| left_out(record)).collect();
    if folds.len() < 2 && final_only {
        return vec![];
    }
    let of_fold = |f: usize| {
        let own = judges.iter().filter(|record| left_out(record) == Some(f));
        let gains = own.filter_map(|record| {
            let others = judges.iter().filter(|other| final_only || other.seed == record.seed);
            let others = others.filter(|other| left_out(other).is_some_and(|g| g != f)).copied();
            gain(record, &others.collect::<Vec<_>>())
        });
        let gains: Vec<Gain> = gains.collect();
        let mean = |of: fn(&Gain) -> f64| Some(Spread::of(&gains.iter().map(of).collect::<Vec<_>>())?.mean);
        Some(Gain { gain: mean(|of| of.gain)?, share: mean(|of| of.share)? })
    };
    folds.into_iter().filter_map(of_fold).collect()
}

/// Returns the fold that a run was not trained on; older final runs have none.
fn left_out(record: &RunRecord) -> Option<usize> {
    match record.stage {
        Stage::CrossValidation { fold } => Some(fold),
        Stage::Final if record.split.has_no_validation() => None,
        Stage::Final => record.folds.as_ref().map(|folds| folds.fold),
    }
}

/// Returns the gain on the part that one run left out, if the others choose; as it was scored where there is nothing to
/// choose from.
fn gain(own: &RunRecord, others: &[&RunRecord]) -> Option<Gain> {
    let blind = |record: &RunRecord| record.projections.is_empty();
    if blind(own) || others.is_empty() || others.iter().any(|other| blind(other)) {
        let error = |name: &str| own.validation.estimators.get(name).map(|score| score.rmse_total);
        return Some(Gain::of(error("nominal")?, error(&own.experiment.kind())?));
    }
    let last = others.iter().map(|other| other.projections.len()).max().unwrap_or(0);
    let pooled = |e: usize| {
        let mut sum = Projection::default();
        others.iter().for_each(|other| sum += at(other, e));
        (e, sum.factor(), sum.error(sum.factor()))
    };
    let (epoch, factor, _) = (0..last).map(pooled).min_by(|a, b| a.2.total_cmp(&b.2))?;
    let found = at(own, epoch);
    Some(Gain::of(found.error(0.0).sqrt(), found.error(factor).sqrt()))
}

/// Returns the projection after an epoch, counted from 0, or after the last that there was.
fn at(record: &RunRecord, epoch: usize) -> Projection {
    record.projections[epoch.min(record.projections.len() - 1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: t₀.₉₅ is 2.920 with 2 degrees of freedom and 2.015 with 5, in tables.
    #[test]
    fn a_gain_has_to_be_larger_than_chance() {
        for (folds, chance) in [(3, 2.920), (6, 2.015)] {
            assert_eq!(answer((chance + 0.001, 1.0), folds), Answer::WorthIt);
            assert_eq!(answer((chance - 0.001, 1.0), folds), Answer::NotWorthIt);
        }
        assert_eq!(answer((0.0, 0.0), 3), Answer::NotWorthIt);
    }

    /// Oracle: by hand. A tenth is gained on each fold, of 100, 10 and 8 mm: shares without spread, while gains of 10, 1 and 0.8 mm have a mean
    /// of 3.9 and a standard error of 3.0, whose quotient of 1.3 is below 2.920.
    #[test]
    fn folds_are_compared_by_their_shares() {
        let gains = [100.0, 10.0, 8.0].map(|nominal| Gain::of(nominal, 0.9 * nominal));
        let verdict = Verdict::of_gains("gru".into(), &gains);
        assert_eq!(verdict.answer, Answer::WorthIt);
        let (gain, error) = (verdict.gain.unwrap(), verdict.standard_error.unwrap());
        assert!((gain - 11.8 / 3.0).abs() < 1e-12 && gain < 2.920 * error, "{gain} ± {error}");
    }
}
