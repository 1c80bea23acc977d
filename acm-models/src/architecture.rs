//! Requirements on a network's configuration.

use std::fmt::Debug;

pub use acm_kernels::Keep;

use acm_kernels::Body;
use thiserror::Error;

/// A value in a network's configuration that cannot be built.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("network {kind}: {field} = {value} cannot be built; {remedy}")]
pub struct ConfigError {
    /// Name of the network, as in `kind`.
    pub kind: &'static str,
    /// Name of the field.
    pub field: &'static str,
    /// The refused value.
    pub value: String,
    /// Accepted values.
    pub remedy: &'static str,
}

/// A network's configuration: numbers only, and no tensor.
pub trait Architecture: Debug {
    /// Returns the name under which files ask for it.
    fn kind(&self) -> &'static str;

    /// Refuses sizes that cannot be built. The number of channels is not checked, since files leave it to the data.
    ///
    /// # Errors
    /// Names the field, its value and what to write instead.
    fn validate(&self) -> Result<(), ConfigError>;

    /// Returns the sizes as the fused kernels take them.
    fn body(&self) -> Body;
}

/// Refuses a count outside 1 ..= `most`.
pub(crate) fn check_count(
    kind: &'static str,
    field: &'static str,
    value: usize,
    most: usize,
    remedy: &'static str,
) -> Result<(), ConfigError> {
    if (1..=most).contains(&value) {
        return Ok(());
    }
    Err(ConfigError { kind, field, value: value.to_string(), remedy })
}

/// Checks that a configuration can be built, for `inputs` channels.
///
/// # Panics
/// If it cannot.
pub(crate) fn checked(config: &impl Architecture, inputs: usize) {
    config.validate().unwrap_or_else(|error| panic!("{error}"));
    assert!(inputs > 0, "network {}: inputs = 0 cannot be built; say how many channels there are", config.kind());
}
