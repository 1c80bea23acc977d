//! The Python package `acm`: what the programs do, for notebooks.
//!
//! ```text
//! DataFrame ─ arrow, manifest ─▶ Recordings ─┬─ close_loop ─▶ Finding ─▶ Model ─┐
//!             folder ─────────▶              └─ train ──────▶ Run ──────────────┴▶ Estimator: step, predict
//! ```
//!
//! A thin layer: recordings are read by acm-datasets, everything else is in acm-eval, acm-train and acm-stream. Long work is done in
//! a thread of its own (`waiting`); errors are exceptions with the programs' text (`errors`).
#![cfg(feature = "extension")]

mod arrow;
mod errors;
mod estimator;
mod finding;
mod frame;
mod manifest;
mod names;
mod own;
mod page;
mod recordings;
mod settings;
mod training;
mod values;
mod view;
mod waiting;

use pyo3::prelude::*;

/// What `acm/__init__.py` names.
#[pymodule]
mod _acm {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::{
        errors::{AcmError, BusyError, ConfigError, DataError, FileError},
        estimator::Estimator,
        finding::{Finding, Model, Separability, close_loop, separability},
        frame::Frame,
        own::effects::effects_text,
        page::Text,
        recordings::{Recordings, check, described, read},
        training::{Report, Run, report, train},
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::errors::plain();
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
