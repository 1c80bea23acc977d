//! What an unknown start of each trial explains by itself, which is no gain of an effect.
//!
//! An effect with a memory has a state at the start of a trial that nothing recorded tells, and that is taken out of the trial
//! ([`unrecorded`](crate::fit::unrecorded)). What is slow, such as a drift of the measurement, looks much like a start that fades. So sets are
//! compared with the same start forgiven to both.

use acm_core::effects::Mode;

use crate::fit::problem::Problem;
use crate::fit::state::{State, modes};
use crate::search::scan::{Losses, cross_validate, sum};
use crate::search::scored::Search;

impl Search<'_, '_> {
    /// Returns the losses of a state, with as long a time forgiven at the start of each trial as the candidate's memory
    /// takes, where that is less.
    pub(in crate::search) fn forgiven(&self, state: &State, losses: &Losses, candidate: &State) -> Losses {
        let forgiven = longer(state, candidate).and_then(|modes| forgiving(self.problem, state, modes));
        forgiven.filter(|forgiven| sum(forgiven) < sum(losses)).unwrap_or_else(|| losses.clone())
    }

    /// Returns the losses of another set as they compare with those of `own`: both forgive the start of each trial as long as the longer
    /// of their memories lasts.
    pub(in crate::search) fn on_equal_terms(&self, own: (&State, &Losses), other: (&State, &Losses)) -> Losses {
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

    /// Oracle: y = q + 5 e^(−t/0.5). Creep of no size gains by its start alone, and equals the set without it on equal terms.
    #[test]
    fn sets_compare_without_what_a_start_explains() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let q: Vec<f64> = bench::time().iter().map(|t| (1.3 * t).sin()).collect();
        let mut noise = bench::noise(0.1);
        let y = bench::time().iter().zip(&q).map(|(t, q)| q + 5.0 * (-t / 0.5).exp() + noise()).collect();
        let series = [bench::series(Record::new(bench::time(), vec![q], vec![], vec![]), y)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let criteria = Criteria::default();
        let search = Search::plain(&problem, &[], &criteria);
        let bare = State::bare(Form::LINEAR);
        let losses = cross_validate(&problem, &bare).unwrap();
        let idle = bare.with(bench::placed("creep", Carrier::Rig, &rig, &[0.0, 0.5]));
        let idle_losses = cross_validate(&problem, &idle).unwrap();
        assert!(sum(&idle_losses) < 0.1 * sum(&losses));
        let compared = search.on_equal_terms((&bare, &losses), (&idle, &idle_losses));
        assert!((sum(&compared) / sum(&losses) - 1.0).abs() < 1e-9);
        let compared = search.on_equal_terms((&idle, &idle_losses), (&bare, &losses));
        assert!((sum(&compared) / sum(&idle_losses) - 1.0).abs() < 1e-9);
    }
}
