//! Minor effects: they predict better beside the effects that are named, by too little to be named themselves.
//!
//! A small cause is often too small, or too similar to others, for a claim; without it the named effects absorb part of it, and the model
//! predicts worse than the data allow. Minor effects pass every test of [`accept`](crate::search::accept) at a share of the price, and are
//! part of the saved model.

use crate::search::accept::Tested;
use crate::search::criteria::Criteria;
use crate::search::scored::{Scored, Search, Trials};
use crate::search::select::{Selected, possible};

/// Number of candidates that are refined: more than for named effects, since small effects rank low.
const REFINED: usize = 25;

impl Search<'_, '_> {
    /// Returns the set of named effects with minor ones beside them; the set itself where it names nothing, or none passes.
    pub(in crate::search) fn with_minor(&self, selected: &Selected) -> Scored {
        let (named, losses) = (&selected.last, &selected.last_losses);
        let price = self.criteria.minor * self.criteria.price;
        let criteria = Criteria { price, refined: REFINED, ..self.criteria.clone() };
        let trials = Trials { problem: self.problem, quick: self.quick };
        let mut search = Search::new(trials, self.library, &criteria, self.seed, false);
        search.first = self.first;
        let mut last = (search.score(losses, named), named.clone(), losses.clone());
        if named.labels(self.problem.rig).is_empty() {
            return last;
        }
        let mut grown = false;
        while last.1.effects.len() < criteria.max_effects {
            let tried = search.expand(&last.1);
            let mut kept = possible(&tried, self.problem.rig).filter(|one| one.state.keeps(named, self.problem.rig));
            let next = kept.find(|one| search.tested(&last.1, &last.2, one, &tried, false) == Tested::Passed);
            let Some(next) = next else { break };
            last = next.scored();
            grown = true;
        }
        if !grown {
            return last;
        }
        let polished = search.polished(last.clone());
        if polished.1.keeps(named, self.problem.rig) { polished } else { last }
    }
}

#[cfg(test)]
mod tests {
    use acm_core::effects::Carrier;
    use acm_core::effects::instance::Instance;
    use acm_core::record::Record;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;
    use crate::fit::problem::Problem;
    use crate::fit::state::State;
    use crate::search::scan::{cross_validate, sum};

    /// Oracle: a term d of a power p beside noise of the power 1 leaves 1 of 1 + p where it is added, so J falls by ln(1 + p): between
    /// 0.03 and 0.1 it is a minor effect, below 0.03 it is none. The set of the effects that are named is never changed.
    #[test]
    fn an_effect_too_small_to_be_named_is_minor() {
        let course = |rate: f64| -> Vec<f64> { bench::time().iter().map(|t| (rate * t).sin()).collect() };
        let (c, d) = (course(0.7), course(1.9));
        let mut noise = bench::noise(1.0);
        let noise: Vec<f64> = (0..c.len()).map(|_| 0.1 * 12f64.sqrt() * noise()).collect();
        for (power, expected) in [(0.07, vec!["context_term(c)", "context_term(d)"]), (0.01, vec!["context_term(c)"])] {
            let size = 0.1 * (2.0_f64 * power).sqrt();
            let y = (0..c.len()).map(|k| c[k] + size * d[k] + noise[k]).collect();
            let rig = bench::rig(&["q"], &["c", "d"], &["y"]);
            let still = vec![vec![0.0; c.len()]];
            let series = [bench::series(Record::new(bench::time(), still, vec![c.clone(), d.clone()], vec![]), y)];
            let problem = Problem::new(&rig, &series, &[1.0], None);
            let library: Vec<Instance> =
                (0..2).map(|k| bench::placed("context_term", Carrier::Context(k), &rig, &[1.0]).instance).collect();
            let criteria = Criteria::default();
            let mut search = Search::plain(&problem, &library, &criteria);
            let bare = State::bare(Form { degree: Some(0), ..Form::LINEAR });
            let bare_losses = cross_validate(&problem, &bare).unwrap();
            search.first = sum(&bare_losses);
            let named = bare.with(bench::placed("context_term", Carrier::Context(0), &rig, &[1.0]));
            let (_, last, last_losses) = search.settled(&named);
            let settled = (last.clone(), last_losses.clone());
            let selected = Selected { bare, bare_losses, settled, last, last_losses };
            assert!(search.grow_once((0.0, selected.last.clone(), selected.last_losses.clone())).1.effects.len() == 1);
            assert_eq!(search.with_minor(&selected).1.labels(&rig), expected, "{power}");
        }
    }
}
