//! Kinks in the nominal form, the last step of the search.

use crate::fit::state::State;
use crate::search::accept::{least_t, paired_t};
use crate::search::candidates::behind_map;
use crate::search::nuisance;
use crate::search::scored::{Scored, Search};

impl Search<'_, '_> {
    /// Returns a set with kinks in the nominal form, where that predicts better by as much as an effect must. Kinks come last, since a map
    /// with kinks absorbs a saturation or a dead zone, which have names. Static effects on the inputs may have imitated kinks: it is also
    /// tried without them. Then a filter before the map may belong behind it.
    pub(in crate::search) fn bent(&mut self, last: &Scored) -> Option<Scored> {
        if last.1.effects.is_empty() && last.1.clock == 0.0 {
            return None;
        }
        let without = last.1.without_static_inputs();
        let count = without.effects.len();
        let behind = (0..count).filter_map(|i| behind_map(self.problem, &without, i, self.library)).collect::<Vec<_>>();
        let starts = [Some(last.1.clone()), Some(without).filter(|_| count < last.1.effects.len())];
        let starts = starts.into_iter().flatten().chain(behind);
        let tried: Vec<Scored> = starts.filter_map(|state| self.with_kinks(state, last.0)).collect();
        let best = tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        let is_better = !best.1.form.kinks.is_empty()
            && best.0 < last.0 - self.criteria.price
            && paired_t(&last.2, &best.2) > least_t(last.2.len(), self.criteria.level)
            && self.is_better_as_saved((best.0, &best.1), (last.0, &last.1));
        if is_better {
            self.note(&last.1, &last.2, &format!("{} kinks of the map", best.1.form.kinks.count()), &best.2);
        }
        is_better.then_some(best)
    }

    /// Returns a set with kinks; where that lowers J they are chosen again after refining the values.
    fn with_kinks(&mut self, state: State, before: f64) -> Option<Scored> {
        let (first, _) = nuisance::bent(self.quick, &state, self.criteria)?;
        let first = self.settled(&first);
        if first.0 >= before {
            return Some(first);
        }
        let (again, _) = nuisance::bent(self.quick, &first.1, self.criteria)?;
        Some(self.settled(&again))
    }
}
