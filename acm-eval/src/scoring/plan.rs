//! Campaigns and rigs to try.

use acm_sim::twin::undeclared::{ALL_NULLS, Design, INSIDE, Kind, MOST, draw};
use serde::{Deserialize, Serialize};

use super::seeds::Seeds;

/// Campaigns and rigs to try.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Campaigns of each design.
    pub seeds: u64,
    /// Seed of the first one; the others follow.
    pub first: u64,
    /// Motions of actuators and vehicle.
    pub designs: Vec<Design>,
    /// Kinds in turn; the seed draws the kind where the list is empty.
    pub kinds: Vec<Kind>,
    /// Number of further campaigns, without a mechanism, from the seeds that follow: designs and the five kinds in
    /// turn.
    pub nulls: u64,
    /// Whether the library lacks the true effect; then only campaigns with one effect of the library are tried.
    pub without_own: bool,
}

/// One campaign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Task {
    /// Seed of all random draws of the campaign.
    pub seed: u64,
    /// Motion of actuators and vehicle.
    pub design: Design,
    /// Mechanism of the campaign.
    pub kind: Kind,
    /// Whether the library lacks the true effect.
    pub without_own: bool,
}

/// Returns the campaigns of two to six causes: `many` seeds of a list, the number of causes in turn, for each design.
pub fn several_tasks(list: Seeds, many: u64, designs: &[Design]) -> Vec<Task> {
    let causes = |k: usize| Kind::Several(2 + (k % usize::from(MOST - 1)) as u8);
    let of = |design: Design| {
        let seeds = list.take(many).enumerate();
        seeds.map(move |(k, seed)| Task { seed, design, kind: causes(k), without_own: false })
    };
    designs.iter().flat_map(|design| of(*design)).collect()
}

/// Key of a campaign or rig among the rows of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Key {
    /// Seed of all random draws of the rig.
    pub seed: u64,
    /// Motion of actuators and vehicle; none of a small rig.
    pub design: Option<Design>,
    /// Mechanism, or the kind of the rig.
    pub kind: String,
    /// Whether the library lacks the true effect.
    pub without_own: bool,
}

/// A trial of the search.
pub trait Tried {
    /// Returns the key.
    fn key(&self) -> Key;
}

impl Tried for Task {
    fn key(&self) -> Key {
        let Task { seed, design, kind, without_own } = *self;
        Key { seed, design: Some(design), kind: kind.name(), without_own }
    }
}

impl Tried for (acm_sim::small_rigs::Kind, u64) {
    fn key(&self) -> Key {
        Key { seed: self.1, design: None, kind: self.0.name().into(), without_own: false }
    }
}

impl Plan {
    /// Returns all campaigns, design by design, then the nulls.
    pub fn tasks(&self) -> Vec<Task> {
        let nulls = (0..self.nulls).filter_map(|k| self.null(k)).filter(|_| !self.without_own);
        self.designs.iter().flat_map(|design| self.of(*design)).chain(nulls).collect()
    }

    /// Returns campaign `k` without a mechanism. Five kinds and up to two designs have no common factor, so all pairs
    /// are equally frequent.
    fn null(&self, k: u64) -> Option<Task> {
        let design = *self.designs.get(k as usize % self.designs.len().max(1))?;
        let null = ALL_NULLS[(k % ALL_NULLS.len() as u64) as usize];
        let seed = self.first.wrapping_add(self.seeds).wrapping_add(k);
        Some(Task { seed, design, kind: Kind::Null(null), without_own: false })
    }

    fn of(&self, design: Design) -> Vec<Task> {
        let task = |(seed, kind)| Task { seed, design, kind, without_own: self.without_own };
        let drawn = (0..self.seeds).map(|k| (self.first.wrapping_add(k), self.kind(k)));
        let is_inside = |task: &Task| matches!(task.kind, Kind::One(cause) if INSIDE.contains(&cause));
        drawn.map(task).filter(|task| !self.without_own || is_inside(task)).collect()
    }

    fn kind(&self, k: u64) -> Kind {
        match self.kinds.len() as u64 {
            0 => draw(self.first.wrapping_add(k)),
            many => self.kinds[(k % many) as usize],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use acm_sim::twin::undeclared::Cause;

    fn plan() -> Plan {
        Plan { seeds: 40, first: 100, designs: Design::ALL.to_vec(), kinds: vec![], nulls: 10, without_own: false }
    }

    #[test]
    fn seeds_draw_their_kinds_and_nulls_follow_them() {
        let tasks = plan().tasks();
        assert_eq!(tasks.len(), 2 * 40 + 10);
        assert!(tasks[..40].iter().zip(100..).all(|(task, seed)| task.seed == seed && task.kind == draw(seed)));
        let nulls: Vec<u64> = tasks[80..].iter().map(|task| task.seed).collect();
        assert_eq!(nulls, (140..150).collect::<Vec<u64>>());
        let kinds: std::collections::BTreeSet<(Design, Kind)> =
            tasks[80..].iter().map(|task| (task.design, task.kind)).collect();
        assert_eq!(kinds.len(), 10, "five kinds in both designs");
        assert!(kinds.iter().all(|(_, kind)| matches!(kind, Kind::Null(_))));
    }

    #[test]
    fn several_causes_are_dealt_in_turn_from_their_list() {
        let tasks = several_tasks(Seeds::Report, 7, &Design::ALL);
        assert_eq!((tasks.len(), tasks[0].seed, tasks[7].seed), (14, 37_001, 37_001));
        let many: Vec<String> = tasks[..7].iter().map(|task| task.kind.name()).collect();
        assert_eq!(many, ["several2", "several3", "several4", "several5", "several6", "several2", "several3"]);
    }

    #[test]
    fn kinds_are_dealt_in_turn_and_only_what_has_an_own_effect_goes_without_it() {
        let kinds = vec![Kind::One(Cause::Creep), Kind::One(Cause::Slip)];
        let tasks = Plan { kinds, without_own: true, ..plan() }.tasks();
        assert_eq!(tasks.len(), 40, "a slip and a null have no entry that could be taken away");
        assert!(tasks.iter().all(|task| task.kind == Kind::One(Cause::Creep) && task.seed % 2 == 0));
    }
}
