//! Which campaigns are tried.

use acm_sim::twin::undeclared::{ALL_NULLS, Design, Kind, MOST, draw};

use super::seeds::Seeds;

/// What is asked for.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Campaigns of each design.
    pub seeds: u64,
    /// Seed of the first one; the others follow.
    pub first: u64,
    /// How actuators and vehicle move.
    pub designs: Vec<Design>,
    /// Kinds, dealt in turn; the seed draws the kind where the list is empty.
    pub kinds: Vec<Kind>,
    /// More campaigns of each design, without a mechanism, from the seeds that follow.
    pub nulls: u64,
    /// Whether the library lacks the true effect; then only campaigns with one effect of the library are tried.
    pub without_own: bool,
}

/// One campaign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Task {
    /// Of everything that is random in it.
    pub seed: u64,
    /// How actuators and vehicle move.
    pub design: Design,
    /// What may be the matter with it.
    pub kind: Kind,
    /// Whether the library lacks the true effect.
    pub without_own: bool,
}

/// Campaigns of two to six causes: `many` seeds of a list, the number of causes dealt in turn, for each design.
pub fn several_tasks(list: Seeds, many: u64, designs: &[Design]) -> Vec<Task> {
    let causes = |k: usize| Kind::Several(2 + (k % usize::from(MOST - 1)) as u8);
    let of = |design: Design| {
        let seeds = list.take(many).enumerate();
        seeds.map(move |(k, seed)| Task { seed, design, kind: causes(k), without_own: false })
    };
    designs.iter().flat_map(|design| of(*design)).collect()
}

impl Plan {
    /// All campaigns, design by design.
    pub fn tasks(&self) -> Vec<Task> {
        self.designs.iter().flat_map(|design| self.of(*design)).collect()
    }

    fn of(&self, design: Design) -> Vec<Task> {
        let task = |(seed, kind)| Task { seed, design, kind, without_own: self.without_own };
        let drawn = (0..self.seeds).map(|k| (self.first.wrapping_add(k), self.kind(k)));
        let nulls = (0..self.nulls).map(|k| {
            let null = ALL_NULLS[(k % ALL_NULLS.len() as u64) as usize];
            (self.first.wrapping_add(self.seeds).wrapping_add(k), Kind::Null(null))
        });
        let is_inside = |task: &Task| matches!(task.kind, Kind::One(cause) if cause.library().is_some());
        drawn.chain(nulls).map(task).filter(|task| !self.without_own || is_inside(task)).collect()
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
        Plan { seeds: 40, first: 100, designs: Design::ALL.to_vec(), kinds: vec![], nulls: 6, without_own: false }
    }

    #[test]
    fn seeds_draw_their_kinds_and_nulls_follow_them() {
        let tasks = plan().tasks();
        assert_eq!(tasks.len(), 2 * 46);
        assert!(tasks[..40].iter().zip(100..).all(|(task, seed)| task.seed == seed && task.kind == draw(seed)));
        let nulls: Vec<u64> = tasks[40..46].iter().map(|task| task.seed).collect();
        assert_eq!(nulls, [140, 141, 142, 143, 144, 145]);
        assert!(tasks[40..46].iter().all(|task| matches!(task.kind, Kind::Null(_))));
    }

    #[test]
    fn several_causes_are_dealt_in_turn_from_their_list() {
        let tasks = several_tasks(Seeds::Report, 7, &Design::ALL);
        assert_eq!((tasks.len(), tasks[0].seed, tasks[7].seed), (14, 15_001, 15_001));
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
