//! An experiment: one question, one TOML file, every field with a default.
//!
//! A file names only what differs from the defaults below. Unknown keys, wrong types, `nan` and `inf` are refused with
//! file, line and column ([`super::read`]).
//!
//! ```toml
//! question = "What does memory gain?"
//! data     = "datasets/acm-twin"
//! [network]
//! kind  = "gru"
//! [windows]
//! length = 25
//! ```

use std::path::PathBuf;

use acm_core::{axis::Axis, strain::StrainBasis};
use acm_datasets::{DomainFilter, Role, WindowSpec};
use serde::{Deserialize, Serialize};

use super::{baseline::Baseline, memory::Memory, network::ExperimentNetwork, training::TrainingConfig};

/// One question to one data set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Experiment {
    /// Question in one sentence.
    pub question: String,
    /// Folder with `manifest.toml`: as seen from the current directory, else from the experiment file's folder or one
    /// above it. `~/` is the user's home.
    pub data: PathBuf,
    /// Device: `flex` (any CPU), or `ndarray`, `cuda`, `wgpu` where built with that feature.
    pub device: String,
    /// Nominal model.
    pub nominal: Nominal,
    /// Inputs of the network.
    pub inputs: Inputs,
    /// How far back the network remembers.
    #[serde(skip_serializing_if = "Memory::is_default")]
    pub memory: Memory,
    /// Division of recordings into sequences.
    pub windows: Windows,
    /// The network, its sizes, and what it corrects.
    pub network: ExperimentNetwork,
    /// An outside baseline in the network's place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub baseline: Option<Baseline>,
    /// Optimizer, epochs, batches.
    pub training: TrainingConfig,
    /// Folds, seeds, held-out trials.
    pub protocol: Protocol,
}

impl Default for Experiment {
    fn default() -> Self {
        Self {
            question: "What does the nominal model miss?".into(),
            data: "datasets/acm-twin".into(),
            device: "flex".into(),
            nominal: Nominal::default(),
            inputs: Inputs::default(),
            memory: Memory::default(),
            windows: Windows::default(),
            network: ExperimentNetwork::default(),
            baseline: None,
            training: TrainingConfig::default(),
            protocol: Protocol::default(),
        }
    }
}

/// `[nominal]`: the model that predicts the tip from the actuators alone, fixed before any network is trained.
///
/// Fields that are left out are the manifest's own (`[arm]`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Nominal {
    /// Kind of the nominal model. Left out: the manifest's strain model where it describes an `[arm]`, else its
    /// `[[predicted]]` columns, else a polynomial.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub model: Option<NominalKind>,
    /// Saved model with effects, used instead of `model`: the `model.json` of `acm-eval close-loop`, found as `data`
    /// is. It predicts as it is, and nothing but the comparator is calibrated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub augmented: Option<PathBuf>,
    /// SHA-256 of that file, hex: filled in as a run begins, so that it continues with the same model or not at all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub augmented_sha256: Option<String>,
    /// Length of the arm, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Direction of the straight arm in the measurement frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axis: Option<Axis>,
    /// Basis of the bending strains along the arm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strain: Option<StrainBasis>,
    /// Degree of the polynomial from actuators to strain amplitudes, or to the outputs for `polynomial`. Left out: the manifest's, or
    /// for `polynomial` what predicts blocks of time left out ([`acm_core::degree`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub degree: Option<usize>,
    /// Integration steps along the arm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<usize>,
    /// Tolerance of the integration in m, used instead of `steps`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Degree of the polynomial that every model is compared with.
    pub comparator_degree: usize,
}

impl Default for Nominal {
    fn default() -> Self {
        Self {
            model: None,
            augmented: None,
            augmented_sha256: None,
            length: None,
            axis: None,
            strain: None,
            degree: None,
            steps: None,
            tolerance: None,
            comparator_degree: 3,
        }
    }
}

/// Source of the nominal prediction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NominalKind {
    /// Strain model of a continuum arm, calibrated here.
    Strain,
    /// Polynomial from actuators to outputs, calibrated here.
    Polynomial,
    /// The data's own `[[predicted]]` columns.
    Predicted,
    /// No nominal model: the network learns the measurement itself.
    None,
}

/// `[inputs]`: the inputs of the network.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Inputs {
    /// Actuators, context signals, and `rate(…)` of either. Left out: all actuators, then all context signals.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub channels: Option<Vec<String>>,
    /// Whether inputs are chosen among the channels before the network is trained, by backward elimination in
    /// cross-validation.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub select: bool,
    /// Channels before the choice of inputs; filled in by a run that chooses them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chosen_from: Option<Vec<String>>,
    /// Filter of the samples: those whose actuators the calibration trials cover.
    pub domain_filter: DomainFilter,
    /// Roles of the trials that the network learns from.
    pub learn_from: Vec<Role>,
    /// Channels whose values are permuted over all samples of a part, so that they carry no information. The increase
    /// of the error is their contribution.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub shuffled: Vec<String>,
    /// Whether a straight path from the channels to the residual runs beside the network, where it predicts better than a constant.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub straight_path: bool,
}

impl Default for Inputs {
    fn default() -> Self {
        Self {
            channels: None,
            select: false,
            chosen_from: None,
            domain_filter: DomainFilter::Hull,
            learn_from: vec![Role::Development],
            shuffled: vec![],
            straight_path: false,
        }
    }
}

/// `[windows]`: the sequences that a network reads, each ending at the sample it predicts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Windows {
    /// Samples in a window.
    pub length: usize,
    /// The longest window among the models that are compared: all are scored on the targets that it reaches.
    pub reach: usize,
    /// Samples from one training target to the next.
    pub stride: usize,
    /// Samples from one scored target to the next.
    pub evaluation_stride: usize,
    /// A longer gap between samples ends a segment, s; no window crosses it. Left out: five usual steps of the slowest trial that
    /// is learned from or calibrates, and at least 0.5 s; a run notes the number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_gap: Option<f64>,
    /// Steps of a window that are supervised.
    pub target: Target,
    /// Elapsed times that the network receives.
    #[serde(skip_serializing_if = "Elapsed::is_measured")]
    pub elapsed: Elapsed,
}

impl Default for Windows {
    fn default() -> Self {
        Self {
            length: 50,
            reach: 50,
            stride: 1,
            evaluation_stride: 1,
            max_gap: None,
            target: Target::Last,
            elapsed: Elapsed::Measured,
        }
    }
}

impl Windows {
    /// Returns the longest step in time within a segment, s; before the data are known, what fast recordings have.
    pub fn gap(&self) -> f64 {
        acm_datasets::max_gap(self.max_gap, 0.0)
    }
}

/// Elapsed times that a network receives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Elapsed {
    /// The time that went by, s.
    Measured,
    /// Constant 1, whatever time has elapsed.
    One,
}

impl Elapsed {
    /// Returns the name in configuration files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::One => "one",
        }
    }

    fn is_measured(&self) -> bool {
        *self == Self::Measured
    }
}

/// Steps of a window that are supervised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// The last one.
    Last,
    /// Every step.
    Every,
}

/// `[protocol]`: the trials of each run, the number of runs, and the use of held-out trials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Protocol {
    /// Whether there is one run per fold and seed, scored on that fold.
    pub cross_validation: bool,
    /// Whether there is one run per seed, its epoch chosen on one fold, then scored once on the held-out trials.
    #[serde(rename = "final")]
    pub final_runs: bool,
    /// The fold that chooses the epoch in final runs. Left out: the k-th seed takes the k-th fold, and the first again after the
    /// last, so that chance chooses none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub validation_fold: Option<usize>,
    /// Seeds of the initial weights and of the order of batches.
    pub seeds: Vec<u64>,
    /// Validation trials of each fold. Left out: as `leave_out` states.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub folds: Option<Vec<Vec<String>>>,
    /// Unit that folds leave out: `trial`, `block` (of time), or a signal that is constant within trials, of which each
    /// fold leaves out a value. Left out: the manifest's folds, or else as [`acm_datasets::folds`] states.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leave_out: Option<String>,
    /// Trials that take no part in learning, instead of those of the manifest: all other development and held-out
    /// trials are then learned from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub held_out: Option<Vec<String>>,
}

impl Default for Protocol {
    fn default() -> Self {
        Self {
            cross_validation: false,
            final_runs: true,
            validation_fold: None,
            seeds: vec![1, 2, 3, 4, 5],
            folds: None,
            leave_out: None,
            held_out: None,
        }
    }
}

impl Experiment {
    /// Returns the largest number of rows of a record: epochs of a network, or their counterpart of a baseline.
    pub fn rows(&self) -> usize {
        self.baseline.as_ref().map_or(self.training.epochs, Baseline::rows)
    }

    /// Returns whether final runs learn from all trials, with the epoch and the factor that cross-validation chose.
    pub fn refits(&self) -> bool {
        self.memory.is_trial()
            && self.protocol.cross_validation
            && self.protocol.validation_fold.is_none()
            && self.baseline.is_none()
    }

    /// Returns the targets of a part: every `stride`-th sample that the longest window reaches, or, with a carried state, of all.
    pub fn targets(&self, stride: usize) -> WindowSpec {
        match self.memory.is_trial() {
            true => WindowSpec { length: 1, reach: 1, stride },
            false => WindowSpec { length: self.windows.length, reach: self.windows.reach, stride },
        }
    }

    /// Returns the name of the learner in files and tables: the network's kind (`mlp`, `gru`, `cfc`), or that of the
    /// outside baseline in its place (`ridge`, `boosted_trees`).
    pub fn kind(&self) -> String {
        self.baseline.as_ref().map_or_else(|| self.network.kind(), Baseline::kind).to_string()
    }
}
