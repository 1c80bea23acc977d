//! Parquet, decoded by polars.
//!
//! A decoder that meets damaged bytes may panic instead of returning an error: here, and nowhere else, a panic is
//! caught and becomes a message.

mod claims;
mod decode;
mod kind;
mod thrift;

use std::cell::Cell;
use std::collections::BTreeMap;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Once;

use polars_arrow::array::Array;
use polars_arrow::datatypes::Field;
use polars_error::{PolarsError, PolarsResult};
use polars_parquet::read::schema::{infer_schema, parquet_to_arrow_schema};
use polars_parquet::read::{FileMetadata, RowGroupMetadata, read_metadata};

use self::kind::Kind;
use super::cells::Cells;
use super::content::Content;
use super::ticks::TickType;
use super::{Wanted, header};
use crate::error::{DataError, Problems};

const MAGIC: &[u8] = b"PAR1";

/// Mark of a file whose footer is encrypted.
const ENCRYPTED: &[u8] = b"PARE";

/// What to do about an encoding that is not supported.
const REMEDY: &str = "write the column as 64-bit floats in a common encoding (pyarrow and pandas do so by default)";

thread_local! {
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// Elements of a list that are listed as columns.
const WIDEST: usize = 256;

/// Rows that are decoded at a time, where groups of rows are no larger.
const PIECE: usize = 1 << 16;

/// An opened file, whose rows are decoded piece by piece.
pub(super) struct ParquetFile {
    path: PathBuf,
    content: Content,
    metadata: FileMetadata,
    /// The wanted columns; one with a problem is left out.
    columns: BTreeMap<String, Stored>,
    /// Groups of rows of each piece, as many as come to [`PIECE`].
    pub pieces: Vec<Piece>,
}

/// How a wanted column is stored, and how it is read.
#[derive(Clone)]
struct Stored {
    /// Column of the file.
    field: Field,
    /// Element of its lists, if it has lists.
    element: Option<usize>,
    kind: Kind,
}

/// Some groups of rows, and their rows.
#[derive(Debug, Clone, Default)]
pub(super) struct Piece {
    groups: Range<usize>,
    pub rows: Range<usize>,
}

impl ParquetFile {
    /// Looks at the ends of the file, its header and its groups of rows; what is wrong with columns goes to `problems`.
    pub fn open(
        path: &Path,
        content: Content,
        wanted: &Wanted,
        problems: &mut Vec<DataError>,
    ) -> Result<Self, DataError> {
        check_ends(path, &content)?;
        let asked = |column: &str| {
            wanted.columns().iter().any(|name| *name == column || element(name).is_some_and(|e| e.0 == column))
        };
        let nested = claims::nested(&mut content.reader(), content.size(), &asked);
        match Self::checked(path, content, wanted, (&asked, &nested), problems) {
            // a list or a structure where a column of numbers is wanted is no damage
            Err(damaged @ DataError::Damaged { .. }) => {
                let unread = nested.iter().map(|(column, kind)| DataError::unread(path, column, kind));
                Problems(unread.collect()).into_result()?;
                Err(damaged)
            }
            opened => opened,
        }
    }

    fn checked(
        path: &Path,
        content: Content,
        wanted: &Wanted,
        (asked, nested): (&dyn Fn(&str) -> bool, &[(String, &'static str)]),
        problems: &mut Vec<DataError>,
    ) -> Result<Self, DataError> {
        claims::check(path, &mut content.reader(), content.size(), asked)?;
        let damaged = |reason: String| DataError::undecoded(path, reason, REMEDY);
        let opened = guarded(|| {
            let metadata = read_metadata(&mut content.reader())?;
            let types = types(&metadata, &wanted.columns());
            Ok((metadata, types))
        });
        let (metadata, mut types) = opened.map_err(damaged)?;
        for (column, kind) in nested.iter().filter(|(_, kind)| *kind != "list") {
            types.entry(column.clone()).and_modify(|stored| stored.kind = Kind::Unread((*kind).into()));
        }
        let mut names: Vec<String> = metadata.schema().fields().iter().map(|field| field.name().to_string()).collect();
        let elements = types.iter().filter(|(name, stored)| stored.element.is_some() && !names.contains(name));
        names.extend(elements.map(|(name, _)| name.clone()).collect::<Vec<_>>());
        let mut found = header::check(path, &names, wanted);
        let mut columns = BTreeMap::new();
        for column in header::present(&names, wanted) {
            let Some(stored) = types.get(column) else { continue };
            match refusal(path, column, &stored.kind, wanted) {
                Some(problem) => found.push(problem),
                None => drop(columns.insert(column.to_string(), stored.clone())),
            }
        }
        if columns.is_empty() {
            Problems(std::mem::take(&mut found)).into_result()?;
        }
        problems.extend(found);
        let pieces = pieces(metadata.row_groups.iter().map(RowGroupMetadata::num_rows));
        Ok(Self { path: path.to_path_buf(), content, metadata, columns, pieces })
    }

    /// The type of the column of time, where it has one of its own.
    pub fn time_type(&self, wanted: &Wanted) -> Option<&TickType> {
        match self.columns.get(&wanted.time.as_ref()?.column) {
            Some(Stored { kind: Kind::Time(of), .. }) => Some(of),
            _ => None,
        }
    }

    /// Hands out the wanted columns of a piece, one after the other; how many rows they have.
    pub fn read(&self, piece: &Piece, wanted: &Wanted, take: &mut dyn FnMut(&str, &Cells)) -> Result<usize, DataError> {
        let damaged = |reason| DataError::undecoded(&self.path, reason, REMEDY);
        let rows = piece.rows.len();
        for name in wanted.columns() {
            let Some(stored) = self.columns.get(name) else { continue };
            let column = guarded(|| self.column(piece, stored)).map_err(damaged)?;
            let values = column.as_ref().map_or(0, Cells::len);
            if values != rows {
                return Err(damaged(format!("column `{name}` has {values} values in {rows} rows")));
            }
            column.iter().for_each(|cells| take(name, cells));
        }
        Ok(rows)
    }

    fn column(&self, piece: &Piece, stored: &Stored) -> PolarsResult<Option<Cells>> {
        let (name, kind) = (stored.field.name.as_str(), (&stored.kind, stored.element));
        let mut whole: Option<Cells> = None;
        for group in &self.metadata.row_groups[piece.groups.clone()] {
            let none = || PolarsError::ComputeError(format!("column `{name}` is not in every group of rows").into());
            let column = group.columns_under_root_iter(name).and_then(|mut c| c.next()).ok_or_else(none)?;
            let cells = decode::cells(&mut self.content.reader(), column, &stored.field, kind)?;
            match &mut whole {
                Some(before) => before.extend(cells),
                None => whole = Some(cells),
            }
        }
        Ok(whole)
    }
}

/// What a column holds.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Held {
    Number,
    Text,
    /// A type of time.
    Time,
    /// A type that is not read, by its name.
    Unread(String),
}

/// Every column of a file in its order, and what it holds; lists of numbers are columns `action[0]`, `action[1]`, ….
pub(crate) fn schema(path: &Path, content: &Content) -> Result<Vec<(String, Held)>, DataError> {
    check_ends(path, content)?;
    claims::check(path, &mut content.reader(), content.size(), &|_| false)?;
    let read = guarded(|| {
        let metadata = read_metadata(&mut content.reader())?;
        let names: Vec<String> =
            metadata.schema().fields().iter().flat_map(|field| elements(&metadata, field.name())).collect();
        let types = types(&metadata, &names.iter().map(String::as_str).collect::<Vec<_>>());
        let held = |name: String| (name.clone(), Held::of(types.get(&name).map(|stored| &stored.kind)));
        Ok(names.into_iter().map(held).collect())
    });
    read.map_err(|reason| DataError::undecoded(path, reason, REMEDY))
}

impl Held {
    fn of(kind: Option<&Kind>) -> Held {
        match kind {
            Some(Kind::Numbers | Kind::Whole | Kind::Halves | Kind::Decimals(_)) => Held::Number,
            Some(Kind::Text) => Held::Text,
            Some(Kind::Time(_)) => Held::Time,
            Some(Kind::Lists) => Held::Unread("list".into()),
            Some(Kind::Unread(kind)) => Held::Unread(kind.clone()),
            None => Held::Unread("an unknown type".into()),
        }
    }
}

/// The columns that a column of lists makes, by the number of values in each row; another column is itself.
fn elements(metadata: &FileMetadata, root: &str) -> Vec<String> {
    let stored = parquet_to_arrow_schema(metadata.schema().fields());
    let is_list = stored.get(root).is_some_and(|field| kind::of_list(&field.dtype, None).is_some());
    let count = |group: &RowGroupMetadata| {
        let column = group.columns_under_root_iter(root)?.next()?;
        Some(column.num_values() as usize / group.num_rows().max(1))
    };
    match metadata.row_groups.iter().filter_map(count).max() {
        Some(several) if is_list && several > 1 => (0..several.min(WIDEST)).map(|k| format!("{root}[{k}]")).collect(),
        _ => vec![root.to_string()],
    }
}

/// The types of the columns. What the Parquet types say holds for the bytes; the Arrow schema beside it adds types that
/// Parquet has no name for.
fn types(metadata: &FileMetadata, columns: &[&str]) -> BTreeMap<String, Stored> {
    let stored = parquet_to_arrow_schema(metadata.schema().fields());
    let named = infer_schema(metadata).ok();
    let of = |column: &str| {
        let (root, element) = match element(column).filter(|_| !stored.contains(column)) {
            Some((root, element)) => (root, Some(element)),
            None => (column, None),
        };
        let field = stored.get(root)?.clone();
        let named = named.as_ref().and_then(|schema| kind::in_schema(schema, root));
        let (element, kind) = match kind::of_list(&field.dtype, named) {
            Some(kind) if element.is_some() => (element, kind),
            Some(kind) if has_single_values(metadata, root) => (Some(0), kind),
            Some(_) => (Some(0), Kind::Lists),
            None if element.is_some() => return None,
            None => (None, Kind::of(&field.dtype, named)),
        };
        Some((column.to_string(), Stored { field, element, kind }))
    };
    columns.iter().copied().filter_map(of).collect()
}

/// Column and index of `action[1]`.
fn element(name: &str) -> Option<(&str, usize)> {
    let (root, index) = name.strip_suffix(']')?.rsplit_once('[')?;
    Some((root, index.parse().ok()?))
}

/// Whether the lists of a column have one value each.
fn has_single_values(metadata: &FileMetadata, root: &str) -> bool {
    metadata.row_groups.iter().all(|group| {
        let mut columns = group.columns_under_root_iter(root).into_iter().flatten();
        columns.all(|column| column.num_values() as usize == group.num_rows())
    })
}

/// Refusal of a column of this type.
fn refusal(path: &Path, column: &str, kind: &Kind, wanted: &Wanted) -> Option<DataError> {
    let (path, name) = (path.to_path_buf(), column.to_string());
    let time = wanted.time.as_ref().filter(|time| time.column == column);
    let what = |kind: &str, what, remedy| {
        Some(DataError::WrongType { path: path.clone(), column: name.clone(), kind: kind.into(), what, remedy })
    };
    match kind {
        Kind::Unread(kind) => Some(DataError::unread(&path, column, kind)),
        Kind::Lists => what("list", "hold several numbers each", "name one of them, as in `action[0]`"),
        Kind::Time(of) if time.is_none() => {
            what(&of.name, "are times and not numbers", "name another column, or write this one as 64-bit floats")
        }
        Kind::Time(of) if time.is_some_and(|time| time.counts) => {
            what(&of.name, "are no sample numbers", "leave `unit` and `rate_hz` out of `time` in [table]")
        }
        Kind::Time(_) => None,
        _ if time.is_some_and(|time| time.unit.is_none()) => Some(DataError::TimeWithoutUnit { path, column: name }),
        _ => None,
    }
}

/// Runs of whole groups; one piece of no rows where the file has none.
fn pieces(groups: impl Iterator<Item = usize>) -> Vec<Piece> {
    let (mut pieces, mut piece) = (Vec::new(), Piece::default());
    for rows in groups {
        if !piece.rows.is_empty() && piece.rows.len() + rows > PIECE {
            pieces.push(piece.clone());
            piece = Piece { groups: piece.groups.end..piece.groups.end, rows: piece.rows.end..piece.rows.end };
        }
        piece.groups.end += 1;
        piece.rows.end += rows;
    }
    pieces.push(piece);
    pieces
}

/// A Parquet file begins and ends with its mark, and the length of its footer stands before the last one.
pub(crate) fn check_ends(path: &Path, content: &Content) -> Result<(), DataError> {
    let (start, end) = content.ends().map_err(|e| DataError::file_system("read", path, &e))?;
    let size = content.size();
    let damaged = |reason: String| Err(DataError::Damaged { path: path.to_path_buf(), reason });
    if start.starts_with(ENCRYPTED) {
        return Err(claims::encrypted(path));
    }
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

/// All columns of a file whose claims were checked, each as the arrays of its groups of rows.
///
/// # Errors
/// A footer, a type or a page that cannot be decoded.
pub(crate) fn columns(content: &Content) -> PolarsResult<Vec<(String, Vec<Box<dyn Array>>)>> {
    let metadata = read_metadata(&mut content.reader())?;
    let schema = parquet_to_arrow_schema(metadata.schema().fields());
    let mut columns = vec![];
    for (name, field) in schema.iter() {
        let mut arrays = vec![];
        for column in metadata.row_groups.iter().filter_map(|group| group.columns_under_root_iter(name)?.next()) {
            arrays.extend(decode::arrays(&mut content.reader(), column, field)?);
        }
        columns.push((name.to_string(), arrays));
    }
    Ok(columns)
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
