//! Options of a search, as the caller sets them.

use std::sync::Arc;

use acm_core::effects::own::Own;

use crate::search::criteria::Criteria;

/// Options of the search.
#[derive(Debug, Clone)]
pub struct Options {
    /// Criteria for accepting an effect.
    pub criteria: Criteria,
    /// Number of samples compared.
    pub samples: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Names of the effects that may be found; `None` for all.
    pub only: Option<Vec<String>>,
    /// Names of effects that are excluded.
    pub without: Vec<String>,
    /// User-defined effects on the rig of the case, beside those of the library.
    pub own: Vec<Arc<Own>>,
}

impl Default for Options {
    fn default() -> Self {
        Self { criteria: Criteria::default(), samples: 2500, seed: 1, only: None, without: vec![], own: vec![] }
    }
}
