//! Parquet, decoded by polars.
//!
//! A decoder that meets damaged bytes may panic instead of returning an error: here, and nowhere else, a panic is
//! caught and becomes a message.

mod claims;
mod thrift;

use std::cell::Cell;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Once;

use polars_core::prelude::*;
use polars_io::prelude::*;

use super::Wanted;
use super::content::Content;
use crate::error::DataError;

const MAGIC: &[u8] = b"PAR1";

thread_local! {
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// Rows that are decoded at a time, where groups of rows are no larger.
const PIECE: usize = 1 << 16;

/// An opened file, whose rows are decoded piece by piece.
pub(super) struct ParquetFile {
    path: PathBuf,
    content: Content,
    metadata: FileMetadataRef,
    /// Rows of each piece: whole groups of rows, as many as come to [`PIECE`].
    pub pieces: Vec<Range<usize>>,
}

impl ParquetFile {
    /// Looks at the ends of the file, its header and its groups of rows.
    pub fn open(path: &Path, content: Content, wanted: &Wanted) -> Result<Self, DataError> {
        check_ends(path, &content)?;
        claims::check(path, &mut content.reader(), content.size(), &|column| wanted.columns().contains(&column))?;
        let damaged = |reason: String| DataError::Damaged { path: path.to_path_buf(), reason };
        let opened = guarded(|| {
            let mut reader = ParquetReader::new(content.reader());
            let header = reader.schema()?.iter_names().map(ToString::to_string).collect::<Vec<_>>();
            Ok((header, reader.get_metadata()?.clone()))
        });
        let (header, metadata) = opened.map_err(damaged)?;
        wanted.check_header(path, &header)?;
        // the crate that names the type of a group is no dependency
        #[allow(clippy::redundant_closure_for_method_calls)]
        let pieces = pieces(metadata.row_groups.iter().map(|group| group.num_rows()));
        Ok(Self { path: path.to_path_buf(), content, metadata, pieces })
    }

    /// The columns of some of its rows.
    pub fn read(&self, rows: Range<usize>, columns: &[&str]) -> Result<DataFrame, DataError> {
        let columns = columns.iter().map(ToString::to_string).collect();
        let decoded = guarded(|| {
            let mut reader = ParquetReader::new(self.content.reader()).with_columns(Some(columns));
            reader.set_metadata(self.metadata.clone());
            let reader = reader.with_slice(Some((rows.start, rows.len()))).read_parallel(ParallelStrategy::None);
            reader.set_rechunk(true).finish()
        });
        let damaged = |reason| DataError::Damaged { path: self.path.clone(), reason };
        let frame = decoded.map_err(damaged)?;
        match frame.height() == rows.len() {
            true => Ok(frame),
            false => Err(damaged(format!("rows {} to {} decode to {}", rows.start + 1, rows.end, frame.height()))),
        }
    }
}

/// Runs of whole groups; one piece of no rows where the file has none.
fn pieces(groups: impl Iterator<Item = usize>) -> Vec<Range<usize>> {
    let (mut pieces, mut piece) = (Vec::new(), 0..0);
    for rows in groups {
        if !piece.is_empty() && piece.len() + rows > PIECE {
            pieces.push(piece.clone());
            piece = piece.end..piece.end;
        }
        piece.end += rows;
    }
    pieces.push(piece);
    pieces
}

/// A Parquet file begins and ends with its mark, and the length of its footer stands before the last one.
pub(crate) fn check_ends(path: &Path, content: &Content) -> Result<(), DataError> {
    let (start, end) = content.ends().map_err(|e| DataError::file_system("read", path, &e))?;
    let size = content.size();
    let damaged = |reason: String| Err(DataError::Damaged { path: path.to_path_buf(), reason });
    if size < 12 || !start.starts_with(MAGIC) {
        return damaged("the file does not begin as a Parquet file".into());
    }
    if !end.ends_with(MAGIC) {
        return damaged(format!("the Parquet file breaks off after {size} bytes"));
    }
    let mut length = [0; 4];
    length.copy_from_slice(&end[end.len() - 8..end.len() - 4]);
    match u64::from(u32::from_le_bytes(length)) + 12 <= size {
        true => Ok(()),
        false => damaged("the footer of the Parquet file is longer than the file".into()),
    }
}

/// Refuses a file that claims more than it can hold, in any of its columns.
pub(crate) fn check_claims(path: &Path, content: &Content) -> Result<(), DataError> {
    claims::check(path, &mut content.reader(), content.size(), &|_| true)
}

/// Runs a decoder; its error or panic as text.
pub(crate) fn guarded<T>(decode: impl FnOnce() -> PolarsResult<T>) -> Result<T, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let usual = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if !QUIET.with(Cell::get) {
                usual(info);
            }
        }));
    });
    QUIET.with(|q| q.set(true));
    let result = catch_unwind(AssertUnwindSafe(decode));
    QUIET.with(|q| q.set(false));
    match result {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(e)) => Err(e.to_string()),
        Err(_) => Err("the columns cannot be decoded".to_string()),
    }
}
