//! Checkpoints: one file from which a fit continues to the same bits.
//!
//! A safetensors file with
//!
//! | tensor               | what                                | shape              |
//! | -------------------- | ----------------------------------- | ------------------ |
//! | `weights.<name>`     | weights after the last epoch        | as torch           |
//! | `best.<name>`        | weights of the best epoch           | as torch           |
//! | `optimizer.first`    | average gradient                    | `[parameters]`       |
//! | `optimizer.second`   | average squared gradient            | `[parameters]`       |
//!
//! and one entry of metadata, `acm`: a SHA-256 over all else, then JSON with the steps taken, the epochs and the
//! [`Identity`] of the run. Generators have no entry: seed and epoch number are their whole state. The file is written
//! in one atomic step. On reading, the hash must fit and the content, written again, must give the same file, so any
//! changed bit is found, in the header too.

use std::collections::{BTreeMap, HashMap};
use std::io;
use std::path::Path;

use acm_models::{Keep, Network, NetworkConfig};
use safetensors::tensor::{Dtype, SafeTensors, TensorView};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use super::error::LearnError;
use super::examples::Examples;
use super::fit::epoch::Epoch;
use super::fit::progress::Progress;
use super::fit::task::Task;
use super::projection::Projection;
use crate::{
    config::TrainingConfig,
    store::{StoreError, atomic, bounded},
};
use acm_models::optimizer::moments::Moments;

const FORMAT: u32 = 1;
const KEY: &str = "acm";

/// Settings that must be equal for a fit to be continued.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Identity {
    format: u32,
    network: NetworkConfig,
    channels: usize,
    outputs: usize,
    training: TrainingConfig,
    supervise: String,
    seed: u64,
    training_windows: String,
    validation_windows: String,
}

impl Identity {
    /// Returns the identity of a task on these windows; without a validation part, of a fit to all trials.
    pub fn new(task: &Task, training: &dyn Examples, validation: Option<&dyn Examples>) -> Self {
        let supervise = match task.supervise {
            Keep::Last => "last",
            Keep::Every => "every",
        };
        Self {
            format: FORMAT,
            network: task.network.clone(),
            channels: training.channels(),
            outputs: training.outputs(),
            training: task.training.clone(),
            supervise: supervise.into(),
            seed: task.seed,
            training_windows: training.fingerprint(),
            validation_windows: validation.map_or_else(|| "none".into(), Examples::fingerprint),
        }
    }

    /// Lists each setting that differs: `network.units is 32 there and 16 here`.
    fn differences(&self, there: &Value) -> String {
        let here = serde_json::to_value(self).unwrap_or(Value::Null);
        let (here, there) = (leaves(&here), leaves(there));
        let mut keys: Vec<&String> = here.keys().chain(there.keys()).collect();
        keys.sort();
        keys.dedup();
        let show =
            |value: Option<&String>| value.map_or("left out".into(), |text| text.chars().take(20).collect::<String>());
        keys.retain(|key| here.get(*key) != there.get(*key));
        let parts =
            keys.iter().map(|&key| format!("{key} is {} there and {} here", show(there.get(key)), show(here.get(key))));
        parts.collect::<Vec<_>>().join(", ")
    }
}

/// Returns the values in a tree by their dotted keys.
fn leaves(tree: &Value) -> BTreeMap<String, String> {
    match tree {
        Value::Object(entries) => entries
            .iter()
            .flat_map(|(key, value)| {
                leaves(value).into_iter().map(move |(below, text)| {
                    (if below.is_empty() { key.clone() } else { format!("{key}.{below}") }, text)
                })
            })
            .collect(),
        leaf => BTreeMap::from([(String::new(), leaf.to_string())]),
    }
}

#[derive(Serialize, Deserialize)]
struct Header {
    identity: Value,
    steps: u64,
    epochs: Vec<Epoch>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    zero: Option<Epoch>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    projections: Vec<Projection>,
}

/// Writes the state of a fit to `path` atomically.
///
/// # Errors
/// The file system refuses.
pub fn write(path: &Path, identity: &Identity, network: &Network, progress: &Progress) -> Result<(), LearnError> {
    let refuse = |source: io::Error| LearnError::from(StoreError::io("write", path, source));
    let identity = serde_json::to_value(identity).map_err(|error| refuse(io::Error::other(error)))?;
    let bytes = encode(identity, network, progress).map_err(|error| refuse(io::Error::other(error)))?;
    Ok(atomic::write(path, &bytes)?)
}

/// Reads the state of the fit from the file at `path`; `None` if there is no file.
///
/// # Errors
/// The file cannot be read, has been changed since it was written, or is of another run.
pub fn read(path: &Path, identity: &Identity, network: &Network) -> Result<Option<Progress>, LearnError> {
    let bytes = match bounded::read(path, longest(identity, network)) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) if matches!(error.kind(), io::ErrorKind::InvalidData | io::ErrorKind::IsADirectory) => {
            return Err(LearnError::Damaged { path: path.into(), why: error.to_string() });
        }
        Err(source) => return Err(StoreError::io("read", path, source).into()),
    };
    parse(path, &bytes, identity, network).map(Some)
}

/// Reads the state of the fit from `bytes`; `path` is for messages.
///
/// # Errors
/// As [`read`], without the file system.
pub fn parse(path: &Path, bytes: &[u8], identity: &Identity, network: &Network) -> Result<Progress, LearnError> {
    let damaged = |why: String| LearnError::Damaged { path: path.into(), why };
    let (file, header) = verified(bytes).map_err(&damaged)?;
    let differences = identity.differences(&header.identity);
    if !differences.is_empty() {
        return Err(LearnError::Another { path: path.into(), differences });
    }
    let progress = decode(&file, &header, network).map_err(&damaged)?;
    match encode(header.identity, network, &progress) {
        Ok(again) if again == bytes => Ok(progress),
        _ => Err(damaged("it is not the file that its content would be written as".into())),
    }
}

/// Returns the length that no checkpoint of this network exceeds: four numbers a parameter, and a header with a line
/// for each epoch.
fn longest(identity: &Identity, network: &Network) -> u64 {
    const HEADER: u64 = 1 << 20;
    const EPOCH: u64 = 1024;
    let numbers = 4 * size_of::<f32>() * network.parameter_count();
    HEADER + numbers as u64 + EPOCH * identity.training.epochs as u64
}

type Named = (String, Vec<usize>, Vec<u8>);

fn encode(identity: Value, network: &Network, progress: &Progress) -> Result<Vec<u8>, String> {
    let tensors = tensors(network, progress);
    let Progress { moments, epochs, zero, projections, .. } = progress.clone();
    let header = Header { identity, steps: moments.steps, epochs, zero, projections };
    let header = serde_json::to_string(&header).map_err(|error| error.to_string())?;
    let views = tensors.iter().map(|(name, shape, bytes)| {
        TensorView::new(Dtype::F32, shape.clone(), bytes).map(|view| (name.as_str(), view))
    });
    let views = views.collect::<Result<Vec<_>, _>>().map_err(|error| error.to_string())?;
    let hash = hash(&header, views.iter().map(|(name, view)| (*name, view.clone())));
    let metadata = HashMap::from([(KEY.to_string(), format!("{hash}{header}"))]);
    safetensors::serialize(views, Some(metadata)).map_err(|error| error.to_string())
}

fn tensors(network: &Network, progress: &Progress) -> Vec<Named> {
    let moments = &progress.moments;
    let mut all = vec![
        ("optimizer.first".to_string(), vec![moments.first.len()], bytes(&moments.first)),
        ("optimizer.second".to_string(), vec![moments.second.len()], bytes(&moments.second)),
    ];
    for (group, values) in [("weights", &progress.weights), ("best", &progress.best)] {
        let mut rest = values.as_slice();
        for parameter in network.parameters() {
            let (own, others) = rest.split_at(parameter.len());
            all.push((format!("{group}.{}", parameter.name), parameter.shape.clone(), bytes(own)));
            rest = others;
        }
    }
    all
}

/// Returns the SHA-256 over the header and each tensor's name, shape and bytes, by name, in hexadecimal.
fn hash<'a>(header: &str, tensors: impl Iterator<Item = (&'a str, TensorView<'a>)>) -> String {
    let tensors: BTreeMap<&str, TensorView> = tensors.collect();
    let mut hash = Sha256::new();
    hash.update(header.as_bytes());
    for (name, view) in tensors {
        hash.update(name.as_bytes());
        view.shape().iter().for_each(|&axis| hash.update((axis as u64).to_le_bytes()));
        hash.update(view.data());
    }
    acm_hashed::hexadecimal(&hash.finalize())
}

fn verified(bytes: &[u8]) -> Result<(SafeTensors<'_>, Header), String> {
    let (_, metadata) = SafeTensors::read_metadata(bytes).map_err(|error| error.to_string())?;
    let file = SafeTensors::deserialize(bytes).map_err(|error| error.to_string())?;
    let entry = metadata.metadata().as_ref().and_then(|entries| entries.get(KEY));
    let entry = entry.ok_or("it has no entry `acm`, so this program did not write it")?;
    let (noted, header) = entry.split_at_checked(64).ok_or("its hash is cut off")?;
    if noted != hash(header, file.iter()) {
        return Err("its content does not fit its hash".into());
    }
    let header = serde_json::from_str(header).map_err(|error| error.to_string())?;
    Ok((file, header))
}

fn decode(file: &SafeTensors, header: &Header, network: &Network) -> Result<Progress, String> {
    let tensor = |name: &str| {
        let view = file.tensor(name).map_err(|error| error.to_string())?;
        Ok::<_, String>(floats(view.data()))
    };
    let group = |group: &str| {
        let mut all = Vec::with_capacity(network.parameter_count());
        for parameter in network.parameters() {
            let values = tensor(&format!("{group}.{}", parameter.name))?;
            if values.len() != parameter.len() {
                return Err(format!("{group}.{} has {} values", parameter.name, values.len()));
            }
            all.extend(values);
        }
        Ok(all)
    };
    let moments =
        Moments { steps: header.steps, first: tensor("optimizer.first")?, second: tensor("optimizer.second")? };
    if moments.first.len() != network.parameter_count() || moments.second.len() != network.parameter_count() {
        return Err("the optimizer's averages are not one for each parameter".into());
    }
    let (weights, best) = (group("weights")?, group("best")?);
    let (epochs, zero, projections) = (header.epochs.clone(), header.zero, header.projections.clone());
    Ok(Progress { weights, best, moments, epochs, zero, projections })
}

fn bytes(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks::<4>().0.iter().map(|four| f32::from_le_bytes(*four)).collect()
}
