//! Parameters from a file of torch.
//!
//! | file                | read by                                  |
//! | ------------------- | ---------------------------------------- |
//! | `.safetensors`      | safetensors                              |
//! | `.pt`, `.pth`       | burn-store, in the feature `pytorch`     |

use std::path::Path;

use acm_datasets::files::regular;
use acm_eval::error::EvalError;
use acm_train::learn::import::Tensor;
use safetensors::{Dtype, SafeTensors, tensor::TensorView};

/// Largest size of a file of a network.
const LARGEST: u64 = 1 << 30;

/// Reads all tensors of a file.
///
/// # Errors
/// The file cannot be read, or holds something else than single or double precision.
pub fn read(file: &Path) -> Result<Vec<Tensor>, EvalError> {
    let length = std::fs::metadata(file).map_err(|error| EvalError::read(file, error))?.len();
    if length > LARGEST {
        return Err(EvalError::Data(format!("{} has {length} bytes, more than any network here", file.display())));
    }
    match file.extension().and_then(|extension| extension.to_str()) {
        Some("pt" | "pth") => pickled(file),
        _ => safe(file),
    }
}

fn safe(file: &Path) -> Result<Vec<Tensor>, EvalError> {
    let refused = |what: String| EvalError::Data(format!("{}: {what}", file.display()));
    let bytes = regular::read(file).map_err(|error| EvalError::read(file, error))?;
    let tensors = SafeTensors::deserialize(&bytes).map_err(|error| {
        refused(format!("{error}; write it with safetensors.torch.save_file(module.state_dict(), FILE)"))
    })?;
    let one = |(name, view): (String, TensorView)| match floats(&view) {
        Some(values) => Ok(Tensor { name, axes: view.shape().to_vec(), values }),
        None => Err(refused(format!("{name} is {:?}; save it as float32 or float64", view.dtype()))),
    };
    tensors.tensors().into_iter().map(one).collect()
}

/// Converts to single precision; double precision is rounded.
fn floats(view: &TensorView) -> Option<Vec<f32>> {
    let bytes = view.data();
    match view.dtype() {
        Dtype::F32 => Some(bytes.as_chunks::<4>().0.iter().map(|four| f32::from_le_bytes(*four)).collect()),
        Dtype::F64 => Some(bytes.as_chunks::<8>().0.iter().map(|eight| f64::from_le_bytes(*eight) as f32).collect()),
        _ => None,
    }
}

#[cfg(feature = "pytorch")]
fn pickled(file: &Path) -> Result<Vec<Tensor>, EvalError> {
    let refused = |what: String| EvalError::Data(format!("{}: {what}", file.display()));
    let found = acm_models::torch::tensors(file).map_err(|error| refused(error.to_string()))?;
    Ok(found.into_iter().map(|(name, axes, values)| Tensor { name, axes, values }).collect())
}

#[cfg(not(feature = "pytorch"))]
fn pickled(file: &Path) -> Result<Vec<Tensor>, EvalError> {
    let as_safetensors = "safetensors.torch.save_file(torch.load(FILE, weights_only=True), \"gru.safetensors\")";
    let what = "this build reads no pickles";
    let remedy = format!("write `{as_safetensors}` in Python, or build acm-eval with --features pytorch");
    Err(EvalError::Usage(format!("{}: {what}; {remedy}", file.display())))
}
