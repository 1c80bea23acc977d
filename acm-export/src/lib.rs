//! Exports a trained estimator for other programs: C99, ONNX, PyTorch.
//!
//! | export   | contents                                                       | for                      |
//! | -------- | -------------------------------------------------------------- | ------------------------ |
//! | [`c99`]  | network, scalers, nominal model, effects: the whole estimator; averages of several; nominal models alone | flight controllers |
//! | [`onnx`] | the network's step, with its scalers                           | ONNX Runtime             |
//! | [`torch`] | the network and its scalers, by the names of torch and ncps   | PyTorch                  |
//!
//! Each takes [`acm_stream::Parts`], which `acm-eval stream RUN --save FILE` writes, and returns files. Recorded inputs and
//! answers of [`acm_stream::Estimator`] are among them, so that the receiver can check the export.
//!
//! An export that cannot write a part refuses it by name ([`ExportError`]).

pub mod c99;
mod description;
mod error;
pub mod onnx;
mod parameters;
pub mod rehearsal;
pub mod torch;

use std::path::PathBuf;

use acm_stream::{AverageParts, Parts, Scaler};

pub use error::ExportError;
pub use parameters::{Parameter, parameters};

/// Name of the exported files, and origin of the estimator.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// Name of the files, and prefix of their definitions: a C identifier of lower-case letters, digits and
    /// underscores.
    pub name: String,
    /// Description of the origin: the run and its network.
    pub source: String,
    /// Number of samples recorded for the check; by default 120 in C99 and 300 elsewhere.
    pub recorded: Option<usize>,
}

/// One file of an export.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct File {
    /// Relative to the folder of the export.
    pub path: PathBuf,
    /// Bytes of the file.
    pub bytes: Vec<u8>,
    /// Words by which an export's file of this kind is known, of this or an earlier version: its beginning has one of them.
    pub marks: &'static [&'static str],
}

impl File {
    /// Returns whether bytes are those of a file that an earlier export left under this name.
    pub fn is_earlier(&self, bytes: &[u8]) -> bool {
        let head = &bytes[..bytes.len().min(HEAD)];
        self.marks.iter().any(|mark| head.windows(mark.len()).any(|part| part == mark.as_bytes()))
    }
}

/// Bytes of a file in which a mark stands.
const HEAD: usize = 512;

impl Origin {
    /// Refuses a name that no program could use.
    ///
    /// # Errors
    /// The name is no identifier.
    pub fn validate(&self) -> Result<(), ExportError> {
        let letters = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        let starts = self.name.starts_with(|c: char| c.is_ascii_lowercase());
        match starts && self.name.chars().all(letters) && self.name.len() <= 40 {
            true => Ok(()),
            false => Err(ExportError::Name { name: self.name.clone() }),
        }
    }
}

/// Returns the SHA-256 of the estimator as a file of [`Parts::to_json`] carries it, in hexadecimal.
///
/// # Errors
/// A number of the estimator is not finite.
pub fn fingerprint(parts: &Parts) -> Result<String, ExportError> {
    Ok(noted(&parts.to_json()?))
}

/// The same of the average of several.
///
/// # Errors
/// A number of an estimator is not finite.
pub fn fingerprint_of_average(average: &AverageParts) -> Result<String, ExportError> {
    Ok(noted(&average.to_json()?))
}

/// Returns the hash that a file notes in its second line.
fn noted(json: &[u8]) -> String {
    let text = String::from_utf8_lossy(json);
    text.lines().nth(1).and_then(|line| line.split('"').nth(3)).unwrap_or_default().to_owned()
}

/// Returns the weights of each network: of one, or of those of an ensemble.
fn weights_of_each(parts: &Parts) -> impl Iterator<Item = &[f32]> {
    std::iter::once(&parts.weights).chain(&parts.members).map(Vec::as_slice)
}

/// Refuses networks that correct actuators: no export computes the slopes of the arm.
fn refuse_unsupported(parts: &Parts, format: &'static str) -> Result<(), ExportError> {
    if parts.actuators.is_empty() {
        return Ok(());
    }
    Err(ExportError::Unsupported {
        what: "a network that corrects the actuators".into(),
        format,
        remedy: "use the estimator in Rust (`acm-eval stream RUN --save FILE`), or train without network.corrects"
            .into(),
    })
}

/// Refuses an estimator without a network for formats that hold nothing else.
fn refuse_without_network(parts: &Parts, format: &'static str) -> Result<(), ExportError> {
    if parts.has_network() {
        return Ok(());
    }
    Err(ExportError::Unsupported {
        what: "a nominal model without a network".into(),
        format,
        remedy: format!(
            "{format} holds the step of a network alone; write the nominal model with its effects as C99: --c99 DIR"
        ),
    })
}

/// Copies the estimator with its factor in the scaler of the residual: factor · (spread z + mean).
fn with_factor_in_scaler(parts: &Parts) -> Parts {
    let scaled = |values: &[f64]| values.iter().map(|value| parts.factor * value).collect();
    let targets = Scaler { mean: scaled(&parts.targets.mean), spread: scaled(&parts.targets.spread) };
    Parts { targets, factor: 1.0, ..parts.clone() }
}

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
