//! Decoding of the pages of one column of one row group to cells.

use std::io::{Cursor, Read, Seek, SeekFrom};

use half::f16;
use polars_arrow::array::{Array, BooleanArray, FixedSizeBinaryArray, ListArray, PrimitiveArray, Utf8ViewArray};
use polars_arrow::datatypes::Field;
use polars_arrow::types::NativeType;
use polars_buffer::Buffer;
use polars_error::{PolarsError, PolarsResult};
use polars_parquet::read::{BasicDecompressor, ColumnChunkMetadata, PageReader, column_iter_to_arrays};
use polars_utils::pl_str::PlSmallStr;

use super::kind::Kind;
use crate::ingest::recording::cells::{Cells, Texts};

type Arrays = Vec<Box<dyn Array>>;

/// The cells of a column, or of one element of its lists.
pub(super) fn cells(
    file: &mut (impl Read + Seek),
    column: &ColumnChunkMetadata,
    field: &Field,
    (kind, element): (&Kind, Option<usize>),
) -> PolarsResult<Cells> {
    let arrays = arrays(file, column, field)?;
    if let Some(element) = element {
        return elements(&arrays, kind, element).map(Cells::Numbers);
    }
    Ok(match kind {
        Kind::Text => Cells::Text(texts(&arrays)?),
        Kind::Numbers => Cells::Numbers(all(&arrays, numbers)?),
        Kind::Whole => Cells::Whole(all(&arrays, wide)?),
        Kind::Halves => Cells::Numbers(all(&arrays, halves)?),
        Kind::Decimals(scale) => Cells::Numbers(all(&arrays, |array| decimals(array, *scale))?),
        Kind::Time(of) => Cells::Ticks(of.clone(), all(&arrays, whole)?),
        Kind::Lists => return Err(PolarsError::ComputeError("lists of several numbers".into())),
        Kind::Unread(name) => return Err(PolarsError::ComputeError(name.clone().into())),
    })
}

fn texts(arrays: &Arrays) -> PolarsResult<Texts> {
    let mut texts = Texts::default();
    for array in arrays {
        let other = || PolarsError::ComputeError(format!("values of type {:?}", array.dtype()).into());
        let cells: &Utf8ViewArray = array.as_any().downcast_ref().ok_or_else(other)?;
        cells.iter().for_each(|cell| texts.push(cell.unwrap_or_default()));
    }
    Ok(texts)
}

/// One element of each list; none of a list that is shorter.
fn elements(arrays: &Arrays, kind: &Kind, element: usize) -> PolarsResult<Vec<Option<f64>>> {
    let mut found = Vec::new();
    for array in arrays {
        let other = || PolarsError::ComputeError(format!("values of type {:?}", array.dtype()).into());
        let lists: &ListArray<i64> = array.as_any().downcast_ref().ok_or_else(other)?;
        let values = match kind {
            Kind::Whole => {
                wide(lists.values().as_ref()).map(|all| all.into_iter().map(|v| v.map(|v| v as f64)).collect())
            }
            Kind::Halves => halves(lists.values().as_ref()),
            Kind::Decimals(scale) => decimals(lists.values().as_ref(), *scale),
            _ => numbers(lists.values().as_ref()),
        };
        let values: Vec<Option<f64>> = values.ok_or_else(other)?;
        let of = |range: &[i64]| (range[0] as usize..range[1] as usize).nth(element).and_then(|at| values[at]);
        found.extend(lists.offsets().as_slice().windows(2).map(of));
    }
    Ok(found)
}

/// The arrays of a column.
pub(super) fn arrays(
    file: &mut (impl Read + Seek),
    column: &ColumnChunkMetadata,
    field: &Field,
) -> PolarsResult<Arrays> {
    let range = column.byte_range();
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(range.start))?;
    file.take(range.end.saturating_sub(range.start)).read_to_end(&mut bytes)?;
    let pages = PageReader::new(Cursor::new(Buffer::from(bytes)), column, vec![], usize::MAX);
    let of = &column.descriptor().descriptor.primitive_type;
    // the levels of lists depend on what may be empty; a plain column is read as one that may be
    let field = match field.dtype.is_nested() {
        true => field.clone(),
        false => Field::new(PlSmallStr::EMPTY, field.dtype.clone(), true),
    };
    Ok(column_iter_to_arrays(vec![BasicDecompressor::new(pages, vec![])], vec![of], field, None)?.0)
}

/// The values of all arrays; an array of another type is a damaged file.
fn all<T>(arrays: &Arrays, values: impl Fn(&dyn Array) -> Option<Vec<Option<T>>>) -> PolarsResult<Vec<Option<T>>> {
    let mut found = Vec::with_capacity(arrays.iter().map(|array| array.len()).sum());
    for array in arrays {
        let other = || PolarsError::ComputeError(format!("values of type {:?}", array.dtype()).into());
        found.extend(values(array.as_ref()).ok_or_else(other)?);
    }
    Ok(found)
}

fn numbers(array: &dyn Array) -> Option<Vec<Option<f64>>> {
    let same = |values: &PrimitiveArray<f64>| values.iter().map(Option::<&f64>::copied).collect();
    array
        .as_any()
        .downcast_ref()
        .map(same)
        .or_else(|| of::<f32>(array))
        .or_else(|| of::<i8>(array))
        .or_else(|| of::<i16>(array))
        .or_else(|| of::<i32>(array))
        .or_else(|| of::<u8>(array))
        .or_else(|| of::<u16>(array))
        .or_else(|| of::<u32>(array))
        .or_else(|| truth(array))
}

/// Numbers that a 64-bit float holds.
fn of<T: NativeType + Into<f64>>(array: &dyn Array) -> Option<Vec<Option<f64>>> {
    let values: &PrimitiveArray<T> = array.as_any().downcast_ref()?;
    Some(values.iter().map(|value| value.map(|v| (*v).into())).collect())
}

fn wide(array: &dyn Array) -> Option<Vec<Option<i128>>> {
    let unsigned = |values: &PrimitiveArray<u64>| values.iter().map(|value| value.map(|v| i128::from(*v))).collect();
    let signed = || whole(array).map(|values| values.into_iter().map(|value| value.map(i128::from)).collect());
    array.as_any().downcast_ref().map(unsigned).or_else(signed)
}

fn truth(array: &dyn Array) -> Option<Vec<Option<f64>>> {
    let values: &BooleanArray = array.as_any().downcast_ref()?;
    Some(values.iter().map(|value| value.map(|v| f64::from(u8::from(v)))).collect())
}

fn halves(array: &dyn Array) -> Option<Vec<Option<f64>>> {
    let values: &FixedSizeBinaryArray = array.as_any().downcast_ref()?;
    let half = |bytes: &[u8]| <[u8; 2]>::try_from(bytes).map_or(f64::NAN, |bytes| f16::from_le_bytes(bytes).to_f64());
    Some(values.iter().map(|value| value.map(half)).collect())
}

/// The float nearest to the written digits, as a CSV would give it.
fn decimals(array: &dyn Array, scale: usize) -> Option<Vec<Option<f64>>> {
    let values: &PrimitiveArray<i128> = array.as_any().downcast_ref()?;
    let number = |digits: &i128| format!("{digits}e-{scale}").parse().unwrap_or(f64::NAN);
    Some(values.iter().map(|value| value.map(number)).collect())
}

/// Ticks of time: 64 bits, or 32 for dates and milliseconds of a day.
fn whole(array: &dyn Array) -> Option<Vec<Option<i64>>> {
    let long = |values: &PrimitiveArray<i64>| values.iter().map(Option::<&i64>::copied).collect();
    let short = |values: &PrimitiveArray<i32>| values.iter().map(|value| value.map(|v| i64::from(*v))).collect();
    array.as_any().downcast_ref().map(long).or_else(|| array.as_any().downcast_ref().map(short))
}
