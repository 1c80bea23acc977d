//! The network for PyTorch: safetensors with the names of torch and ncps, scalers as JSON, and a module that puts them together.
//!
//! | file            | what                                                                             |
//! | --------------- | -------------------------------------------------------------------------------- |
//! | `*.safetensors` | parameters, named as in [`crate::parameters`]; of an ensemble, behind `members.0.`, `members.1.`, … |
//! | `*_torch.json`  | sizes, channels, scalers, `max_gap`, recorded steps                              |
//! | `*_torch.py`    | `load(folder)`, a `torch.nn.Module`; run, it compares itself with recorded steps  |
//!
//! The module's `step` is (channels, Δt, state) → (residual, state'). It calls ncps' *cell*: the `timespans` of its sequence class are wrong for batches (ncps issues 81 and 83).

use std::path::PathBuf;

use acm_stream::Parts;
use safetensors::Dtype;
use safetensors::tensor::TensorView;

use crate::{
    ExportError, File, Origin, description, fingerprint, parameters, refuse_unsupported, refuse_without_network,
    rehearsal, weights_of_each, with_factor_in_scaler,
};

/// Default number of recorded steps.
const RECORDED: usize = 300;

/// Words at the head of every module.
const LOADER: &str = ".safetensors as a torch.nn.Module: one step, with its scalers.";

/// Writes parameters, description and module.
///
/// # Errors
/// Parts that make no estimator, or a name that is no identifier.
pub fn export(parts: &Parts, origin: &Origin) -> Result<Vec<File>, ExportError> {
    origin.validate()?;
    refuse_unsupported(parts, "PyTorch")?;
    refuse_without_network(parts, "PyTorch")?;
    let vectors = rehearsal::steps(parts, origin.recorded.unwrap_or(RECORDED))?;
    let hash = fingerprint(parts)?;
    let parts = &with_factor_in_scaler(parts);
    let about = description::of(parts, origin, &hash);
    let name = |end: &str| PathBuf::from(format!("{}{end}", origin.name));
    Ok(vec![
        File { path: name(".safetensors"), bytes: tensors(parts, &hash)?, marks: &["\"estimator_sha256\""] },
        File {
            path: name("_torch.json"),
            bytes: description::with_vectors(about, &vectors)?,
            marks: description::MARKS,
        },
        File {
            path: name("_torch.py"),
            bytes: include_str!("torch/loader.py").replace("@NAME", &origin.name).into_bytes(),
            marks: &[LOADER],
        },
    ])
}

fn tensors(parts: &Parts, hash: &str) -> Result<Vec<u8>, ExportError> {
    let prefix = |k: usize| if parts.members.is_empty() { String::new() } else { format!("members.{k}.") };
    let of = |(k, weights)| {
        let own = parameters(&parts.network, weights);
        own.into_iter().map(move |parameter| (format!("{}{}", prefix(k), parameter.name), parameter))
    };
    let named: Vec<_> = weights_of_each(parts).enumerate().flat_map(of).collect();
    let bytes: Vec<Vec<u8>> =
        named.iter().map(|(_, p)| p.values.iter().flat_map(|value| value.to_le_bytes()).collect()).collect();
    let mut views = Vec::with_capacity(named.len());
    for ((name, parameter), bytes) in named.iter().zip(&bytes) {
        views.push((name.as_str(), TensorView::new(Dtype::F32, parameter.shape.clone(), bytes)?));
    }
    let about = [("estimator_sha256".to_owned(), hash.to_owned())].into_iter().collect();
    Ok(safetensors::serialize(views, Some(about))?)
}
