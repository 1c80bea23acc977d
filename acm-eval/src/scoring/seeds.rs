//! Two lists of seeds for campaigns of several causes and for small rigs: one to develop on, one to report.
//!
//! | list | first seed | use |
//! | --- | --- | --- |
//! | development | 14 001 | rules and constants may be chosen on it |
//! | report | 35 001 | scored for publication only, and never looked at before; those from 15 001 to 34 001 on were |
//!
//! A list goes on from its first seed; it has a thousand seeds, so that the two never meet.

use serde::Serialize;

/// Number of seeds in a list.
pub const LENGTH: u64 = 1000;

/// A list of seeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Seeds {
    /// Seeds for development.
    Development,
    /// Seeds for the report.
    Report,
}

impl Seeds {
    /// Returns the first seed.
    pub const fn first(self) -> u64 {
        match self {
            Seeds::Development => 14_001,
            Seeds::Report => 37_001,
        }
    }

    /// Returns the first `many` seeds, as many as it has.
    pub fn take(self, many: u64) -> impl Iterator<Item = u64> {
        self.first()..self.first() + many.min(LENGTH)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_never_meet() {
        let [one, two] = [Seeds::Development, Seeds::Report].map(|list| list.take(u64::MAX).collect::<Vec<u64>>());
        assert_eq!((one[0], two[0], one.len(), two.len()), (14_001, 37_001, 1000, 1000));
        assert!(one.iter().all(|seed| !two.contains(seed)));
        assert_eq!(Seeds::Development.take(3).collect::<Vec<u64>>(), [14_001, 14_002, 14_003]);
    }
}
