//! Acceptance of a candidate: its practical size, its gain over blocks, and the gain of the best of all candidates by
//! chance.

mod imitation;
mod start;

use acm_core::effects::ParameterSpec;
use acm_core::rig::Rig;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::candidates::{candidates, new_in};
use super::chance::{Draws, largest_by_chance};
use super::scan::{Losses, sum};
use super::scored::{Search, key};
use super::step::{LISTED, Step};
use super::tried::Tried;
use crate::agreement::excess;
use crate::fit::state::State;

/// Result of the tests of a candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Tested {
    /// It is no improvement, or stands for something else.
    Failed,
    /// It gains in too few blocks, no more than the best of all candidates does by chance, or no more than a static map. The residual may
    /// still contain another effect.
    Unproven {
        /// Relative reduction of the cross-validated mean square.
        gain: f64,
        /// Whether a static map predicts as well.
        is_imitated: bool,
    },
    /// It is accepted.
    Passed,
}

impl Search<'_, '_> {
    /// Tests practical size, paired t over blocks, and the largest gain on surrogates.
    pub(super) fn tested(
        &mut self,
        state: &State,
        losses: &Losses,
        candidate: &Tried,
        tried: &[Tried],
        note: bool,
    ) -> Tested {
        let forgiven = self.forgiven(state, losses, &candidate.state);
        let losses = &forgiven;
        let gain = 1.0 - sum(&candidate.losses) / sum(losses);
        let t = paired_t(losses, &candidate.losses);
        let improves = candidate.score < self.score(losses, state)
            && !rests_on_bound(candidate, self.problem.rig)
            && !self.cancels(&candidate.state)
            && !self.is_nominal_misfit(state, losses, candidate)
            && !self.is_noise_of_encoders(state, candidate)
            && self.is_better_as_saved((candidate.score, &candidate.state), (self.score(losses, state), state));
        let is_imitated = improves && self.is_static_misfit(state, candidate);
        let exceeds = |level: f64| t > least_t(losses.len(), level);
        let is_tried = improves && !is_imitated && exceeds(self.criteria.few);
        let by_chance = is_tried.then(|| self.threshold(state, candidate));
        // A gain that is far above chance may be in few blocks.
        let least = |by_chance: f64| {
            let multiple = if exceeds(self.criteria.level) { 1.0 } else { self.criteria.clear };
            one_after_another(by_chance, multiple)
        };
        let tested = match by_chance {
            Some(by_chance) if gain > least(by_chance) => Tested::Passed,
            _ if improves => Tested::Unproven { gain, is_imitated },
            _ => Tested::Failed,
        };
        if note {
            let candidates = tried.iter().take(LISTED).map(|t| (t.label.clone(), self.rms(&t.losses))).collect();
            self.steps.push(Step {
                on: state.labels(self.problem.rig),
                change: format!("+ {}", candidate.label),
                gain,
                by_chance,
                t,
                accepted: tested == Tested::Passed,
                error: self.rms(&candidate.losses),
                candidates,
            });
        }
        tested
    }

    /// Returns whether a set has a smaller J than another where the errors are those of the models that would be saved.
    pub(crate) fn is_better_as_saved(&self, new: (f64, &State), old: (f64, &State)) -> bool {
        let saved =
            |(score, state): (f64, &State)| score + excess(self.problem, state, self.criteria.negligible * self.first);
        saved(new) < saved(old)
    }

    /// Returns the quantile of the largest gain of any candidate where the residuals of the larger model are added to
    /// the fit of the smaller one.
    fn threshold(&mut self, state: &State, larger: &Tried) -> f64 {
        let key = key(state, self.problem);
        if let Some(known) = self.thresholds.get(&key) {
            return *known;
        }
        let value = self.by_chance(state, &larger.state);
        self.thresholds.insert(key, value);
        value
    }

    /// Returns that quantile for one larger model.
    pub(super) fn by_chance(&self, state: &State, larger: &State) -> f64 {
        let all = candidates(self.problem, state, self.library, self.clock);
        let draws = Draws { count: self.criteria.surrogates, family_wise: self.criteria.family_wise, seed: self.seed };
        largest_by_chance(self.quick, state, larger, &all, draws).unwrap_or(f64::INFINITY)
    }
}

/// Returns the gain 1 − (1 − g)ᵐ of `multiple` m gains g one after another: its logarithm ln(1/(1 − gain)) is m times that of g.
fn one_after_another(gain: f64, multiple: f64) -> f64 {
    1.0 - (1.0 - gain).powf(multiple)
}

/// Returns the value that Student's t of a mean over blocks exceeds with the probability `level`.
pub fn least_t(blocks: usize, level: f64) -> f64 {
    let student = StudentsT::new(0.0, 1.0, blocks.saturating_sub(1).max(1) as f64);
    student.map_or(f64::INFINITY, |student| student.inverse_cdf(1.0 - level))
}

/// Returns the mean fall over blocks in its standard errors: of the sums of squares or of their logarithms, whichever is larger.
pub fn paired_t(before: &[f64], after: &[f64]) -> f64 {
    let pairs = || before.iter().zip(after);
    let absolute = t_of(pairs().map(|(before, after)| before - after).collect());
    let floor = f64::MIN_POSITIVE;
    let relative = t_of(pairs().map(|(before, after)| (before.max(floor) / after.max(floor)).ln()).collect());
    absolute.max(relative)
}

fn t_of(falls: Vec<f64>) -> f64 {
    let n = falls.len() as f64;
    let mean = falls.iter().sum::<f64>() / n;
    let variance = falls.iter().map(|fall| (fall - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    mean / (variance / n).sqrt().max(f64::MIN_POSITIVE)
}

/// Returns whether a time of the new effect rests on a bound that the trials set. Then it imitates something else.
pub fn rests_on_bound(candidate: &Tried, rig: &Rig) -> bool {
    let Some(new) = new_in(&candidate.label, &candidate.state, rig) else { return false };
    let placed = &candidate.state.effects[new];
    let rests = |spec: &ParameterSpec, value: f64| value > NEAR * spec.upper || NEAR * value < spec.lower;
    let mut specs = placed.instance.parameters().iter().zip(&placed.theta);
    // The window of a derivative is no time of the rig.
    specs.any(|(spec, value)| spec.is_free() && spec.unit == "s" && spec.name != "window" && rests(spec, *value))
}

/// Ratio of a value to a bound above which it rests there.
const NEAR: f64 = 0.99;

#[cfg(test)]
mod tests {
    use acm_core::effects::Carrier;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;
    use crate::fit::state::Placed;

    /// Oracle: by hand. A creep at its longest time stands for something else; beside it a play may still be found.
    #[test]
    fn only_the_new_effect_may_not_rest_on_a_bound() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let creep = bench::placed("creep", Carrier::Rig, &rig, &[]);
        let tau = creep.instance.parameters().iter().position(|spec| spec.unit == "s").unwrap();
        let longest = creep.instance.parameters()[tau].upper;
        let theta = creep.theta.iter().enumerate().map(|(j, value)| if j == tau { longest } else { *value }).collect();
        let creep = Placed { theta, ..creep };
        let state = State::bare(Form::LINEAR).with(creep).with(bench::placed("backlash", Carrier::Rig, &rig, &[0.1]));
        let rests = |name: &str| {
            let (label, state) = (name.to_string(), state.clone());
            rests_on_bound(&Tried { label, state, score: 0.0, scanned: 0.0, losses: vec![], is_refined: true }, &rig)
        };
        assert_eq!([rests("creep"), rests("backlash")], [true, false]);
    }

    /// Oracle: by hand; what gains a half three times leaves an eighth.
    #[test]
    fn gains_one_after_another() {
        assert_eq!([1.0, 3.0].map(|multiple| one_after_another(0.5, multiple)), [0.5, 0.875]);
    }

    /// Oracle: the table of Student's distribution, and the textbook's t of a mean.
    #[test]
    fn gains_are_compared_with_a_tables_t() {
        for (blocks, table) in [(12, 2.718), (17, 2.583), (24, 2.500)] {
            assert!((least_t(blocks, 0.01) - table).abs() < 5e-4, "{blocks}");
        }
        let (before, after) = ([4.0, 6.0, 5.0, 7.0], [3.0, 4.0, 4.0, 4.0]);
        // Falls 1, 2, 1, 3: mean 1.75, deviation 0.957.
        assert!((t_of(vec![1.0, 2.0, 1.0, 3.0]) - 3.656).abs() < 1e-3);
        assert!(paired_t(&before, &after) >= 3.656 - 1e-3);
        assert!(paired_t(&after, &before) < 0.0);
    }
}
