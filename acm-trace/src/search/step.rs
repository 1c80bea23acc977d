//! Report of one step of a search.

/// A step of the search, for the report.
#[derive(Debug, Clone)]
pub struct Step {
    /// The set before it.
    pub on: Vec<String>,
    /// Effect that was added, dropped or exchanged.
    pub change: String,
    /// Relative reduction of the cross-validated mean square.
    pub gain: f64,
    /// Quantile of the largest gain on surrogates.
    pub by_chance: Option<f64>,
    /// Mean gain over blocks in standard errors.
    pub t: f64,
    /// Whether it was accepted.
    pub accepted: bool,
    /// Root mean square error left out, after it.
    pub error: f64,
    /// Candidates and their errors, best first.
    pub candidates: Vec<(String, f64)>,
}

/// Largest number of candidates that a step lists.
pub(super) const LISTED: usize = 12;
