//! Result of an expansion.

use super::scan::Losses;
use crate::fit::state::State;

/// A candidate with its errors.
#[derive(Debug, Clone)]
pub struct Tried {
    /// Name with carrier and signal.
    pub label: String,
    /// State with the effect.
    pub state: State,
    /// Score J.
    pub score: f64,
    /// Score of the model to first order.
    pub scanned: f64,
    /// Sum of squares of each block left out.
    pub losses: Losses,
    /// Whether the losses are those of the model with its values refined; otherwise of the model to first order.
    pub is_refined: bool,
}

impl Tried {
    /// Returns its score, state and losses.
    pub fn scored(&self) -> (f64, State, Losses) {
        (self.score, self.state.clone(), self.losses.clone())
    }
}

/// Returns the name of the effect in a label: `coulomb_friction` in `coulomb_friction(x) × payload`.
pub fn effect_of(label: &str) -> &str {
    label.split(['(', ' ']).next().unwrap_or(label)
}

/// Every candidate on a state: those that were refined, best first, then the others.
pub type Expansion = Vec<Tried>;
