//! Files of torch: stores of burn-store with the names and layouts of `nn.GRU` and of ncps' `CfCCell`.
//!
//! | here                   | torch and ncps        | layout                                        |
//! | ---------------------- | --------------------- | --------------------------------------------- |
//! | `layers.0.weight_ih`   | `weight_ih_l0`        | the same                                      |
//! | `backbone.1.weight`    | `backbone.2.weight`   | [inputs, outputs] here, [outputs, inputs] there |
//! | `ff1.weight`           | `ff1.weight`          | as above                                      |
//! | `w_tau`, `A`           | `w_tau`, `A`          | the same                                      |
//!
//! Names in front of these stay, so a module of your own with a field `cfc` reads the file of a torch module with a field
//! `cfc`. A list `backbone` or `layers` of your own is renamed as these are. burn-store reads PyTorch's own files
//! and cannot write them; safetensors go both ways.
//!
//! ```no_run
//! use acm_models::torch::{self, ModuleSnapshot};
//! use acm_models::{CfcConfig, burn::tensor::Device};
//!
//! let mut cfc = CfcConfig::new(5).with_units(32).init(&Device::flex());
//! cfc.load_from(&mut torch::pytorch("cell.pt"))?;
//! cfc.save_into(&mut torch::safetensors_out("cell.safetensors"))?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::error::Error;
use std::path::PathBuf;

use burn_store::burn_pack::Tensor;
use burn_store::{BurnToPyTorchAdapter, ModuleAdapter, ModuleContext, ModuleStore, PyTorchToBurnAdapter, bridge};

pub use burn_store::{ModuleSnapshot, PytorchStore, SafetensorsStore};

use crate::parameters::flat::torch_name;

/// Pattern of `weight_ih_l0` and its like, anywhere in a name.
const GRU: &str = r"(^|\.)((?:weight|bias)_(?:ih|hh))_l(\d+)$";
const LAYERS: &str = "${1}layers.$3.$2";

/// Opens a PyTorch file, `.pt` or `.pth`, that `torch.save(module.state_dict(), …)` wrote, for reading.
pub fn pytorch(path: impl Into<PathBuf>) -> PytorchStore {
    PytorchStore::from_file(path).with_key_remapping(GRU, LAYERS)
}

/// Reads all tensors of a PyTorch file, in single precision, as they are named and laid out there: name, axes, values
/// row by row. Double precision is rounded.
///
/// # Errors
/// The file cannot be read, or a tensor holds something else than numbers.
pub fn tensors(path: impl Into<PathBuf>) -> Result<Vec<(String, Vec<usize>, Vec<f32>)>, Box<dyn Error>> {
    let mut store = PytorchStore::from_file(path).map_indices_contiguous(false);
    let all = store.get_all_tensors()?;
    let one = |(name, tensor): (&String, &Tensor)| -> Result<_, Box<dyn Error>> {
        let data = bridge::to_data(tensor)?.convert::<f32>();
        let axes = data.shape().to_vec();
        let values = data.try_to_vec::<f32>().map_err(|error| format!("{name}: {error:?}"))?;
        Ok((name.clone(), axes, values))
    };
    all.iter().map(one).collect()
}

/// Opens a safetensors file that `safetensors.torch.save_file(module.state_dict(), …)` wrote, for reading.
pub fn safetensors_in(path: impl Into<PathBuf>) -> SafetensorsStore {
    SafetensorsStore::from_file(path)
        .with_from_adapter(PyTorchToBurnAdapter)
        .skip_enum_variants(true)
        .map_indices_contiguous(true)
        .with_key_remapping(GRU, LAYERS)
}

/// Opens a safetensors file for writing, which `module.load_state_dict(safetensors.torch.load_file(…))` reads. An
/// existing file is replaced.
pub fn safetensors_out(path: impl Into<PathBuf>) -> SafetensorsStore {
    SafetensorsStore::from_file(path)
        .with_to_adapter(BurnToPyTorchAdapter.chain(TorchNames))
        .skip_enum_variants(true)
        .overwrite(true)
}

/// Adapter that gives each tensor its name in torch.
#[derive(Clone, Debug)]
struct TorchNames;

impl ModuleAdapter for TorchNames {
    fn adapt(&self, mut tensor: Tensor, _: ModuleContext<'_>) -> Tensor {
        tensor.name = torch_name(&tensor.name);
        tensor
    }

    fn clone_box(&self) -> Box<dyn ModuleAdapter> {
        Box::new(self.clone())
    }
}
