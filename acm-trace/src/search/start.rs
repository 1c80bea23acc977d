//! What an unknown start of each trial explains by itself, which is no gain of an effect.
//!
//! An effect with a memory has a state at the start of a trial that nothing recorded tells, and that is taken out of the trial
//! ([`unrecorded`](crate::fit::unrecorded)). What is slow, such as a drift of the measurement, looks much like a start that fades. So sets are
//! compared with the same start forgiven to both.

use acm_core::effects::Mode;

use super::scan::{Losses, cross_validate, sum};
use super::scored::Search;
use super::tried::Tried;
use crate::fit::problem::Problem;
use crate::fit::state::{State, modes};

impl Search<'_, '_> {
    /// Returns the losses of a state, with as long a time forgiven at the start of each trial as the candidate's memory
    /// takes, where that is less.
    pub(super) fn forgiven(&self, state: &State, losses: &Losses, candidate: &State) -> Losses {
        let forgiven = longer(state, candidate).and_then(|modes| forgiving(self.problem, state, modes));
        forgiven.filter(|forgiven| sum(forgiven) < sum(losses)).unwrap_or_else(|| losses.clone())
    }

    /// Returns the losses of another set as they compare with those of `own`: both forgive the start of each trial as long as the longer
    /// of their memories lasts.
    pub(super) fn on_equal_terms(&self, own: (&State, &Losses), other: (&State, &Losses)) -> Losses {
        let own_alike = self.forgiven(own.0, own.1, other.0);
        let alike = self.forgiven(other.0, other.1, own.0);
        alike.iter().zip(own.1).zip(&own_alike).map(|((alike, own), own_alike)| alike + (own - own_alike)).collect()
    }
}

/// Returns the modes of a candidate where one of them fades later than that of a state.
fn longer(state: &State, candidate: &State) -> Option<Vec<Mode>> {
    let (theirs, own) = (modes(candidate), modes(state));
    let is_longer = |(their, own): (&Mode, Option<&Mode>)| own.is_none_or(|own| their.memory > own.memory);
    theirs.iter().enumerate().any(|(k, their)| is_longer((their, own.get(k)))).then_some(theirs)
}

fn forgiving(problem: &Problem, state: &State, forgiven: Vec<Mode>) -> Option<Losses> {
    cross_validate(problem, &State { forgiven, ..state.clone() })
}

/// Falls of J by starts that are forgiven to one state, by their modes.
pub struct Starts<'s> {
    state: &'s State,
    /// Its sum of squares on the trials with fewer samples.
    loss: Option<f64>,
    known: Vec<(Vec<Mode>, f64)>,
}

impl<'s> Starts<'s> {
    /// Returns them before any is asked for.
    pub fn new(search: &Search, state: &'s State) -> Self {
        Self { state, loss: cross_validate(search.quick, state).map(|losses| sum(&losses)), known: vec![] }
    }

    /// Adds to the score of a candidate what J of the state falls by with its start alone.
    pub fn charge(&mut self, search: &Search, one: &mut Tried) {
        one.score += self.fall(search, &one.state);
    }

    /// Sorts candidates by their scores; of the `first` none gains by its start.
    pub fn sort(&mut self, search: &Search, tried: Vec<Tried>, first: usize) -> Vec<Tried> {
        let mut all: Vec<(Tried, bool)> = tried.into_iter().map(|one| (one, false)).collect();
        loop {
            all.sort_by(|a, b| a.0.score.total_cmp(&b.0.score));
            let mut open = all.iter_mut().take(first).filter(|one| !one.1).peekable();
            if open.peek().is_none() {
                return all.into_iter().map(|one| one.0).collect();
            }
            open.for_each(|one| {
                self.charge(search, &mut one.0);
                one.1 = true;
            });
        }
    }

    fn fall(&mut self, search: &Search, candidate: &State) -> f64 {
        let (Some(loss), Some(modes)) = (self.loss, longer(self.state, candidate)) else { return 0.0 };
        if let Some((_, known)) = self.known.iter().find(|(known, _)| *known == modes) {
            return *known;
        }
        let forgiven = forgiving(search.quick, self.state, modes.clone()).map_or(loss, |losses| sum(&losses));
        // As many samples as J is of.
        let share = search.problem.rows() as f64 / search.quick.rows().max(1) as f64;
        let fall = (search.log_error(share * loss) - search.log_error(share * forgiven)).max(0.0);
        self.known.push((modes, fall));
        fall
    }
}

#[cfg(test)]
mod tests {
    use acm_core::effects::Carrier;
    use acm_core::record::Record;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;
    use crate::search::criteria::Criteria;

    /// Oracle: y = q + 5 e^(−t/0.5) is q but for a state that fades in half a second. A candidate that remembers so long has it
    /// forgiven, and what it is compared with too; one without a memory that fades has not.
    #[test]
    fn what_a_candidate_is_forgiven_is_forgiven_without_it_too() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let q: Vec<f64> = bench::time().iter().map(|t| (1.3 * t).sin()).collect();
        let y = bench::time().iter().zip(&q).map(|(t, q)| q + 5.0 * (-t / 0.5).exp()).collect();
        let series = [bench::series(Record::new(bench::time(), vec![q], vec![], vec![]), y)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let criteria = Criteria::default();
        let search = Search::plain(&problem, &[], &criteria);
        let bare = State::bare(Form::LINEAR);
        let losses = cross_validate(&problem, &bare).unwrap();
        let with = |name: &str, value: f64| bare.with(bench::placed(name, Carrier::Rig, &rig, &[value]));
        let forgiven = search.forgiven(&bare, &losses, &with("actuator_lag", 0.5));
        assert!(sum(&forgiven) < 1e-3 * sum(&losses), "{} {}", sum(&forgiven), sum(&losses));
        assert_eq!(search.forgiven(&bare, &losses, &with("backlash", 0.1)), losses);
    }

    /// Oracle: y = q + 5 e^(−t/0.5), where a lag that does nothing beside its start is charged for all that it gains, and one set compares
    /// with another as it did with the same start.
    #[test]
    fn a_start_is_charged_for_and_sets_compare_without_it() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let q: Vec<f64> = bench::time().iter().map(|t| (1.3 * t).sin()).collect();
        let mut noise = bench::noise(0.1);
        let y = bench::time().iter().zip(&q).map(|(t, q)| q + 5.0 * (-t / 0.5).exp() + noise()).collect();
        let series = [bench::series(Record::new(bench::time(), vec![q], vec![], vec![]), y)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let criteria = Criteria::default();
        let mut search = Search::plain(&problem, &[], &criteria);
        let bare = State::bare(Form::LINEAR);
        let losses = cross_validate(&problem, &bare).unwrap();
        search.first = sum(&losses);
        let with = |name: &str, theta: &[f64]| bare.with(bench::placed(name, Carrier::Rig, &rig, theta));
        let tried = |name: &str, theta: &[f64]| {
            let (label, state) = (name.to_string(), with(name, theta));
            let losses = cross_validate(&problem, &state).unwrap();
            let score = search.score(&losses, &state);
            Tried { label, state, score, scanned: score, losses, is_refined: true }
        };
        let (idle, play) = (tried("creep", &[0.0, 0.5]), tried("backlash", &[0.0]));
        assert!(idle.score < play.score - 1.0);
        let compared = search.on_equal_terms((&bare, &losses), (&idle.state, &idle.losses));
        assert!((sum(&compared) / sum(&losses) - 1.0).abs() < 1e-9);
        let compared = search.on_equal_terms((&idle.state, &idle.losses), (&bare, &losses));
        assert!((sum(&compared) / sum(&idle.losses) - 1.0).abs() < 1e-9);
        let prices = |one: &Tried| one.score - search.log_error(sum(&one.losses));
        let sorted = Starts::new(&search, &bare).sort(&search, vec![idle, play], 1);
        // Both predict as the bare form does; what they cost decides.
        let charged: Vec<f64> = sorted.iter().map(|one| one.score).collect();
        assert!(charged.iter().all(|score| *score > 0.0 && *score < 0.5), "{charged:?}");
        assert!(sorted.iter().all(|one| prices(one) > 0.0));
    }
}
