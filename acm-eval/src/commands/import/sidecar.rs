//! Facts that weights do not contain: the network's kind and sizes, its channels, its scalers. `acm-eval export
//! --torch` writes the same format.

use std::path::{Path, PathBuf};

use acm_datasets::{Standardizer, files::regular};
use acm_eval::error::EvalError;
use acm_models::NetworkConfig;
use acm_train::{config::Experiment, learn::Scalers};
use serde::Deserialize;
use serde_json::{Map, Value};

/// The keys that are read; an export has more.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct About {
    network: Option<Map<String, Value>>,
    channels: Option<Vec<Channel>>,
    inputs: Option<Standardizer>,
    targets: Option<Standardizer>,
}

#[derive(Debug, Deserialize)]
struct Channel {
    signal: String,
    #[serde(default)]
    rate: bool,
}

/// A file of it, or nothing.
#[derive(Debug, Default)]
pub struct Sidecar {
    file: PathBuf,
    about: About,
}

impl Sidecar {
    /// Returns the file `asked`, else the one that an export writes beside `weights`, else nothing.
    ///
    /// # Errors
    /// It cannot be read, or holds something else.
    pub fn of(weights: &Path, asked: Option<&Path>) -> Result<Self, EvalError> {
        let stem = weights.file_stem().unwrap_or_default().to_string_lossy();
        let beside = weights.with_file_name(format!("{stem}_torch.json"));
        let file = match asked {
            Some(file) => file.to_path_buf(),
            None if beside.is_file() => beside,
            None => return Ok(Self::default()),
        };
        let text = regular::read(&file).map_err(|error| EvalError::read(&file, error))?;
        let about: About =
            serde_json::from_slice(&text).map_err(|error| EvalError::Data(format!("{}: {error}", file.display())))?;
        if about.inputs.is_some() != about.targets.is_some() {
            let what = "it has one of inputs and targets; give the scalers of both, or of neither";
            return Err(EvalError::Data(format!("{}: {what}", file.display())));
        }
        Ok(Self { file, about })
    }

    /// Writes network and channels into an experiment.
    ///
    /// # Errors
    /// There is no such network.
    pub fn apply(&self, experiment: &mut Experiment) -> Result<(), EvalError> {
        if let Some(network) = &self.about.network {
            let own = network.iter().filter(|(key, _)| !["inputs", "outputs"].contains(&key.as_str()));
            let own: Map<String, Value> = own.map(|(key, value)| (key.clone(), value.clone())).collect();
            let refused = |what: String| EvalError::Data(format!("{}: network: {what}", self.file.display()));
            experiment.network = serde_json::from_value::<NetworkConfig>(Value::Object(own))
                .map_err(|error| refused(error.to_string()))?
                .into();
            experiment.network.architecture().validate().map_err(|error| refused(error.to_string()))?;
        }
        if let Some(channels) = &self.about.channels {
            let name = |c: &Channel| if c.rate { format!("rate({})", c.signal) } else { c.signal.clone() };
            experiment.inputs.channels = Some(channels.iter().map(name).collect());
        }
        Ok(())
    }

    /// Returns the scalers that the network was trained with.
    pub fn scalers(&self) -> Option<Scalers> {
        let (inputs, targets) = self.about.inputs.clone().zip(self.about.targets.clone())?;
        Some(Scalers { inputs, targets, actuators: vec![], straight: None })
    }
}
