//! Plain tables on disk as Parquet: columns of numbers and of text.
//!
//! The same columns give the same bytes: one thread, fixed sizes of groups and pages, no statistics, no time stamp.

use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;

use polars_arrow::{
    array::{Array, PrimitiveArray, Utf8ViewArray},
    datatypes::{ArrowDataType, ArrowSchema, Field},
    record_batch::RecordBatchT,
};
use polars_error::{PolarsError, PolarsResult};
use polars_parquet::write::{
    CompressionOptions, FileWriter, StatisticsOptions, Version, WriteOptions, get_dtype_encoding, row_group_iter,
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

/// Compression of tables.
const TABLES: CompressionOptions = CompressionOptions::Zstd(None);

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

    fn len(&self) -> usize {
        match self {
            Column::Number(values) => values.len(),
            Column::Text(values) => values.len(),
        }
    }

    fn piece(&self, rows: Range<usize>) -> Self {
        match self {
            Column::Number(values) => Column::Number(values[rows].to_vec()),
            Column::Text(values) => Column::Text(values[rows].to_vec()),
        }
    }

    fn array(self) -> Box<dyn Array> {
        match self {
            Column::Number(values) => PrimitiveArray::from_vec(values).boxed(),
            Column::Text(values) => Utf8ViewArray::from_slice_values(values).boxed(),
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
    let refused = |e: PolarsError| DataError::Usage(format!("{}: the table cannot be written: {e}", path.display()));
    let rows = columns.first().map_or(0, |(_, column)| column.len());
    if let Some((name, column)) = columns.iter().find(|(_, column)| column.len() != rows) {
        let text = format!("the column `{name}` has {} rows, and others have {rows}", column.len());
        return Err(refused(PolarsError::ShapeMismatch(text.into())));
    }
    let pieces = (0..rows).step_by(GROUP).map(|from| from..(from + GROUP).min(rows));
    let pieces =
        pieces.map(|rows| columns.iter().map(move |(name, column)| (name.clone(), column.piece(rows.clone()))));
    let batches = pieces.map(|columns| batch(columns.collect())).collect::<PolarsResult<Vec<_>>>();
    let encoded = batches.and_then(|batches| encode(&schema(columns)?, batches, packed(TABLES)));
    atomic::write_bytes(path, &encoded.map_err(refused)?)
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
    let first = first.map_err(io::Error::other)?;
    let mut writer =
        Writer::new(file, &schema(&first).map_err(io::Error::other)?, packed(TABLES)).map_err(io::Error::other)?;
    writer.write(batch(first).map_err(io::Error::other)?).map_err(io::Error::other)?;
    for group in groups {
        let group = batch(group.map_err(io::Error::other)?).map_err(io::Error::other)?;
        writer.write(group).map_err(io::Error::other)?;
    }
    writer.end().map(drop).map_err(io::Error::other)
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

/// Returns options of a writer without statistics, so that equal columns are equal bytes.
fn packed(compression: CompressionOptions) -> WriteOptions {
    WriteOptions { statistics: StatisticsOptions::empty(), version: Version::V1, compression, data_page_size: None }
}

/// Types of columns by name.
fn schema(columns: &[(String, Column)]) -> PolarsResult<ArrowSchema> {
    let mut schema = ArrowSchema::default();
    for (name, column) in columns {
        let kind = match column {
            Column::Number(_) => ArrowDataType::Float64,
            Column::Text(_) => ArrowDataType::Utf8View,
        };
        if schema.insert(name.as_str().into(), Field::new(name.as_str().into(), kind, true)).is_some() {
            return Err(PolarsError::Duplicate(format!("the column `{name}` is there twice").into()));
        }
    }
    Ok(schema)
}

fn batch(columns: Vec<(String, Column)>) -> PolarsResult<Batch> {
    let schema = schema(&columns)?;
    let arrays: Vec<Box<dyn Array>> = columns.into_iter().map(|(_, column)| column.array()).collect();
    RecordBatchT::try_new(arrays.first().map_or(0, |array| array.len()), schema.into(), arrays)
}

/// Writes a file group of rows by group of rows.
struct Writer<W: Write> {
    file: FileWriter<W>,
    options: WriteOptions,
}

impl<W: Write> Writer<W> {
    fn new(file: W, schema: &ArrowSchema, options: WriteOptions) -> PolarsResult<Self> {
        Ok(Self { file: FileWriter::try_new(file, schema.clone(), options)?, options })
    }

    /// Writes one group; none of no rows.
    fn write(&mut self, batch: Batch) -> PolarsResult<()> {
        let rows = batch.height() as u64;
        if rows == 0 {
            return Ok(());
        }
        if batch.schema().iter_values().ne(self.file.schema().iter_values()) {
            return Err(PolarsError::SchemaMismatch("a group of rows has other columns than the first".into()));
        }
        let encodings = batch.schema().iter_values().map(|field| get_dtype_encoding(&field.dtype)).collect();
        let fields = self.file.parquet_schema().fields().to_vec();
        self.file.write(rows, row_group_iter(batch, encodings, fields, self.options))
    }

    fn end(mut self) -> PolarsResult<W> {
        self.file.end(None)?;
        Ok(self.file.into_inner())
    }
}

/// Columns of a piece of a table in memory, of any type that Arrow has.
pub type Batch = RecordBatchT<Box<dyn Array>>;

/// Writes a table of Arrow columns in one step, each batch as a group of rows, with their types as they are.
///
/// # Errors
/// The file system; a type that Parquet has no form for; batches with other columns than `schema`.
pub fn write_arrow(path: &Path, schema: &ArrowSchema, batches: Vec<Batch>) -> Result<(), DataError> {
    let refused = |e: String| DataError::Usage(format!("{}: the table cannot be written: {e}", path.display()));
    let options = packed(CompressionOptions::Uncompressed);
    let bytes = guarded(|| encode(schema, batches, options)).map_err(refused)?;
    atomic::write_bytes(path, &bytes)
}

/// Batches as the bytes of a Parquet file.
fn encode(schema: &ArrowSchema, batches: Vec<Batch>, options: WriteOptions) -> PolarsResult<Vec<u8>> {
    let mut writer = Writer::new(Vec::new(), schema, options)?;
    batches.into_iter().try_for_each(|batch| writer.write(batch))?;
    writer.end()
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
    let columns = guarded(|| crate::ingest::recording::columns(&content)).map_err(damaged)?;
    let read = |(name, arrays): (String, Vec<Box<dyn Array>>)| {
        let column = decode(&arrays).ok_or_else(|| damaged(format!("column `{name}` is neither numbers nor text")))?;
        Ok((name, column))
    };
    columns.into_iter().map(read).collect()
}

/// Numbers or text without empty cells.
fn decode(arrays: &[Box<dyn Array>]) -> Option<Column> {
    let arrays = || arrays.iter().map(AsRef::as_ref);
    if arrays().next().is_some_and(|array| *array.dtype() == ArrowDataType::Utf8View) {
        return Some(Column::Text(arrays().map(texts).collect::<Option<Vec<_>>>()?.concat()));
    }
    Some(Column::Number(arrays().map(numbers).collect::<Option<Vec<_>>>()?.concat()))
}

fn texts(array: &dyn Array) -> Option<Vec<String>> {
    let cells: &Utf8ViewArray = array.as_any().downcast_ref()?;
    cells.iter().map(|cell| cell.map(str::to_string)).collect()
}

fn numbers(array: &dyn Array) -> Option<Vec<f64>> {
    let cells: &PrimitiveArray<f64> = array.as_any().downcast_ref()?;
    cells.iter().map(Option::<&f64>::copied).collect()
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
