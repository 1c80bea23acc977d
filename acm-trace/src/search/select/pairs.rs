//! Pairs of effects whose first is not proven alone: another cause masks it, or a static map imitates it. Beside a second effect both are
//! tested again.

use crate::search::accept::{least_t, paired_t};
use crate::search::candidates::new_in;
use crate::search::scored::{Search, Unproven};
use crate::search::tried::Tried;

impl Search<'_, '_> {
    /// Returns whether an effect beside a second is neither chance nor a misfit of the nominal form: both together gain over blocks, it
    /// gains more than the best candidate does by chance where both are, and a static map beside the second predicts worse.
    pub(super) fn proves(&mut self, first: &Unproven, both: &Tried) -> bool {
        let together = paired_t(&first.losses, &both.losses);
        together > least_t(first.losses.len(), self.criteria.level)
            && (!first.is_imitated || self.is_needed_beside_a_map(&first.label, both))
            && first.gain > self.by_chance(&first.without, &both.state)
    }

    /// Returns whether the others of a set predict worse beside the most flexible static map than all do without it.
    fn is_needed_beside_a_map(&mut self, label: &str, all: &Tried) -> bool {
        let Some(i) = new_in(label, &all.state, self.problem.rig) else { return false };
        let (_, others, _) = self.settled(&all.state.without(i));
        let map = self.with_map(&others);
        all.score < self.score_of(map, &others)
    }
}
