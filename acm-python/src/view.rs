//! Arrays of numpy on memory of Rust, without a copy.

use numpy::{PyArray1, ndarray::ArrayView1};
use pyo3::{PyClass, prelude::*, pyclass::boolean_struct::True, types::PyDict};

/// A view on `values`, which `owner` holds; it cannot be written.
///
/// # Errors
/// None that numpy is known to raise.
#[allow(unsafe_code)]
pub fn of<'py, T: PyClass<Frozen = True>>(
    values: &[f64],
    owner: &Bound<'py, T>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    // SAFETY: a frozen object neither moves nor changes what it holds, and the array keeps it alive.
    let array = unsafe { PyArray1::borrow_from_array(&ArrayView1::from(values), owner.clone().into_any()) };
    let flags = PyDict::new(owner.py());
    flags.set_item("write", false)?;
    array.call_method("setflags", (), Some(&flags))?;
    Ok(array)
}
