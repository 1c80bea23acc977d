//! A cell that was trained in torch, read from its file, and written back for torch.
//!
//! ```text
//! cargo run -p acm-models --features store --example torch_file -- [CELL.pt] [OUT.safetensors]
//! ```
//!
//! The file is that of `torch.save(cell.state_dict(), "cell.pt")` with an ncps `CfCCell(4, 5, backbone_units=7,
//! backbone_layers=2)`; without arguments it is the one among the golden numbers. Reading back in torch:
//!
//! ```text
//! cell.load_state_dict(safetensors.torch.load_file("cell.safetensors"))
//! ```

use std::error::Error;
use std::path::PathBuf;

use acm_models::CfcConfig;
use acm_models::burn::tensor::{Device, Tensor};
use acm_models::torch::{self, ModuleSnapshot};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let golden = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/cfc_default_L2.pt");
    let from = arguments.next().unwrap_or_else(|| golden.into());
    let to = arguments.next().unwrap_or_else(|| std::env::temp_dir().join("cell.safetensors"));

    let device = Device::flex();
    let mut cell = CfcConfig::new(4).with_units(5).with_backbone(2, 7).init(&device);
    let read = cell.load_from(&mut torch::pytorch(&from))?;
    println!("read {} parameters from {}: {}", read.applied.len(), from.display(), read.applied.join(", "));

    let states = cell.forward(Tensor::ones([1, 3, 4], &device), Tensor::full([1, 3], 0.1, &device));
    println!("states after three steps of 0.1 s with ones: {}", states.narrow(1, 2, 1).into_data());

    cell.save_into(&mut torch::safetensors_out(&to))?;
    println!("written to {}", to.display());
    Ok(())
}
