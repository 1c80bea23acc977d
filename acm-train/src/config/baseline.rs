//! `[baseline]`: the outside baseline that replaces the network, and its settings.

use serde::{Deserialize, Serialize};

use super::parse::fault::Fault;

/// Exponents of the penalties, from 10³ down to 10⁻⁶, two a decade. They include what 250 coefficients of standardised
/// inputs can need.
const PENALTIES: std::ops::RangeInclusive<i32> = -6..=12;

/// Largest number of penalties; each is a fit.
const MOST_PENALTIES: usize = 1000;

/// One outside baseline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Baseline {
    /// Ridge regression on lagged inputs.
    Ridge(RidgeConfig),
    /// Gradient-boosted trees on a few lags, one booster per output.
    BoostedTrees(TreesConfig),
}

/// Sizes of the ridge regression.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RidgeConfig {
    /// Number of the last samples of a window that it uses; left out, all of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lags: Option<usize>,
    /// Penalties that are tried, per sample and for standardised inputs and targets.
    pub penalties: Vec<f64>,
}

impl Default for RidgeConfig {
    fn default() -> Self {
        Self { lags: None, penalties: PENALTIES.map(|k| 10f64.powf(-f64::from(k) / 2.0)).collect() }
    }
}

/// Sizes of the boosted trees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TreesConfig {
    /// Ages of the inputs in samples; left out, 0, 1, 2, 4, 8, … within the window.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lags: Option<Vec<usize>>,
    /// Largest number of rounds; each adds one tree per output.
    pub rounds: usize,
    /// Number of rounds without a smaller validation loss after which an output gets no further tree.
    pub patience: usize,
    /// Share of a tree that is added, up to 1.
    pub learning_rate: f64,
    /// Largest number of splits from the root of a tree to a leaf.
    pub depth: usize,
    /// Smallest number of training windows in a leaf.
    pub leaf_windows: usize,
    /// Penalty on the squared value of a leaf, in windows.
    pub penalty: f64,
}

impl Default for TreesConfig {
    fn default() -> Self {
        Self { lags: None, rounds: 300, patience: 20, learning_rate: 0.1, depth: 5, leaf_windows: 20, penalty: 1.0 }
    }
}

impl Baseline {
    /// Returns the kind as the file names it and as scores show it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Ridge(_) => "ridge",
            Self::BoostedTrees(_) => "boosted_trees",
        }
    }

    /// Returns the largest number of rows of a record: penalties, or rounds.
    pub fn rows(&self) -> usize {
        match self {
            Self::Ridge(config) => config.penalties.len(),
            Self::BoostedTrees(config) => config.rounds,
        }
    }

    /// Returns every invalid value, for windows of `length` samples.
    pub fn faults(&self, length: usize) -> Vec<Fault> {
        match self {
            Self::Ridge(config) => config.faults(length),
            Self::BoostedTrees(config) => config.faults(length),
        }
    }
}

impl RidgeConfig {
    fn faults(&self, length: usize) -> Vec<Fault> {
        let mut faults = vec![];
        if let Some(lags) = self.lags.filter(|lags| !(1..=length).contains(lags)) {
            let what = format!("is {lags}, and a window has {length} samples");
            faults.push(Fault::new("baseline.lags", what, format!("write 1 to windows.length = {length}")));
        }
        if self.penalties.is_empty() {
            let help = "write at least one: penalties = [1e-3, 1.0], or leave the key out";
            faults.push(Fault::new("baseline.penalties", "is empty, so there is nothing to try", help));
        }
        if self.penalties.len() > MOST_PENALTIES {
            let what = format!("names {} penalties", self.penalties.len());
            faults.push(Fault::new("baseline.penalties", what, format!("name {MOST_PENALTIES} at most")));
        }
        if let Some(penalty) = self.penalties.iter().find(|penalty| **penalty < 0.0) {
            faults.push(Fault::new("baseline.penalties", format!("names {penalty}"), "write penalties of 0 or more"));
        }
        faults
    }
}

impl TreesConfig {
    fn faults(&self, length: usize) -> Vec<Fault> {
        let mut faults = vec![];
        let lags = self.lags.iter().flatten();
        if let Some(lag) = lags.clone().find(|lag| **lag >= length) {
            let what = format!("names {lag}, and a window of {length} samples reaches {} back", length.max(1) - 1);
            faults.push(Fault::new("baseline.lags", what, "name smaller lags, or write a longer windows.length"));
        }
        if self.lags.as_ref().is_some_and(Vec::is_empty) {
            let help = "name at least one: lags = [0], or leave the key out";
            faults.push(Fault::new("baseline.lags", "is empty, so the trees would see nothing", help));
        }
        for (key, value, most, example) in [
            ("baseline.rounds", self.rounds, 100_000, "300"),
            ("baseline.patience", self.patience, 100_000, "20"),
            ("baseline.depth", self.depth, 64, "5"),
            ("baseline.leaf_windows", self.leaf_windows.max(1), 1_000_000_000, "20"),
        ] {
            faults.extend(Fault::count(key, value, 1, most, example));
        }
        if self.learning_rate <= 0.0 || self.learning_rate > 1.0 {
            let what = format!("is {}", self.learning_rate);
            faults.push(Fault::new("baseline.learning_rate", what, "write a share above 0, up to 1"));
        }
        if self.penalty < 0.0 {
            faults.push(Fault::new("baseline.penalty", format!("is {}", self.penalty), "write 0 or more"));
        }
        faults
    }
}
