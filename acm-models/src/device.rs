//! Devices by name.
//!
//! | name      | computes on                             | feature   |
//! | --------- | --------------------------------------- | --------- |
//! | `flex`    | any processor                           |           |
//! | `ndarray` | any processor, by burn's older backend  | `ndarray` |
//! | `cuda`    | the first GPU that NVIDIA's driver has  | `cuda`    |
//! | `wgpu`    | the GPU that wgpu prefers               | `wgpu`    |

use burn::tensor::Device;
use thiserror::Error;

/// Names of the devices.
pub const DEVICES: [&str; 4] = ["flex", "ndarray", "cuda", "wgpu"];

/// Reason why a device is not available, with the remedy.
#[derive(Debug, Error)]
#[error("{0}")]
pub struct DeviceError(String);

/// Returns the device called `name`, without autodiff.
///
/// # Errors
/// An unknown name, a device that this program was built without, or a GPU that this machine lacks.
pub fn device(name: &str) -> Result<Device, DeviceError> {
    match name {
        "flex" => Ok(Device::flex()),
        "ndarray" => ndarray(),
        "cuda" => cuda(),
        "wgpu" => wgpu(),
        _ => Err(DeviceError(format!("there is no device {name:?}; there are {}", DEVICES.join(", ")))),
    }
}

#[cfg(feature = "ndarray")]
#[expect(deprecated, reason = "asked for by name; burn says to prefer flex")]
fn ndarray() -> Result<Device, DeviceError> {
    Ok(Device::ndarray())
}

#[cfg(not(feature = "ndarray"))]
fn ndarray() -> Result<Device, DeviceError> {
    Err(not_built("ndarray"))
}

#[cfg(feature = "cuda")]
fn cuda() -> Result<Device, DeviceError> {
    present("cuda", burn::tensor::DeviceType::Cuda, "NVIDIA's driver").map(|()| Device::cuda(0))
}

#[cfg(not(feature = "cuda"))]
fn cuda() -> Result<Device, DeviceError> {
    Err(not_built("cuda"))
}

#[cfg(feature = "wgpu")]
fn wgpu() -> Result<Device, DeviceError> {
    use burn::tensor::{DeviceKind, DeviceType};
    present("wgpu", DeviceType::Wgpu, "a driver for Vulkan, Metal or DirectX 12")
        .map(|()| Device::wgpu(DeviceKind::DefaultDevice))
}

#[cfg(not(feature = "wgpu"))]
fn wgpu() -> Result<Device, DeviceError> {
    Err(not_built("wgpu"))
}

/// Refuses a device of which this machine has none: burn panics when it first computes there.
#[cfg(any(feature = "cuda", feature = "wgpu"))]
fn present(name: &str, kind: burn::tensor::DeviceType, driver: &str) -> Result<(), DeviceError> {
    if Device::enumerate(kind).is_empty() {
        return Err(DeviceError(format!("this machine has no device for {name:?}; install {driver}")));
    }
    Ok(())
}

#[cfg(not(all(feature = "ndarray", feature = "cuda", feature = "wgpu")))]
fn not_built(feature: &str) -> DeviceError {
    DeviceError(format!("this program was built without the device {feature:?}; build it with --features {feature}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flex_is_always_there_and_a_missing_device_names_the_remedy() {
        assert!(device("flex").is_ok());
        for name in &DEVICES[1..] {
            if let Err(error) = device(name) {
                let told = error.to_string();
                assert!(told.contains(&format!("--features {name}")) || told.contains("install"), "{told}");
            }
        }
        assert!(device("abacus").unwrap_err().to_string().contains("abacus"));
    }
}
