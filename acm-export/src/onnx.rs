//! The network's step as an ONNX model, with its scalers inside; opset 17.
//!
//! ```text
//! (channels, Δt, state) → (residual, state')      residual = spread · network((channels − mean)/spread, Δt, state) + mean
//! ```
//!
//! | tensor             | meaning                                       | shape              | type   |
//! | ------------------ | --------------------------------------------- | ------------------ | ------ |
//! | `channels`         | channels of the network, SI                   | `[N, C]`           | double |
//! | `elapsed`          | time since the step before, s; for a CfC      | `[N, 1]`           | float  |
//! | `state`            | the network's state, zero at a start          | `[N, E·layers·H]`  | float  |
//! | `residual`         | what the network adds to the nominal model, SI | `[N, O]`          | double |
//! | `next_state`       | to be handed to the next step                 | `[N, E·layers·H]`  | float  |
//!
//! An ensemble of E networks is one graph: `residual` is the mean over them, and `state` the states one after the other.
//! Channels are double, since a signal may be large beside its spread. What a step needs beside the model (which signals the
//! channels are, how long a gap is, the time given before the first sample) stands in the model's metadata, and in
//! the JSON file with recorded vectors. The nominal model stays outside.

mod graph;
mod message;

use std::path::PathBuf;

use acm_stream::Parts;
use prost::Message;

use crate::{
    ExportError, File, Origin, description, fingerprint, refuse_unsupported, refuse_without_network, rehearsal,
    with_factor_in_scaler,
};

/// Default number of recorded steps.
const RECORDED: usize = 300;

/// Words at the head of every script.
const CHECK: &str = ".onnx with the recorded vectors of ";

/// Writes the model, recorded vectors, and a script that compares them by ONNX Runtime.
///
/// # Errors
/// Parts that make no estimator, or a name that is no identifier.
pub fn export(parts: &Parts, origin: &Origin) -> Result<Vec<File>, ExportError> {
    origin.validate()?;
    refuse_unsupported(parts, "ONNX")?;
    refuse_without_network(parts, "ONNX")?;
    let vectors = rehearsal::steps(parts, origin.recorded.unwrap_or(RECORDED))?;
    let hash = fingerprint(parts)?;
    let parts = &with_factor_in_scaler(parts);
    let about = description::of(parts, origin, &hash);
    let model = graph::model(parts, origin, &about);
    let name = |end: &str| PathBuf::from(format!("{}{end}", origin.name));
    Ok(vec![
        File { path: name(".onnx"), bytes: model.encode_to_vec(), marks: &["acm-export"] },
        File {
            path: name("_onnx.json"),
            bytes: description::with_vectors(about, &vectors)?,
            marks: description::MARKS,
        },
        File {
            path: name("_onnx_check.py"),
            bytes: include_str!("onnx/check.py").replace("@NAME", &origin.name).into_bytes(),
            marks: &[CHECK],
        },
    ])
}
