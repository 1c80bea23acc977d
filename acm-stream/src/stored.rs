//! Serialised form of the network's shape; all other parts derive theirs.

use acm_kernels::{Activation, Body, CfcMode, CfcShape, GruShape, MlpShape, Shape};
use serde::{Deserialize, Serialize};

/// Serialised form of [`Shape`].
#[derive(Serialize, Deserialize)]
#[serde(remote = "Shape", deny_unknown_fields)]
pub struct StoredShape {
    #[serde(with = "StoredBody")]
    body: Body,
    inputs: usize,
    outputs: usize,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Body", rename_all = "snake_case")]
enum StoredBody {
    Cfc(#[serde(with = "StoredCfc")] CfcShape),
    Gru(#[serde(with = "StoredGru")] GruShape),
    Mlp(#[serde(with = "StoredMlp")] MlpShape),
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "CfcShape", deny_unknown_fields)]
struct StoredCfc {
    units: usize,
    mode: CfcMode,
    backbone_units: usize,
    backbone_layers: usize,
    activation: Activation,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "GruShape", deny_unknown_fields)]
struct StoredGru {
    units: usize,
    layers: usize,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "MlpShape", deny_unknown_fields)]
struct StoredMlp {
    hidden: Vec<usize>,
    activation: Activation,
}
