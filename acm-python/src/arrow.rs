//! Frames across the Arrow C stream interface: what pandas, polars and pyarrow hand over and take, without pyarrow here.
//!
//! <https://arrow.apache.org/docs/format/CDataInterface/PyCapsuleInterface.html>

use std::{ffi::CStr, sync::Arc};

use acm_datasets::files::table::Batch;
use polars_arrow::{
    array::{Array, Float64Array, StructArray, Utf8Array},
    datatypes::{ArrowDataType, ArrowSchema, Field},
    ffi::{ArrowArrayStream, ArrowArrayStreamReader, export_iterator},
};
use pyo3::{prelude::*, types::PyCapsule};

use crate::{
    errors::{DataError, usage},
    values::Values,
};

const NAME: &CStr = c"arrow_array_stream";
const METHOD: &str = "__arrow_c_stream__";

/// A frame that was handed over: the columns' types, and their rows in pieces.
pub struct Taken {
    /// Names and types.
    pub schema: ArrowSchema,
    /// Rows.
    pub batches: Vec<Batch>,
}

/// Whether something is a frame.
pub fn is_frame(object: &Bound<'_, PyAny>) -> bool {
    object.hasattr(METHOD).unwrap_or(false)
}

impl Taken {
    /// The columns that are wanted.
    ///
    /// # Errors
    /// Pieces that do not fit the columns.
    pub fn only(self, wanted: impl Fn(&str) -> bool) -> PyResult<Self> {
        let kept: Vec<usize> =
            self.schema.iter_values().enumerate().filter(|(_, field)| wanted(&field.name)).map(|(at, _)| at).collect();
        let fields: Vec<Field> = self.schema.iter_values().cloned().collect();
        let schema: ArrowSchema = kept.iter().map(|&at| (fields[at].name.clone(), fields[at].clone())).collect();
        let shared = Arc::new(schema.clone());
        let batch = |batch: Batch| {
            let arrays = kept.iter().map(|&at| batch.arrays()[at].clone()).collect();
            Batch::try_new(batch.height(), shared.clone(), arrays).map_err(|error| broken(error.to_string()))
        };
        Ok(Self { schema, batches: self.batches.into_iter().map(batch).collect::<PyResult<_>>()? })
    }
}

fn broken(error: String) -> PyErr {
    DataError::new_err(format!("the frame cannot be taken: {error}"))
}

/// Takes a frame; its memory is shared, and not copied.
///
/// # Errors
/// What is no frame, or one whose columns Arrow cannot hand over.
pub fn take(object: &Bound<'_, PyAny>) -> PyResult<Taken> {
    if !is_frame(object) {
        let what = object.get_type().name()?.to_string();
        return Err(usage(format!("{what} is no frame; give a DataFrame of pandas or polars, or a table of pyarrow")));
    }
    let capsule = object.call_method0(METHOD)?;
    let capsule = capsule.cast::<PyCapsule>()?;
    let mut reader = reader(capsule)?.map_err(broken)?;
    let ArrowDataType::Struct(fields) = reader.field().dtype().clone() else {
        return Err(usage("the stream has no columns; give a frame"));
    };
    let schema: ArrowSchema = fields.iter().map(|field| (field.name.clone(), field.clone())).collect();
    let shared = Arc::new(schema.clone());
    let mut batches = vec![];
    while let Some(piece) = next(&mut reader) {
        let piece = piece.map_err(broken)?;
        let piece = piece.as_any().downcast_ref::<StructArray>().ok_or_else(|| usage("the stream has no columns"))?;
        batches.push(
            Batch::try_new(piece.len(), shared.clone(), piece.values().to_vec()).map_err(|e| broken(e.to_string()))?,
        );
    }
    Ok(Taken { schema, batches })
}

type Reader = ArrowArrayStreamReader<Box<ArrowArrayStream>>;

/// Moves the stream out of its capsule, as the interface asks a consumer to.
#[allow(unsafe_code)]
fn reader(capsule: &Bound<'_, PyCapsule>) -> PyResult<Result<Reader, String>> {
    let pointer = capsule.pointer_checked(Some(NAME))?.cast::<ArrowArrayStream>();
    // SAFETY: a capsule of this name holds a stream; an empty one is left there, which its destructor knows not to release.
    let stream = unsafe { std::ptr::replace(pointer.as_ptr(), ArrowArrayStream::empty()) };
    // SAFETY: its producer promises a stream by the interface.
    Ok(unsafe { Reader::try_new(Box::new(stream)) }.map_err(|error| error.to_string()))
}

#[allow(unsafe_code)]
fn next(reader: &mut Reader) -> Option<Result<Box<dyn Array>, String>> {
    // SAFETY: as above.
    unsafe { reader.next() }.map(|piece| piece.map_err(|error| error.to_string()))
}

/// Hands columns over, in one piece.
///
/// # Errors
/// Python has no memory.
pub fn give<'py>(py: Python<'py>, columns: &[(String, Values)]) -> PyResult<Bound<'py, PyCapsule>> {
    let (fields, arrays): (Vec<Field>, Vec<Box<dyn Array>>) = columns.iter().map(column).unzip();
    let rows = arrays.first().map_or(0, |array| array.len());
    let whole = StructArray::new(ArrowDataType::Struct(fields), rows, arrays, None).boxed();
    let field = Field::new("".into(), whole.dtype().clone(), false);
    let stream = export_iterator(Box::new(std::iter::once(Ok(whole))), field);
    PyCapsule::new_with_value(py, stream, NAME)
}

fn column((name, values): &(String, Values)) -> (Field, Box<dyn Array>) {
    let array: Box<dyn Array> = match values {
        Values::Numbers(values) => Float64Array::from(values.as_slice()).boxed(),
        Values::Words(values) => Utf8Array::<i64>::from(values.as_slice()).boxed(),
    };
    (Field::new(name.as_str().into(), array.dtype().clone(), true), array)
}
