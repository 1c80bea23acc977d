//! Devices by the names that experiments use.

use acm_models::burn::tensor::Device;
use thiserror::Error;

/// The names that an experiment may give.
pub const NAMES: [&str; 4] = ["flex", "ndarray", "cuda", "wgpu"];

/// Reason why a device is not available, and what to write instead.
#[derive(Debug, Error)]
#[error("{0}")]
pub struct DeviceError(String);

/// Returns the device called `name`, without autodiff.
///
/// # Errors
/// An unknown name, or a device that this program was built without; the message names the feature to build with.
pub fn device(name: &str) -> Result<Device, DeviceError> {
    match name {
        "flex" => Ok(Device::flex()),
        "ndarray" => ndarray(),
        "cuda" => cuda(),
        "wgpu" => wgpu(),
        _ => Err(DeviceError(format!(
            "there is no device {name:?}; write device = \"flex\" for any CPU, or one of {}",
            NAMES[1..].join(", ")
        ))),
    }
}

#[cfg(feature = "ndarray")]
#[expect(deprecated, reason = "the experiment asks for it by name; burn says to prefer flex")]
fn ndarray() -> Result<Device, DeviceError> {
    Ok(Device::ndarray())
}

#[cfg(not(feature = "ndarray"))]
fn ndarray() -> Result<Device, DeviceError> {
    Err(missing("ndarray"))
}

#[cfg(feature = "cuda")]
fn cuda() -> Result<Device, DeviceError> {
    Ok(Device::cuda(0))
}

#[cfg(not(feature = "cuda"))]
fn cuda() -> Result<Device, DeviceError> {
    Err(missing("cuda"))
}

#[cfg(feature = "wgpu")]
fn wgpu() -> Result<Device, DeviceError> {
    Ok(Device::wgpu(acm_models::burn::tensor::DeviceKind::DefaultDevice))
}

#[cfg(not(feature = "wgpu"))]
fn wgpu() -> Result<Device, DeviceError> {
    Err(missing("wgpu"))
}

#[cfg(not(all(feature = "ndarray", feature = "cuda", feature = "wgpu")))]
fn missing(feature: &str) -> DeviceError {
    DeviceError(format!(
        "this program was built without the device {feature:?}; build it with `cargo run -p acm-train --features \
         {feature} -- …`, or write device = \"flex\""
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flex_is_always_there_and_a_missing_device_names_its_feature() {
        assert!(device("flex").is_ok());
        for name in &NAMES[1..] {
            if let Err(error) = device(name) {
                assert!(error.to_string().contains(&format!("--features {name}")), "{error}");
            }
        }
        assert!(device("abacus").unwrap_err().to_string().contains("abacus"));
    }
}
