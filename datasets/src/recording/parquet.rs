//! Parquet, decoded by polars.
//!
//! A decoder that meets damaged bytes may panic instead of returning an error: here, and nowhere else, a panic is
//! caught and becomes a message.

use std::cell::Cell;
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Once;

use polars::prelude::*;

use super::Wanted;
use crate::error::DataError;

const MAGIC: &[u8] = b"PAR1";

thread_local! {
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

pub(super) fn read(path: &Path, bytes: Vec<u8>, wanted: &Wanted) -> Result<DataFrame, DataError> {
    check_ends(path, &bytes)?;
    let damaged = |reason: String| DataError::Damaged { path: path.to_path_buf(), reason };
    let bytes = Cursor::new(bytes);
    let header = guarded(|| {
        let schema = ParquetReader::new(bytes.clone()).schema()?;
        Ok(schema.iter_names().map(|n| n.to_string()).collect::<Vec<_>>())
    });
    wanted.check_header(path, &header.map_err(damaged)?)?;
    let columns = wanted.columns().iter().map(|c| c.to_string()).collect();
    guarded(|| {
        let reader = ParquetReader::new(bytes).with_columns(Some(columns));
        reader.read_parallel(ParallelStrategy::None).set_rechunk(true).finish()
    })
    .map_err(damaged)
}

/// A Parquet file begins and ends with its mark, and the length of its footer stands before the last one.
pub(crate) fn check_ends(path: &Path, bytes: &[u8]) -> Result<(), DataError> {
    let damaged = |reason: String| Err(DataError::Damaged { path: path.to_path_buf(), reason });
    if bytes.len() < 12 || !bytes.starts_with(MAGIC) {
        return damaged("the file does not begin as a Parquet file".into());
    }
    if !bytes.ends_with(MAGIC) {
        return damaged(format!("the Parquet file breaks off after {} bytes", bytes.len()));
    }
    let mut length = [0; 4];
    length.copy_from_slice(&bytes[bytes.len() - 8..bytes.len() - 4]);
    match u32::from_le_bytes(length) as usize + 12 <= bytes.len() {
        true => Ok(()),
        false => damaged("the footer of the Parquet file is longer than the file".into()),
    }
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
