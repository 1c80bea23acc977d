//! A nominal model of one's own, as a callable.

use std::{borrow::Cow, path::Path};

use acm_datasets::{Campaign, DataError, predict, predict::Given};
use nalgebra::DMatrix;
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::{prelude::*, types::PyDict};

use crate::errors::{of_data, usage};

/// Writes recordings with the predictions of a callable into a folder ([`predict::write`]).
///
/// # Errors
/// What the callable raises, or an answer that is no prediction.
pub fn write(campaign: &Campaign, model: &Bound<'_, PyAny>, folder: &Path) -> PyResult<()> {
    if !model.is_callable() {
        return Err(usage(format!("{model} is no callable; give a function of a dictionary of arrays")));
    }
    let name = model.getattr("__name__").map_or_else(|_| "a callable".into(), |name| format!("`{name}`"));
    let outputs: Vec<String> = campaign.manifest.measured.iter().map(|output| output.name().to_string()).collect();
    let mut raised = None;
    let trials = campaign.trials.iter().map(|trial| Ok(Cow::Borrowed(trial)));
    let written = predict::write(&campaign.manifest, trials, folder, &format!("{name} in Python"), |given| {
        answer(model, given, &outputs).map_err(|error| {
            raised = Some(error);
            DataError::Usage(String::new())
        })
    });
    match raised {
        Some(error) => Err(error),
        None => written.map(drop).map_err(of_data),
    }
}

fn answer(model: &Bound<'_, PyAny>, given: &Given, outputs: &[String]) -> PyResult<DMatrix<f64>> {
    let py = model.py();
    let columns = PyDict::new(py);
    for (name, values) in &given.columns {
        columns.set_item(name, PyArray1::from_slice(py, values))?;
    }
    let answer = model.call1((columns,))?;
    let answer = match answer.cast::<PyDict>() {
        Ok(by_name) => {
            let of = |name: &String| {
                let what = || usage(format!("trial `{}`: the model gives no `{name}`", given.trial));
                by_name.get_item(name)?.ok_or_else(what)
            };
            let columns = outputs.iter().map(of).collect::<PyResult<Vec<_>>>()?;
            py.import("numpy")?.call_method1("column_stack", (columns,))?
        }
        Err(_) => answer,
    };
    let array = py.import("numpy")?.call_method1("asarray", (answer, "float64"))?.cast_into::<PyArrayDyn<f64>>()?;
    let (shape, values) = (array.shape().to_vec(), array.try_readonly()?);
    let values = values.as_array();
    match shape[..] {
        [samples] => Ok(DMatrix::from_iterator(samples, 1, values.iter().copied())),
        [samples, outputs] => Ok(DMatrix::from_row_iterator(samples, outputs, values.iter().copied())),
        _ => {
            let text = format!("trial `{}`: the model gives an array of shape {shape:?}; give [T, O]", given.trial);
            Err(usage(text))
        }
    }
}
