//! Plain tables on disk as Parquet: columns of numbers and of text.
//!
//! The same columns give the same bytes: one thread, fixed sizes of groups and pages, no statistics, no time stamp.

use std::io::{self, Write};
use std::path::Path;

use polars_arrow::{array::Array, datatypes::ArrowSchema, record_batch::RecordBatchT};
use polars_core::prelude::*;
use polars_io::prelude::*;
use polars_parquet::write::{
    CompressionOptions, FileWriter, Version, WriteOptions, get_dtype_encoding, row_group_iter,
};

use crate::error::DataError;
use crate::files::atomic;
use crate::ingest::recording::{Content, guarded};

/// One column.
#[derive(Debug, Clone, PartialEq)]
pub enum Column {
    /// 64-bit floats; NaN is kept as it is.
    Number(Vec<f64>),
    /// Text.
    Text(Vec<String>),
}

/// Rows per group of the file.
const GROUP: usize = 1 << 18;

impl Column {
    /// The numbers, where it has them.
    pub fn numbers(&self) -> Option<&[f64]> {
        match self {
            Column::Number(values) => Some(values),
            Column::Text(_) => None,
        }
    }

    /// The text, where it is text.
    pub fn text(&self) -> Option<&[String]> {
        match self {
            Column::Text(values) => Some(values),
            Column::Number(_) => None,
        }
    }
}

/// Writes the columns in one step.
///
/// # Errors
/// The file system; columns of different lengths or with the same name.
pub fn write_parquet(path: &Path, columns: &[(String, Column)]) -> Result<(), DataError> {
    let refused = |e: String| DataError::Usage(format!("{}: the table cannot be written: {e}", path.display()));
    let bytes = encode(columns).map_err(|e| refused(e.to_string()))?;
    atomic::write_bytes(path, &bytes)
}

/// Writes, in one step, a table whose rows come group by group; no more than one group is held, and each is a group of
/// rows of the file.
///
/// # Errors
/// The first error among the groups; the file system; groups with other columns than the first.
pub fn write_parquet_groups(
    path: &Path,
    groups: impl IntoIterator<Item = Result<Vec<(String, Column)>, DataError>>,
) -> Result<(), DataError> {
    let written = atomic::replace(path, |file| append(&mut io::BufWriter::new(file), groups));
    written.map_err(|error| error.downcast().unwrap_or_else(|e| DataError::file_system("write", path, &e)))
}

/// Group after group; an error of the groups comes back within the error.
fn append(
    file: &mut impl Write,
    groups: impl IntoIterator<Item = Result<Vec<(String, Column)>, DataError>>,
) -> io::Result<()> {
    let mut file = Watched { file, refusal: None };
    let written = batches(&mut file, groups).and_then(|()| file.flush());
    written.map_err(|error| file.refusal.take().unwrap_or(error))
}

fn batches(
    file: &mut impl Write,
    groups: impl IntoIterator<Item = Result<Vec<(String, Column)>, DataError>>,
) -> io::Result<()> {
    let mut groups = groups.into_iter();
    let Some(first) = groups.next() else { return Err(io::Error::other("the table has no rows")) };
    let first = frame(&first.map_err(io::Error::other)?).map_err(io::Error::other)?;
    let mut writer = writer(file).batched(first.schema()).map_err(io::Error::other)?;
    writer.write_batch(&first).map_err(io::Error::other)?;
    for group in groups {
        let group = frame(&group.map_err(io::Error::other)?).map_err(io::Error::other)?;
        writer.write_batch(&group).map_err(io::Error::other)?;
    }
    writer.finish().map(drop).map_err(io::Error::other)
}

/// Keeps what the file system says, of which the encoder makes a text: a full disk is to stay one.
struct Watched<W> {
    file: W,
    refusal: Option<io::Error>,
}

impl<W> Watched<W> {
    fn note<T>(&mut self, done: io::Result<T>) -> io::Result<T> {
        if let Some(error) = done.as_ref().err().filter(|error| error.kind() != io::ErrorKind::Interrupted) {
            let again = || io::Error::new(error.kind(), error.to_string());
            self.refusal = Some(error.raw_os_error().map_or_else(again, io::Error::from_raw_os_error));
        }
        done
    }
}

impl<W: Write> Write for Watched<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let done = self.file.write(bytes);
        self.note(done)
    }

    fn flush(&mut self) -> io::Result<()> {
        let done = self.file.flush();
        self.note(done)
    }
}

/// The columns as the bytes of a Parquet file.
fn encode(columns: &[(String, Column)]) -> PolarsResult<Vec<u8>> {
    let mut bytes = Vec::new();
    writer(&mut bytes).with_row_group_size(Some(GROUP)).finish(&mut frame(columns)?)?;
    Ok(bytes)
}

/// What makes equal columns equal bytes.
fn writer<W: Write>(file: W) -> ParquetWriter<W> {
    ParquetWriter::new(file).with_statistics(StatisticsOptions::empty()).set_parallel(false)
}

fn frame(columns: &[(String, Column)]) -> PolarsResult<DataFrame> {
    let column = |(name, column): &(String, Column)| match column {
        Column::Number(values) => polars_core::prelude::Column::new(name.as_str().into(), values.as_slice()),
        Column::Text(values) => polars_core::prelude::Column::new(name.as_str().into(), values.as_slice()),
    };
    DataFrame::new_infer_height(columns.iter().map(column).collect())
}

/// Columns of a piece of a table in memory, of any type that Arrow has.
pub type Batch = RecordBatchT<Box<dyn Array>>;

/// Writes a table of Arrow columns in one step, each batch as a group of rows, with their types as they are.
///
/// # Errors
/// The file system; a type that Parquet has no form for; batches with other columns than `schema`.
pub fn write_arrow(path: &Path, schema: &ArrowSchema, batches: Vec<Batch>) -> Result<(), DataError> {
    let refused = |e: String| DataError::Usage(format!("{}: the table cannot be written: {e}", path.display()));
    let bytes = guarded(|| encode_arrow(schema, batches)).map_err(refused)?;
    atomic::write_bytes(path, &bytes)
}

fn encode_arrow(schema: &ArrowSchema, batches: Vec<Batch>) -> PolarsResult<Vec<u8>> {
    let options = WriteOptions {
        statistics: polars_parquet::write::StatisticsOptions::empty(),
        version: Version::V1,
        compression: CompressionOptions::Uncompressed,
        data_page_size: None,
    };
    let mut writer = FileWriter::try_new(Vec::new(), schema.clone(), options)?;
    let fields = writer.parquet_schema().fields().to_vec();
    for batch in batches {
        let rows = batch.height() as u64;
        let encodings = schema.iter_values().map(|field| get_dtype_encoding(&field.dtype)).collect();
        writer.write(rows, row_group_iter(batch, encodings, fields.clone(), options))?;
    }
    writer.end(None)?;
    Ok(writer.into_inner())
}

/// Reads a table that [`write_parquet`] wrote.
///
/// # Errors
/// The file system; a file that is damaged; a column that is neither numbers nor text, or has empty cells.
pub fn read_parquet(path: &Path) -> Result<Vec<(String, Column)>, DataError> {
    let content = Content::held(path)?;
    let damaged = |reason: String| DataError::Damaged { path: path.to_path_buf(), reason };
    crate::ingest::recording::check_ends(path, &content)?;
    crate::ingest::recording::check_claims(path, &content)?;
    let frame = guarded(|| {
        let reader = ParquetReader::new(content.reader()).read_parallel(ParallelStrategy::None);
        reader.set_rechunk(true).finish()
    });
    let frame = frame.map_err(damaged)?;
    let mut columns = Vec::new();
    for column in frame.columns() {
        let name = column.name().to_string();
        let read = decode(column.as_materialized_series());
        columns
            .push((name.clone(), read.ok_or_else(|| damaged(format!("column `{name}` is neither numbers nor text")))?));
    }
    Ok(columns)
}

fn decode(series: &polars_core::prelude::Series) -> Option<Column> {
    if let Ok(text) = series.str() {
        return text.iter().map(|cell| cell.map(str::to_string)).collect::<Option<_>>().map(Column::Text);
    }
    let numbers = series.f64().ok()?;
    numbers.iter().collect::<Option<_>>().map(Column::Number)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Vec<(String, Column)> {
        let number = |t: usize| [0.1 + t as f64 / 7.0, -0.0, f64::MIN_POSITIVE, 1e300][t % 4];
        vec![
            ("trial".into(), Column::Text((0..1000).map(|t| format!("run{}", t / 300)).collect())),
            ("x".into(), Column::Number((0..1000).map(number).collect())),
        ]
    }

    #[test]
    fn a_table_keeps_every_bit_and_the_file_every_byte() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let (a, b) = (folder.path().join("a.parquet"), folder.path().join("b.parquet"));
        write_parquet(&a, &table())?;
        write_parquet(&b, &table())?;
        assert_eq!(std::fs::read(&a)?, std::fs::read(&b)?);
        let read = read_parquet(&a)?;
        assert_eq!(read[0], table()[0]);
        let bits = |c: &Column| c.numbers().map(|n| n.iter().map(|v| v.to_bits()).collect::<Vec<_>>());
        assert_eq!(bits(&read[1].1), bits(&table()[1].1));
        Ok(())
    }

    #[test]
    fn a_truncated_table_is_a_message() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("a.parquet");
        write_parquet(&path, &table())?;
        let whole = std::fs::read(&path)?;
        for length in [0, 3, 11, 12, whole.len() / 2, whole.len() - 1] {
            std::fs::write(&path, &whole[..length])?;
            let error = read_parquet(&path).err().ok_or("it was read")?;
            assert_eq!(error.exit_code(), 3);
            assert!(error.to_string().contains("copy it again"), "{error}");
        }
        Ok(())
    }
}
