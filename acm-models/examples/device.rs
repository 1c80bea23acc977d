//! Asks for a device by its name, and computes a first number on it.
//!
//! ```text
//! cargo run -p acm-models --features wgpu --example device -- wgpu
//! ```

use acm_models::burn::tensor::Tensor;
use acm_models::device;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "flex".into());
    let device = device(&name)?;
    let sum: f32 = Tensor::<1>::ones([10], &device).sum().into_scalar();
    println!("{name} is here: a sum of ten ones is {sum}");
    Ok(())
}
