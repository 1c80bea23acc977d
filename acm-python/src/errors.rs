//! Errors of the programs as exceptions, with the same text.
//!
//! | exit code | exception     |
//! | --------- | ------------- |
//! | 2         | `ConfigError` |
//! | 3         | `DataError`   |
//! | 4         | `FileError`   |
//! | 5         | `BusyError`   |
//! | 130       | `KeyboardInterrupt` |

use acm_datasets::DataError as Refused;
use acm_datasets::toml_file::words::{LONGEST, cut};
use acm_eval::error::EvalError;
use acm_train::{TrainError, explain};
use miette::MietteHandlerOpts;
use pyo3::{
    PyErr, create_exception,
    exceptions::{PyException, PyKeyboardInterrupt},
};

create_exception!(acm, AcmError, PyException, "What acm refuses, and why.");
create_exception!(
    acm,
    ConfigError,
    AcmError,
    "What was asked cannot be done: a value, a key or a combination of them."
);
create_exception!(
    acm,
    DataError,
    AcmError,
    "Recordings or records that cannot be used; the text names file, row and column."
);
create_exception!(acm, FileError, AcmError, "A file or folder that cannot be read or written.");
create_exception!(acm, BusyError, AcmError, "Another process works in the folder.");

/// Faults of a configuration are drawn without the colours of a terminal.
pub fn plain() {
    let handler = || MietteHandlerOpts::new().wrap_lines(false).without_cause_chain().color(false).build();
    // A hook that was set before stays.
    let _ = miette::set_hook(Box::new(move |_| Box::new(handler())));
}

/// The exception of an error of acm-eval.
pub fn of_eval(error: EvalError) -> PyErr {
    let code = error.exit_code();
    match error {
        EvalError::Train(error) => of_train(error),
        error => of_code(code, error.to_string()),
    }
}

/// The exception of an error of acm-train.
pub fn of_train(error: TrainError) -> PyErr {
    of_code(error.exit_code(), explain(error))
}

/// The exception of an error of the recordings.
pub fn of_data(error: Refused) -> PyErr {
    of_code(error.exit_code(), cut(&error.to_string(), LONGEST))
}

/// What was asked cannot be done.
pub fn usage(text: impl Into<String>) -> PyErr {
    of_code(2, text.into())
}

fn of_code(code: u8, text: String) -> PyErr {
    let text = text.trim().to_string();
    match code {
        2 => ConfigError::new_err(text),
        3 => DataError::new_err(text),
        4 => FileError::new_err(text),
        5 => BusyError::new_err(text),
        130 => PyKeyboardInterrupt::new_err(text),
        _ => AcmError::new_err(text),
    }
}
