//! `[network]`: the network of an experiment, and the outputs that it corrects.
//!
//! ```toml
//! [network]
//! kind     = "gru"
//! corrects = ["tip", "actuators"]   # left out: ["tip"]
//! ```

use std::ops::Deref;

use acm_models::NetworkConfig;
use serde::{Deserialize, Deserializer, Serialize, de::Error};
use toml::{Table, Value};

/// A network's kind and sizes, and what it corrects.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExperimentNetwork {
    /// Places where the corrections enter; empty where the key is left out: the tip alone.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub corrects: Vec<Corrected>,
    /// Kind and sizes.
    #[serde(flatten)]
    pub config: NetworkConfig,
}

/// A quantity that a network corrects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Corrected {
    /// The tip: the correction is added to the nominal prediction.
    Tip,
    /// The actuators: the correction moves the tip by the slopes of the arm.
    Actuators,
}

impl ExperimentNetwork {
    /// Returns whether the network corrects the actuators beside the tip.
    pub fn corrects_actuators(&self) -> bool {
        self.corrects.contains(&Corrected::Actuators)
    }
}

impl Default for ExperimentNetwork {
    fn default() -> Self {
        NetworkConfig::default().into()
    }
}

impl From<NetworkConfig> for ExperimentNetwork {
    fn from(config: NetworkConfig) -> Self {
        Self { corrects: vec![], config }
    }
}

impl Deref for ExperimentNetwork {
    type Target = NetworkConfig;

    fn deref(&self) -> &NetworkConfig {
        &self.config
    }
}

/// An explicit empty list.
const CORRECTS_NOTHING: &str = "an empty list corrects nothing; write [\"tip\"] or [\"tip\", \"actuators\"]";

/// Reads `corrects` from the table; the network reads the rest, and refuses unknown keys.
impl<'de> Deserialize<'de> for ExperimentNetwork {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut table = Table::deserialize(deserializer)?;
        let corrects = table.remove("corrects").map(Vec::<Corrected>::deserialize).transpose();
        let corrects = corrects.map_err(|error| D::Error::custom(error.to_string().trim_end()))?;
        if corrects.as_ref().is_some_and(Vec::is_empty) {
            return Err(D::Error::custom(CORRECTS_NOTHING));
        }
        let corrects = corrects.unwrap_or_default();
        let config = NetworkConfig::deserialize(Value::Table(table));
        Ok(Self { corrects, config: config.map_err(|error| D::Error::custom(error.to_string().trim_end()))? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<ExperimentNetwork, toml::de::Error> {
        toml::from_str(text)
    }

    #[test]
    fn a_network_is_read_and_written_with_what_it_corrects() {
        let network = read("kind = \"gru\"\nunits = 8\ncorrects = [\"tip\", \"actuators\"]").unwrap();
        assert_eq!((network.kind(), network.corrects_actuators()), ("gru", true));
        assert_eq!(read(&toml::to_string(&network).unwrap()).unwrap(), network);
        let json = serde_json::to_string(&network).unwrap();
        assert_eq!(serde_json::from_str::<ExperimentNetwork>(&json).unwrap(), network);
        assert!(!read("kind = \"gru\"").unwrap().corrects_actuators());
    }

    #[test]
    fn what_is_no_network_is_refused_as_before() {
        assert!(read("kind = \"gru\"\nunit = 8").unwrap_err().to_string().contains("unit"));
        assert!(read("kind = \"gru\"\ncorrects = []").unwrap_err().to_string().contains(CORRECTS_NOTHING));
        assert!(read("kind = \"gru\"\ncorrects = [\"base\"]").unwrap_err().to_string().contains("base"));
    }
}
