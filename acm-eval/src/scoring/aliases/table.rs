//! The table: shares by place, effect and the effect that explains it.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

/// Mutual share from which an effect is an alias.
pub const ALIAS: f64 = 0.98;

/// Mutual shares at which top-1 is reported.
pub const LEVELS: [f64; 3] = [0.95, ALIAS, 0.99];

/// Shares by the name of the effect that explains.
pub type Shares = BTreeMap<String, f64>;

/// Smallest share that is kept: an effect explained to less than this is another standard error away wherever its
/// absence is missed by two ([`Table::imitated`]).
pub const KEPT: f64 = 0.75;

/// Table of aliases; see the head of this file.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// The command that made it.
    pub command: String,
    /// Version of the program that made it.
    pub version: String,
    /// Shares of at least [`KEPT`], by place, effect and explaining effect.
    pub places: BTreeMap<String, BTreeMap<String, Shares>>,
}

/// The table that is committed.
const COMMITTED: &str = include_str!("table.json");

impl Table {
    /// Returns the table that is committed with the program.
    pub fn committed() -> &'static Table {
        static TABLE: OnceLock<Table> = OnceLock::new();
        // A test reads it; what cannot be read makes nothing an alias.
        TABLE.get_or_init(|| serde_json::from_str(COMMITTED).unwrap_or_default())
    }

    /// Returns the share of one effect that another explains; 1 for itself, 0 where little is.
    pub fn share(&self, place: &str, of: &str, by: &str) -> f64 {
        if of == by {
            return 1.0;
        }
        let shares = self.places.get(place).and_then(|effects| effects.get(of));
        shares.and_then(|shares| shares.get(by)).copied().unwrap_or(0.0)
    }

    /// Returns the effects that explain this one and are explained by it, with the smaller share of the two.
    pub fn mutual(&self, place: &str, of: &str) -> Shares {
        let shares = self.places.get(place).and_then(|effects| effects.get(of));
        let both = |(by, share): (&String, &f64)| (by.clone(), share.min(self.share(place, by, of)));
        shares.into_iter().flatten().map(both).filter(|(_, share)| *share > 0.0).collect()
    }

    /// Returns the largest share of an effect that another one explains.
    pub fn imitated(&self, place: &str, of: &str) -> f64 {
        let shares = self.places.get(place).and_then(|effects| effects.get(of));
        shares.into_iter().flatten().map(|(_, share)| *share).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shares(all: &[(&str, f64)]) -> Shares {
        all.iter().map(|(name, share)| ((*name).to_string(), *share)).collect()
    }

    /// Oracle: by hand.
    #[test]
    fn a_share_counts_in_both_directions() {
        let effects = BTreeMap::from([
            ("lag".to_string(), shares(&[("spring", 1.0), ("delay", 0.97)])),
            ("spring".to_string(), shares(&[("lag", 0.8)])),
            ("delay".to_string(), shares(&[("lag", 0.99)])),
        ]);
        let table = Table { places: BTreeMap::from([("rich".to_string(), effects)]), ..Table::default() };
        assert_eq!(table.mutual("rich", "lag"), shares(&[("spring", 0.8), ("delay", 0.97)]));
        assert_eq!((table.imitated("rich", "lag"), table.imitated("rich", "delay")), (1.0, 0.99));
        assert_eq!((table.share("rich", "lag", "lag"), table.share("paper", "lag", "delay")), (1.0, 0.0));
        assert!(table.mutual("rich", "play").is_empty());
    }

    /// Oracle: the library's own list, and the places that the command measures.
    #[test]
    fn the_committed_table_names_effects_of_the_library() {
        let table: Table = serde_json::from_str(COMMITTED).expect("it can be read");
        let places: Vec<&str> = table.places.keys().map(String::as_str).collect();
        let mut known = super::super::PLACES.to_vec();
        known.sort_unstable();
        assert_eq!(places, known);
        assert!(table.command.starts_with("acm-eval score-loop --aliases"));
        for (of, shares) in table.places.values().flatten() {
            assert!(acm_core::effects::find(of).is_some(), "{of}");
            for (by, share) in shares {
                assert!(acm_core::effects::find(by).is_some() && by != of, "{by}");
                assert!((KEPT..=1.0).contains(share), "{of} by {by}: {share}");
            }
        }
    }
}
