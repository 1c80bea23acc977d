//! Part that an unknown initial state of each trial explains, which is no gain of an effect.
//!
//! An effect with memory has an unknown state at the start of a trial, which is projected out ([`unrecorded`](crate::fit::unrecorded)).
//! Slow residuals, such as a drift of the measurement, look much like its decay. So sets are compared with the same modes projected out
//! for both.

use acm_core::effects::Mode;

use crate::fit::state::{State, modes};
use crate::search::scan::{Losses, cross_validate, sum};
use crate::search::scored::Search;

impl Search<'_, '_> {
    /// Returns the losses of a state with the candidate's modes projected out of each trial as well, where these are lower.
    pub(in crate::search) fn forgiven(&self, state: &State, losses: &Losses, candidate: &State) -> Losses {
        let (theirs, own) = (modes(candidate), modes(state));
        let is_longer = |(their, own): (&Mode, Option<&Mode>)| own.is_none_or(|own| their.memory > own.memory);
        if !theirs.iter().enumerate().any(|(k, their)| is_longer((their, own.get(k)))) {
            return losses.clone();
        }
        let alike = State { forgiven: theirs, ..state.clone() };
        let forgiven = cross_validate(self.problem, &alike);
        forgiven.filter(|forgiven| sum(forgiven) < sum(losses)).unwrap_or_else(|| losses.clone())
    }

    /// Returns the losses of another set, comparable with those of `own`: modes are projected out alike for both.
    pub(in crate::search) fn on_equal_terms(&self, own: (&State, &Losses), other: (&State, &Losses)) -> Losses {
        let own_alike = self.forgiven(own.0, own.1, other.0);
        let alike = self.forgiven(other.0, other.1, own.0);
        alike.iter().zip(own.1).zip(&own_alike).map(|((alike, own), own_alike)| alike + (own - own_alike)).collect()
    }
}

#[cfg(test)]
mod tests {
    use acm_core::effects::Carrier;
    use acm_core::record::Record;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;
    use crate::fit::problem::Problem;
    use crate::search::criteria::Criteria;
    use crate::series::Series;

    /// y = q + 5 e^(−t/0.5) beside noise.
    fn series() -> [Series; 1] {
        let q: Vec<f64> = bench::time().iter().map(|t| (1.3 * t).sin()).collect();
        let mut noise = bench::noise(0.1);
        let y = bench::time().iter().zip(&q).map(|(t, q)| q + 5.0 * (-t / 0.5).exp() + noise()).collect();
        [bench::series(Record::new(bench::time(), vec![q], vec![], vec![]), y)]
    }

    /// Oracle: y is q but for a state that decays in half a second. It is projected out for a candidate with that memory and for the set
    /// it is compared with, not for one without. Creep of size zero equals the set without it on equal terms.
    #[test]
    fn what_a_candidate_is_forgiven_is_forgiven_without_it_too() {
        let (rig, series, criteria) = (bench::rig(&["q"], &[], &["y"]), series(), Criteria::default());
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let search = Search::plain(&problem, &[], &criteria);
        let bare = State::bare(Form::LINEAR);
        let losses = cross_validate(&problem, &bare).unwrap();
        let with = |name: &str, theta: &[f64]| bare.with(bench::placed(name, Carrier::Rig, &rig, theta));
        let forgiven = search.forgiven(&bare, &losses, &with("actuator_lag", &[0.5]));
        assert!(sum(&forgiven) < 0.1 * sum(&losses), "{} {}", sum(&forgiven), sum(&losses));
        assert_eq!(search.forgiven(&bare, &losses, &with("backlash", &[0.1])), losses);

        let idle = with("creep", &[0.0, 0.5]);
        let idle_losses = cross_validate(&problem, &idle).unwrap();
        assert!(sum(&idle_losses) < 0.1 * sum(&losses));
        for (own, other) in [((&bare, &losses), (&idle, &idle_losses)), ((&idle, &idle_losses), (&bare, &losses))] {
            let compared = search.on_equal_terms(own, other);
            assert!((sum(&compared) / sum(own.1) - 1.0).abs() < 1e-9);
        }
    }
}
