//! The `[training]` table of an experiment.
//!
//! ```toml
//! [training]
//! epochs        = 60
//! batch         = 64
//! learning_rate = 1e-3
//! optimizer     = "adam"                              # "adamw", "rmsprop"
//! schedule      = { kind = "cosine", floor = 0.01 }   # "constant", "step", "plateau"
//! warm_up       = 0
//! patience      = 10
//! # weight_decay = 0.01, clip_norm = 1.0, dropout = 0.2, output_layer = "zero", ensemble = 5
//! ```

pub(super) mod loss;
pub(super) mod optimizer;
pub(super) mod output_layer;
pub(super) mod schedule;

use acm_models::FirstRule;
use serde::{Deserialize, Serialize};

use super::parse::fault::TrainingFault;
use optimizer::OptimizerKind;
use output_layer::OutputLayer;
use schedule::Schedule;

/// Settings of the training of a network.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrainingConfig {
    /// Optimizer steps of an epoch. Left out: as many as use every training window once.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub epoch_steps: Option<usize>,
    /// Largest number of epochs; the validation part is evaluated after each.
    pub epochs: usize,
    /// Number of windows in a batch; the last of an epoch may have fewer.
    pub batch: usize,
    /// Learning rate before the schedule.
    pub learning_rate: f64,
    /// The rule that turns gradients into steps.
    pub optimizer: OptimizerKind,
    /// Weight decay: coupled (L2) in `adam` and `rmsprop`, decoupled in `adamw`. Left out: torch's default, 0.01 for
    /// `adamw` and 0 for the others.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weight_decay: Option<f64>,
    /// Learning rate schedule.
    pub schedule: Schedule,
    /// Epochs over which the learning rate rises to its full value; 0 for none.
    pub warm_up: usize,
    /// Limit of the gradient's global norm. Left out: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clip_norm: Option<f64>,
    /// Share of the features before the output layer that is left out of each batch at random ([`crate::learn::dropout`]).
    /// Left out: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dropout: Option<f64>,
    /// Number of epochs without a better validation loss after which training ends; 0 to use all epochs.
    pub patience: usize,
    /// Number of networks that are trained from their own seeds, and whose mean is the prediction. Left out: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ensemble: Option<usize>,
    /// Output layer of epoch 0. Left out: `zero` where a nominal model predicts, `random` elsewhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output_layer: Option<OutputLayer>,
    /// Rule for the first values of the network ([`FirstRule`]).
    #[serde(skip_serializing_if = "is_default")]
    pub first_values: FirstRule,
    /// The file that the network came from, where it was trained elsewhere: filled in by `acm-eval import`, so that nothing
    /// is trained in its place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub imported: Option<Imported>,
}

/// A network that was trained elsewhere.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Imported {
    /// Name of its file.
    pub file: String,
    /// SHA-256 of the file, hex.
    pub sha256: String,
}

impl Default for TrainingConfig {
    fn default() -> Self {
        Self {
            epoch_steps: None,
            epochs: 60,
            batch: 64,
            learning_rate: 1e-3,
            optimizer: OptimizerKind::Adam,
            weight_decay: None,
            schedule: Schedule::Constant,
            warm_up: 0,
            clip_norm: None,
            dropout: None,
            patience: 10,
            ensemble: None,
            output_layer: None,
            first_values: FirstRule::Torch,
            imported: None,
        }
    }
}

impl TrainingConfig {
    /// Returns the settings of a network that was trained elsewhere: one epoch, with the loss of the network as
    /// imported, and initial values without the nominal model.
    pub fn of_imported(imported: Imported) -> Self {
        Self { epochs: 1, output_layer: Some(OutputLayer::Random), imported: Some(imported), ..Self::default() }
    }

    /// Returns the number of examples that an epoch uses, of `all`.
    pub fn drawn(&self, all: usize) -> usize {
        self.epoch_steps.map_or(all, |steps| self.batch * steps)
    }

    /// Returns the number of networks in an ensemble; 1 for a network by itself.
    pub fn members(&self) -> usize {
        self.ensemble.unwrap_or(1)
    }

    /// Returns whether there is an epoch 0, which is the nominal model.
    pub fn has_epoch_zero(&self) -> bool {
        self.output_layer == Some(OutputLayer::Zero)
    }

    /// Refuses invalid settings. NaN and infinity are refused by every comparison below.
    ///
    /// # Errors
    /// The first fault.
    pub fn validate(&self) -> Result<(), TrainingFault> {
        let decay = self.weight_decay.unwrap_or(0.0);
        let clip = self.clip_norm.unwrap_or(1.0);
        let dropout = self.dropout.unwrap_or(0.0);
        let epoch_steps = self.epoch_steps.unwrap_or(1);
        let count = |n: usize| (1..=1_000_000).contains(&n);
        let checks = [
            ("epochs", self.epochs.to_string(), count(self.epochs), "write 1 to 1000000, for example 60"),
            ("epoch_steps", epoch_steps.to_string(), count(epoch_steps), "write 1 to 1000000, for example 50"),
            ("batch", self.batch.to_string(), count(self.batch), "write 1 to 1000000, for example 64"),
            (
                "learning_rate",
                self.learning_rate.to_string(),
                self.learning_rate > 0.0 && self.learning_rate <= 10.0,
                "write a number above 0 and at most 10, for example 1e-3",
            ),
            (
                "weight_decay",
                decay.to_string(),
                (0.0..=10.0).contains(&decay),
                "write a number from 0 to 10, for example 0.01",
            ),
            (
                "dropout",
                dropout.to_string(),
                (0.0..1.0).contains(&dropout),
                "write a share from 0 to below 1, for example 0.2",
            ),
            (
                "clip_norm",
                clip.to_string(),
                clip > 0.0 && clip.is_finite(),
                "write a number above 0, for example 1.0, or leave it out",
            ),
            (
                "ensemble",
                self.members().to_string(),
                (1..=1000).contains(&self.members()),
                "write 1 to 1000, for example 5",
            ),
            ("warm_up", self.warm_up.to_string(), self.warm_up <= 1_000_000, "write 0 to 1000000 epochs"),
            ("patience", self.patience.to_string(), self.patience <= 1_000_000, "write 0 to 1000000 epochs"),
        ];
        match checks.into_iter().find(|(_, _, fits, _)| !fits) {
            Some((field, value, _, remedy)) => Err(TrainingFault { field, value, remedy }),
            None => self.schedule.validate(),
        }
    }
}

fn is_default(rule: &FirstRule) -> bool {
    *rule == FirstRule::default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_table_is_the_default_and_files_carry_all_of_it() {
        assert_eq!(toml::from_str::<TrainingConfig>("").unwrap(), TrainingConfig::default());
        let text = r#"
            optimizer = "adamw"
            weight_decay = 0.1
            clip_norm = 1.0
            schedule = { kind = "plateau", patience = 3, factor = 0.5 }
        "#;
        let config: TrainingConfig = toml::from_str(text).unwrap();
        assert_eq!(config.schedule, Schedule::Plateau { patience: 3, factor: 0.5 });
        assert_eq!(toml::from_str::<TrainingConfig>(&toml::to_string(&config).unwrap()).unwrap(), config);
    }

    #[test]
    fn what_cannot_be_is_refused_by_name() {
        let refused = |text: &str| toml::from_str::<TrainingConfig>(text).expect_err(text).to_string();
        assert!(refused("epoch = 3").contains("epoch"));
        assert!(refused("epochs = -3").contains("-3"));
        assert!(refused("optimizer = \"sgd\"").contains("sgd"));
        assert!(refused("schedule = { kind = \"cosine\", flor = 0 }").contains("flor"));

        let fault = |text: &str| toml::from_str::<TrainingConfig>(text).unwrap().validate().expect_err(text).field;
        assert_eq!(fault("epochs = 0"), "epochs");
        assert_eq!(fault("batch = 0"), "batch");
        for value in ["0.0", "-1e-3", "nan", "inf"] {
            assert_eq!(fault(&format!("learning_rate = {value}")), "learning_rate");
            assert_eq!(fault(&format!("clip_norm = {value}")), "clip_norm");
        }
        assert_eq!(fault("weight_decay = nan"), "weight_decay");
        assert_eq!(fault("dropout = 1.0"), "dropout");
        assert_eq!(fault("schedule = { kind = \"step\", every = 0 }"), "schedule.every");
        assert_eq!(fault("schedule = { kind = \"plateau\", factor = 1.5 }"), "schedule.factor");
        assert_eq!(fault("schedule = { kind = \"cosine\", floor = nan }"), "schedule.floor");
    }
}
