//! Kinds of Parquet columns: physical type, and the Arrow schema in the file.
//!
//! | type in the file                                  | is read as                              |
//! | ------------------------------------------------- | --------------------------------------- |
//! | integers of 8 to 64 bits, floats of 32 and 64     | numbers                                 |
//! | truth values                                      | 0 and 1                                 |
//! | floats of 16 bits, decimals of up to 38 digits    | numbers                                 |
//! | text, also as a dictionary (categories)           | names of trials, or numbers as text     |
//! | timestamps, dates, times of day, durations        | the column of time                      |
//! | lists of numbers                                  | columns `action[0]`, `action[1]`, …     |
//! | structures, maps, bytes, 128 bits and more        | nothing: the type is named              |

use polars_arrow::datatypes::{ArrowDataType, ArrowSchema, TimeUnit};

use crate::ingest::recording::ticks::TickType;

/// Digits of a decimal in 128 bits.
const DIGITS: usize = 38;

/// How a column is read.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Kind {
    Numbers,
    /// Integers of 64 bits, of which a float holds 53.
    Whole,
    /// 16-bit floats, decoded as two bytes each.
    Halves,
    /// Whole numbers of so many digits behind the point.
    Decimals(usize),
    Text,
    Time(TickType),
    /// Lists of several numbers.
    Lists,
    /// A type that is not read, by its name.
    Unread(String),
}

impl Kind {
    /// Kind of a column of type `stored`, which the file's Arrow schema, where present, calls `named`.
    pub fn of(stored: &ArrowDataType, named: Option<&ArrowDataType>) -> Kind {
        use ArrowDataType as T;
        match (stored, named.map(storage)) {
            (T::Int64, Some(T::Duration(unit))) => Kind::Time(ticks("duration", *unit, true)),
            (T::FixedSizeBinary(2), Some(T::Float16)) => Kind::Halves,
            (T::Timestamp(unit, zone), _) => {
                Kind::Time(TickType { local: zone.is_none(), ..ticks("timestamp", *unit, false) })
            }
            (T::Time32(unit), _) => Kind::Time(ticks("time32", *unit, false)),
            (T::Time64(unit), _) => Kind::Time(ticks("time64", *unit, false)),
            (T::Date32, _) => Kind::Time(days()),
            (T::Decimal(precision @ ..=DIGITS, scale), _) if scale <= precision => Kind::Decimals(*scale),
            (T::Decimal(precision, scale), _) => Kind::Unread(format!("decimal({precision}, {scale})")),
            (T::Utf8View, _) => Kind::Text,
            (T::Int64 | T::UInt64, _) => Kind::Whole,
            (stored, _) if number(stored) => Kind::Numbers,
            (stored, named) => Kind::Unread(name(named.unwrap_or(stored))),
        }
    }
}

/// Kind of the elements of a column of lists; `None` if it has no lists of numbers.
pub(super) fn of_list(stored: &ArrowDataType, named: Option<&ArrowDataType>) -> Option<Kind> {
    let inner = |of: &ArrowDataType| match of {
        ArrowDataType::List(inner) | ArrowDataType::LargeList(inner) | ArrowDataType::FixedSizeList(inner, _) => {
            Some(inner.dtype.clone())
        }
        _ => None,
    };
    let kind = Kind::of(&inner(stored)?, named.and_then(|named| inner(storage(named))).as_ref());
    Some(kind).filter(|kind| matches!(kind, Kind::Numbers | Kind::Whole | Kind::Halves | Kind::Decimals(_)))
}

/// The type that holds the values of an extension or of a dictionary.
fn storage(named: &ArrowDataType) -> &ArrowDataType {
    match named {
        ArrowDataType::Extension(extension) => storage(&extension.inner),
        ArrowDataType::Dictionary(_, values, _) => storage(values),
        other => other,
    }
}

/// The type of a wanted column in a schema.
pub(super) fn in_schema<'a>(schema: &'a ArrowSchema, column: &str) -> Option<&'a ArrowDataType> {
    schema.get(column).map(|field| &field.dtype)
}

fn number(stored: &ArrowDataType) -> bool {
    use ArrowDataType::{Boolean, Float32, Float64, Int8, Int16, Int32, UInt8, UInt16, UInt32};
    matches!(stored, Boolean | Int8 | Int16 | Int32 | UInt8 | UInt16 | UInt32 | Float32 | Float64)
}

fn ticks(name: &str, unit: TimeUnit, duration: bool) -> TickType {
    let (unit, per_second) = match unit {
        TimeUnit::Second => ("s", 1),
        TimeUnit::Millisecond => ("ms", 1_000),
        TimeUnit::Microsecond => ("us", 1_000_000),
        TimeUnit::Nanosecond => ("ns", 1_000_000_000),
    };
    TickType { name: format!("{name}[{unit}]"), unit, per_second, seconds: 1, duration, local: false }
}

fn days() -> TickType {
    TickType { name: "date32[day]".into(), unit: "", per_second: 1, seconds: 86_400, duration: false, local: false }
}

/// As pyarrow prints it, without what is within.
fn name(unread: &ArrowDataType) -> String {
    use ArrowDataType as T;
    match unread {
        T::FixedSizeBinary(size) => format!("fixed_size_binary[{size}]"),
        T::Binary | T::LargeBinary | T::BinaryView => "binary".into(),
        T::List(_) | T::LargeList(_) | T::FixedSizeList(_, _) => "list".into(),
        T::Struct(_) => "struct".into(),
        T::Map(_, _) => "map".into(),
        T::Interval(_) => "interval".into(),
        T::Decimal256(precision, scale) => format!("decimal256({precision}, {scale})"),
        other => format!("{other:?}").to_lowercase(),
    }
}
