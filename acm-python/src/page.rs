//! Pages in a notebook: whole documents in frames of their own, so that their style and the notebook's do not meet.

use pyo3::{prelude::*, types::PyString};

use crate::frame::escaped;

/// A document as an element of a notebook, `height` px high until the reader drags its corner.
pub fn framed(document: &str, height: usize) -> String {
    format!(
        "<iframe srcdoc=\"{}\" style=\"width:100%;height:{height}px;border:0;resize:vertical;overflow:auto\" \
         loading=\"lazy\"></iframe>",
        escaped(document)
    )
}

/// A text that a program prints; ``str(text)``.
#[pyclass(frozen, module = "acm")]
pub struct Text(pub String);

#[pymethods]
impl Text {
    fn __str__(&self) -> &str {
        &self.0
    }

    fn __repr__(&self) -> &str {
        &self.0
    }

    fn _repr_html_(&self) -> String {
        format!("<pre>{}</pre>", escaped(&self.0))
    }

    fn __contains__(&self, part: &Bound<'_, PyString>) -> PyResult<bool> {
        Ok(self.0.contains(part.to_str()?))
    }
}
