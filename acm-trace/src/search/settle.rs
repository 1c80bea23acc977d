//! After the beam search: effects are dropped, exchanged and split while J falls; kinks of the map come last.

mod kinks;
mod minor;

use super::accept::{Tested, least_t, paired_t};
use super::candidates::{merged, plainer, price, steadied};
use super::scan::Losses;
use super::scored::{LEAST_FALL, Scored, Search};
use super::select::possible;
use super::tried::Tried;
use crate::fit::state::State;

/// Number of candidates that are tried in the place of an effect.
const EXCHANGED: usize = 2;

/// Largest number of rounds of drops and exchanges.
const ROUNDS: usize = 4;

impl Search<'_, '_> {
    /// Drops, exchanges and adds effects until nothing changes.
    pub(super) fn settle(&mut self, mut last: Scored) -> Scored {
        for _ in 0..ROUNDS {
            let before = last.1.labels(self.problem.rig);
            last = self.tidy(last);
            last = self.split(last);
            last = self.grow_once(last);
            if last.1.labels(self.problem.rig) == before {
                break;
            }
        }
        last
    }

    fn grow_once(&mut self, last: Scored) -> Scored {
        let size = last.1.effects.len() + usize::from(last.1.clock != 0.0);
        if size == 0 || size >= self.criteria.max_effects {
            return last;
        }
        let tried = self.expand(&last.1);
        let mut ranked = possible(&tried, self.problem.rig).enumerate();
        match ranked.find(|(rank, one)| self.tested(&last.1, &last.2, one, &tried, *rank == 0) == Tested::Passed) {
            Some((_, best)) => best.scored(),
            None => last,
        }
    }

    /// Drops and exchanges while J falls.
    fn tidy(&mut self, mut last: Scored) -> Scored {
        for _ in 0..ROUNDS {
            // J on equal terms with the last set.
            let mut best: Option<(f64, Scored, String)> = None;
            let bar = |best: &Option<(f64, Scored, String)>| best.as_ref().map_or(last.0 - LEAST_FALL, |best| best.0);
            for i in 0..last.1.effects.len() {
                for (simple, plain) in plainer(&last.1, i, self.library) {
                    let plain = self.settled(&plain);
                    if plain.0 < bar(&best) {
                        let change = format!("{} → {simple}", last.1.effects[i].label(self.problem.rig));
                        best = Some((plain.0, plain, change));
                    }
                }
            }
            for (change, fewer) in merged(self.problem, &last.1, self.library) {
                let fewer = self.settled(&fewer);
                if fewer.0 < bar(&best) {
                    best = Some((fewer.0, fewer, change));
                }
            }
            for (name, without) in self.smaller(&last.1) {
                let rest = self.settled(&without);
                let score = self.score(&self.on_equal_terms((&last.1, &last.2), (&rest.1, &rest.2)), &rest.1);
                if score < bar(&best) {
                    best = Some((score, rest.clone(), format!("− {name}")));
                }
                if last.1.effects.len() < 2 || !self.exchanges {
                    continue;
                }
                // The other effects keep their values: refined without it, they would absorb part of it.
                let tried = self.expand(&without);
                let others = possible(&tried, self.problem.rig).filter(|candidate| candidate.label != name);
                for candidate in others.take(EXCHANGED) {
                    let score = self.replacing((&last.1, &last.2), candidate).filter(|score| *score < bar(&best));
                    if let Some(score) = score
                        && self.tested(&rest.1, &rest.2, candidate, &tried, false) == Tested::Passed
                    {
                        best = Some((score, candidate.scored(), format!("{name} → {}", candidate.label)));
                    }
                }
            }
            let Some((_, next, change)) = best else { return last };
            self.note(&last.1, &last.2, &change, &next.2);
            last = next;
        }
        last
    }

    /// Replaces a size that depends on a signal by a constant one and another effect, or a refinement by the simpler effect and another,
    /// where that predicts better: either may imitate two effects.
    fn split(&mut self, last: Scored) -> Scored {
        if !self.exchanges {
            return last;
        }
        let mut best: Option<(f64, Scored, String)> = None;
        for i in 0..last.1.effects.len() {
            let plain = || plainer(&last.1, i, self.library).into_iter().next().map(|(_, plain)| plain);
            let Some(steady) = steadied(self.problem, &last.1, i, self.library).or_else(plain) else { continue };
            let name = last.1.effects[i].label(self.problem.rig);
            let rest = self.settled(&steady);
            let tried = self.expand(&rest.1);
            for candidate in possible(&tried, self.problem.rig).filter(|one| one.label != name).take(EXCHANGED) {
                let bar = best.as_ref().map_or(last.0 - LEAST_FALL, |best| best.0);
                let score = self.replacing((&last.1, &last.2), candidate).filter(|score| *score < bar);
                if let Some(score) = score
                    && self.tested(&rest.1, &rest.2, candidate, &tried, false) == Tested::Passed
                {
                    let change = format!("{name} → {}, {}", rest.1.effects[i].label(self.problem.rig), candidate.label);
                    best = Some((score, candidate.scored(), change));
                }
            }
        }
        let Some((_, next, change)) = best else { return last };
        self.note(&last.1, &last.2, &change, &next.2);
        next
    }

    /// Returns J of a candidate on equal terms with a set, where it may take that set's place: it costs less, or predicts significantly
    /// better over blocks.
    pub(super) fn replacing(&self, last: (&State, &Losses), candidate: &Tried) -> Option<f64> {
        let of = |state: &State| price(self.problem, state, self.criteria);
        let losses = self.on_equal_terms(last, (&candidate.state, &candidate.losses));
        let may =
            of(&candidate.state) < of(last.0) || paired_t(last.1, &losses) > least_t(last.1.len(), self.criteria.level);
        may.then(|| self.score(&losses, &candidate.state))
    }

    /// Returns the state without each of its effects, or without its clock correction.
    pub fn smaller(&self, state: &State) -> Vec<(String, State)> {
        let mut all: Vec<(String, State)> =
            state.effects.iter().enumerate().map(|(i, e)| (e.label(self.problem.rig), state.without(i))).collect();
        if state.clock != 0.0 {
            all.push((super::candidates::CLOCK.into(), State { clock: 0.0, ..state.clone() }));
        }
        all
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
    use crate::fit::state::Placed;
    use crate::search::criteria::Criteria;
    use crate::search::scan::{cross_validate, sum};

    /// Oracle: y = c + e with e = c d + w. A size of c that depends on d takes up c d, and w stays; c and e together leave nothing.
    /// Where w is what is recorded in the place of e, it adds nothing, and the size goes on depending on d.
    #[test]
    fn a_size_that_depends_on_a_signal_is_split_where_it_stands_for_two_effects() {
        let course = |rate: f64| -> Vec<f64> { bench::time().iter().map(|t| (rate * t).sin()).collect() };
        let (c, d, w) = (course(0.7), course(1.9), course(3.1));
        let still = vec![0.0; c.len()];
        for (size, expected) in [(0.5, vec!["context_term(c)", "context_term(e)"]), (0.0, vec!["context_term(c) × d"])]
        {
            let e: Vec<f64> = (0..c.len()).map(|k| c[k] * d[k] + size * w[k]).collect();
            let y = (0..c.len()).map(|k| c[k] + e[k]).collect();
            let rig = bench::rig(&["q"], &["c", "d", "e"], &["y"]);
            let signals = vec![c.clone(), d.clone(), if size > 0.0 { e } else { w.clone() }];
            let series = [bench::series(Record::new(bench::time(), vec![still.clone()], signals, vec![]), y)];
            let problem = Problem::new(&rig, &series, &[1.0], None);
            let library: Vec<Instance> =
                (0..3).map(|k| bench::placed("context_term", Carrier::Context(k), &rig, &[1.0]).instance).collect();
            let varied = library[0].with_context(Carrier::Context(1), &rig).unwrap();
            let theta = vec![1.0; varied.parameters().len()];
            let placed = Placed { instance: varied, theta, in_calibration: true };
            let bare = State::bare(Form { degree: Some(0), ..Form::LINEAR });
            let criteria = Criteria::default();
            let mut search = Search::plain(&problem, &library, &criteria);
            search.first = search.settled(&bare).2.iter().sum();
            let last = search.settled(&bare.with(placed));
            let split = search.split(last);
            assert_eq!(split.1.labels(&rig), expected, "{size}");
        }
    }

    /// Oracle: y = c + e, where e is what a lag of 1 s behind c = sin 0.7 t falls short of it, and w, beside noise. A term that follows c late takes up
    /// c and that lag, and w stays; terms of c and of e leave nothing. Where e is not recorded, the late term stays.
    #[test]
    fn a_refinement_is_split_where_it_stands_for_two_effects() {
        let (rate, swing) = (0.7f64, 0.7f64.hypot(1.0));
        let lagged = |t: f64| ((rate * t - rate.atan()).sin() + rate.atan().sin() * (-t).exp()) / swing;
        let time = bench::time();
        let c: Vec<f64> = time.iter().map(|t| (rate * t).sin()).collect();
        let w: Vec<f64> = time.iter().map(|t| 0.2 * (3.1 * t).sin()).collect();
        let e: Vec<f64> = (0..c.len()).map(|k| lagged(time[k]) - c[k] + w[k]).collect();
        let mut noise = bench::noise(0.02);
        let y: Vec<f64> = c.iter().zip(&e).map(|(c, e)| c + e + noise()).collect();
        let rig = bench::rig(&["q"], &["c", "e"], &["y"]);
        for (recorded, expected) in
            [(&e, vec!["context_term(c)", "context_term(e)"]), (&vec![0.0; c.len()], vec!["context_lag(c)"])]
        {
            let record = Record::new(time.clone(), vec![vec![0.0; c.len()]], vec![c.clone(), recorded.clone()], vec![]);
            let series = [bench::series(record, y.clone())];
            let problem = Problem::new(&rig, &series, &[1.0], None);
            let of = |name: &str, k: usize| bench::placed(name, Carrier::Context(k), &rig, &[1.0]);
            let library = [of("context_term", 0), of("context_term", 1), of("context_lag", 0)].map(|one| one.instance);
            let mut late = of("context_lag", 0);
            *late.theta.last_mut().unwrap() = 1.0;
            let bare = State::bare(Form { degree: Some(0), ..Form::LINEAR });
            let criteria = Criteria::default();
            let mut search = Search::plain(&problem, &library, &criteria);
            search.first = search.settled(&bare).2.iter().sum();
            let last = search.settled(&bare.with(late));
            assert_eq!(search.split(last).1.labels(&rig), expected);
        }
    }

    /// Oracle: y = q + 0.3 e^(−t/3 s) beside noise: a decay from the start of a trial is no effect. Creep has its initial state projected
    /// out, and predicts better by that alone; with a part of 0.2 that comes late it is an effect, and stays.
    #[test]
    fn an_unknown_start_is_no_reason_to_keep_an_effect() {
        let time = bench::time();
        let rig = bench::rig(&["q"], &[], &["y"]);
        let q: Vec<f64> = time.iter().map(|t| (0.7 * t).sin() + (1.9 * t).cos()).collect();
        let record = Record::new(time.clone(), vec![q.clone()], vec![], vec![]);
        for (share, expected) in [(0.0, vec![]), (0.2, vec!["creep"])] {
            let creep = bench::placed("creep", Carrier::Rig, &rig, &[share, 3.0]);
            let mut crept = vec![q.clone()];
            creep.instance.act(&creep.theta, &record, &mut crept);
            let mut noise = bench::noise(0.05);
            let y = time.iter().zip(&crept[0]).map(|(t, y)| y + 0.3 * (-t / 3.0).exp() + noise()).collect();
            let series = [bench::series(record.clone(), y)];
            let problem = Problem::new(&rig, &series, &[1.0], None);
            let (library, criteria) = ([creep.instance.clone()], Criteria::default());
            let mut search = Search::plain(&problem, &library, &criteria);
            let bare = State::bare(Form::LINEAR);
            let bare_losses = cross_validate(&problem, &bare).unwrap();
            search.first = sum(&bare_losses);
            let last = search.settled(&bare.with(creep));
            assert!(sum(&last.2) < 0.5 * sum(&bare_losses));
            // Nor to exchange one for it.
            let play = search.settled(&bare.with(bench::placed("backlash", Carrier::Rig, &rig, &[0.01])));
            let (score, state, losses) = last.clone();
            let creep = Tried { label: "creep".into(), state, score, scanned: score, losses, is_refined: true };
            let is_better =
                search.replacing((&play.1, &play.2), &creep).is_some_and(|score| score < play.0 - LEAST_FALL);
            assert!(creep.score < play.0 && is_better != expected.is_empty(), "{share}");
            assert_eq!(search.tidy(last).1.labels(&rig), expected, "{share}");
        }
    }
}
