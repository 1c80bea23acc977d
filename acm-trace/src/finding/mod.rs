//! The result of closing the loop, as it is written to `loop.json`. Tables, figures and the page are drawn from it alone.
//!
//! | file | what |
//! | --- | --- |
//! | [`verdict`], `records::effects`, `records::steps` | the conclusion, the effects, and the steps of the search |
//! | `records::errors` | errors on held-out trials |
//! | `records::left`, `records::formula` | the remaining residual |
//! | `records::data`, `records::before`, `records::networks`, `records::drawn` | data, history of actuators, networks, figures |
//! | [`sentence`], [`title`], [`experiment`] | the same in words |
//! | `found`, `clocks`, `figures`, [`intervals`] | how effects, figures and intervals are made |

use serde::{Deserialize, Serialize};

pub(crate) mod clocks;
pub mod experiment;
pub(crate) mod figures;
pub(crate) mod found;
pub mod intervals;
mod records;
pub mod sentence;
pub mod title;
pub mod verdict;

pub use records::before::{BeforeForm, BeforeTrial};
pub use records::data::Data;
pub use records::drawn::{CarrierFigure, Figures, Trace, TrialErrors};
pub use records::effects::{Alternative, Confidence, Doubt, FoundEffect, FoundParameter, Level, MinorEffect};
pub use records::errors::{Baselines, Confirmation, Errors, Estimate};
pub use records::formula::{Symbolic, SymbolicTerm};
pub use records::left::{Autocorrelation, Event, Left, NotTried, Probe};
pub use records::networks::NetworkRow;
pub use records::steps::{Candidate, Step};
pub use verdict::Verdict;

pub use crate::separability::{Group, Separability};

/// Result of the loop.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Finding {
    /// Version of this layout.
    pub format: u32,
    /// Summary in one sentence, for a reader who sees nothing else.
    pub sentence: String,
    /// Verdict.
    pub verdict: Verdict,
    /// Effects that the model lacked, the largest first.
    pub effects: Vec<FoundEffect>,
    /// Minor effects: in the model, and too small to be named; the largest first.
    #[serde(default)]
    pub minor: Vec<MinorEffect>,
    /// Names of all effects that explain as much as the first one does, itself included.
    pub equivalent: Vec<String>,
    /// Delay of the actuators' time stamps, s. It is no effect, since it uses future samples.
    pub clock_correction: Option<FoundParameter>,
    /// Names of the actuators that the model holds between samples.
    #[serde(default)]
    pub zero_order_hold: Vec<String>,
    /// Names of the actuators with quartic interpolation between samples.
    #[serde(default)]
    pub quartic_interpolation: Vec<String>,
    /// History of the actuators before trials whose start determines it.
    #[serde(default)]
    pub before: Vec<BeforeTrial>,
    /// Root mean square of the random offsets of trials, in the unit of the errors.
    pub trial_offset: Option<f64>,
    /// Errors on held-out trials, in the unit of [`Errors::unit`].
    pub errors: Errors,
    /// Share of the removable error that was removed, F = (b² − a²)/(b² − noise²) with b the best baseline; none where
    /// there was nothing to remove.
    pub removed: Option<f64>,
    /// Confirmation by held-out trials.
    pub confirmation: Confirmation,
    /// Models that were compared in the search, from the nominal model to the last: cross-validated on development
    /// trials.
    pub steps: Vec<Step>,
    /// The remaining residual and its diagnosis.
    pub left: Left,
    /// A formula for what no known effect explains.
    pub symbolic: Option<Symbolic>,
    /// Cheapest experiment that would separate effects that these data cannot.
    pub next_experiment: Option<String>,
    /// Caveats, one sentence each: blocks instead of trials, no calibration trials, ….
    pub cautions: Vec<String>,
    /// Errors of the nominal model, with effect, with network and with both, where networks were trained.
    pub networks: Vec<NetworkRow>,
    /// Data of the figures.
    pub figures: Figures,
    /// Description of the data.
    pub data: Data,
    /// Computing time in seconds; informative.
    pub seconds: f64,
    /// Configuration with every default filled in.
    pub configuration: serde_json::Value,
    /// Version of the program.
    pub version: String,
}

impl Finding {
    /// Returns whether anything was added to the model: an effect, or a correction of the actuators' clock.
    pub fn adds(&self) -> bool {
        !self.effects.is_empty() || self.clock_correction.is_some()
    }
}
