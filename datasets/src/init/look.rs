//! Summary of each column of a file: what a draft needs to know about the values, with the first of them.
//!
//! This is the only file here that knows how recordings are read.

use std::collections::BTreeMap;
use std::path::Path;

use super::names;
use crate::error::{DataError, Problems};
use crate::formats::{self, Format, Keep};
use crate::ingest::recording::csv::Csv;
use crate::ingest::recording::csv::missing::is_missing;
use crate::ingest::recording::{Content, DataFile, Held, Recording, TimeColumn, Wanted, schema};
use crate::preprocessing::segments::usual_step;

/// Rows that are listed, and one more where there are more.
const LISTED: usize = 4096;

/// Values that are kept, from the first.
const KEPT: usize = 1 << 17;

/// Values that show the pace.
const PACED: usize = 1000;

/// One column of one file.
#[derive(Debug, Clone)]
pub(super) struct Look {
    pub name: String,
    /// Unit, by the file or by the column's name.
    pub unit: Option<String>,
    pub kind: Held,
    pub rows: usize,
    pub empty: usize,
    pub low: f64,
    pub high: f64,
    /// All numbers are integers.
    pub whole: bool,
    /// Rows whose value is below the one before.
    pub falls: Vec<usize>,
    /// Rows whose cell is not the one before.
    pub changes: Vec<usize>,
    stays: usize,
    /// The first values; NaN is an empty cell.
    pub values: Vec<f64>,
}

/// The columns of a file.
pub(super) fn columns(path: &Path, format: Format) -> Result<Vec<Look>, DataError> {
    if !format.is_table() {
        return foreign(path, format);
    }
    let mut looks = header(path, format)?;
    let is_number = |look: &&Look| look.kind == Held::Number && !look.name.is_empty();
    let names: Vec<String> = looks.iter().filter(is_number).map(|look| look.name.clone()).collect();
    // the columns of a Parquet file may not fit into memory together
    let together = if format == Format::Csv { names.len().max(1) } else { 1 };
    for names in names.chunks(together) {
        let mut numbers = numbers(path, format, names)?;
        for look in &mut looks {
            look.replace(Held::Number, numbers.remove(&look.name));
        }
    }
    let is_empty = |look: &&mut Look| look.empty == look.rows && !matches!(look.kind, Held::Unread(_));
    looks.iter_mut().filter(is_empty).for_each(|look| find_words(path, format, look));
    Ok(looks)
}

/// The columns of a table without their values.
fn header(path: &Path, format: Format) -> Result<Vec<Look>, DataError> {
    if format == Format::Parquet {
        let columns = schema(path, &Content::of(path)?)?.into_iter();
        return Ok(columns.map(|(name, held)| Look::new(&name, None, held, Vec::new())).collect());
    }
    let Content::Held(bytes) = Content::held(path)? else { return Ok(Vec::new()) };
    let csv = Csv::new(path, bytes, &Wanted::default())?;
    let units = csv.units.unwrap_or_default();
    let look = |name: &String| Look::new(name, units.get(name).map(String::as_str), Held::Number, Vec::new());
    Ok(csv.names.iter().map(look).collect())
}

/// Numbers by column; NaN is a cell without one.
fn numbers(path: &Path, format: Format, names: &[String]) -> Result<BTreeMap<String, Vec<f64>>, DataError> {
    let numbers: BTreeMap<String, bool> = names.iter().map(|name| (name.clone(), true)).collect();
    let read = |decimal| read(path, format, &Wanted { numbers: numbers.clone(), decimal, ..Wanted::default() });
    // numbers that can mean two things are asked for by `check`
    match read(None).or_else(|first| read(Some(',')).or_else(|_| read(Some('.'))).map_err(|_| first)) {
        Err(DataError::NoRows { .. }) => Ok(BTreeMap::new()),
        read => Ok(read?.numbers),
    }
}

/// A column without numbers may have dates or other words.
fn find_words(path: &Path, format: Format, look: &mut Look) {
    let time = TimeColumn { column: look.name.clone(), unit: None, counts: false };
    let numbers = [(look.name.clone(), true)].into();
    let dates = read(path, format, &Wanted { numbers, time: Some(time), ..Wanted::default() });
    if let Some(ticks) = dates.ok().and_then(|read| read.ticks) {
        let rows: Vec<usize> = (0..ticks.values.len()).collect();
        return look.replace(Held::Time, Some(ticks.seconds(&rows)));
    }
    let labels = labels(path, format, &look.name);
    if !labels.iter().all(|label| is_missing(label)) {
        let changes = labels.windows(2).scan(0.0, |run, pair| {
            *run += f64::from(u8::from(pair[0] != pair[1]));
            Some(*run)
        });
        look.replace(Held::Text, Some(std::iter::once(0.0).chain(changes).collect()));
    }
}

/// The cells of a column as names of trials.
pub(super) fn labels(path: &Path, format: Format, column: &str) -> Vec<String> {
    let wanted = Wanted { label: Some(column.to_string()), ..Wanted::default() };
    read(path, format, &wanted).ok().and_then(|read| read.labels).unwrap_or_default()
}

/// Reads the wanted columns of a table; cells that are none of what is wanted are empty.
fn read(path: &Path, format: Format, wanted: &Wanted) -> Result<Recording, DataError> {
    let (file, _) = DataFile::open(path, Some(format), wanted, false)?;
    let mut whole: Option<Recording> = None;
    for piece in 0..file.pieces() {
        let mut problems = Vec::new();
        match (whole.take(), file.read(piece, &mut problems)) {
            (_, None) => Problems(problems).into_result()?,
            (None, read) => whole = read,
            (Some(before), Some(read)) => whole = Some(before.followed_by(read)),
        }
    }
    Ok(whole.unwrap_or_default())
}

/// Motion capture and logs.
fn foreign(path: &Path, format: Format) -> Result<Vec<Look>, DataError> {
    let groups = formats::read(path, format, Keep::All)?.groups.into_iter();
    let columns = groups.flat_map(|group| group.columns);
    Ok(columns.map(|column| Look::new(&column.name, column.unit, Held::Number, column.values)).collect())
}

impl Look {
    fn new(name: &str, unit: Option<&str>, kind: Held, mut values: Vec<f64>) -> Look {
        let rows = |is: fn(f64, f64) -> bool| {
            let pairs = values.windows(2).zip(1..).filter(|(pair, _)| is(pair[0], pair[1]));
            pairs.map(|(_, row)| row).take(LISTED + 1).collect()
        };
        let (falls, changes) = (rows(|a, b| b < a), rows(|a, b| a.to_bits() != b.to_bits()));
        let numbers = || values.iter().copied().filter(|value| value.is_finite());
        let look = Look {
            name: name.to_string(),
            unit: unit.and_then(names::known).or_else(|| names::unit(name).map(|(_, unit)| unit)),
            kind,
            rows: values.len(),
            empty: values.len() - numbers().count(),
            low: numbers().fold(f64::INFINITY, f64::min),
            high: numbers().fold(f64::NEG_INFINITY, f64::max),
            whole: numbers().all(|value| value.fract() == 0.0),
            falls,
            changes,
            stays: values.windows(2).filter(|pair| pair[0] == pair[1]).count(),
            values: Vec::new(),
        };
        values.truncate(KEPT);
        Look { values, ..look }
    }

    /// Sets what the column holds.
    fn replace(&mut self, kind: Held, values: Option<Vec<f64>>) {
        if let Some(values) = values {
            *self = Look::new(&self.name, self.unit.as_deref(), kind, values);
        }
    }

    /// Whether it can name trials: text or whole numbers, in few runs.
    pub fn is_label(&self) -> bool {
        (self.kind == Held::Text || (self.kind == Held::Number && self.whole)) && self.changes.len() <= LISTED
    }

    /// Median step from value to value, where nine steps of ten are about as long.
    pub fn pace(&self) -> Option<f64> {
        let values: Vec<f64> = self.values.iter().copied().filter(|v| v.is_finite()).take(PACED).collect();
        let median = usual_step(&values);
        let is_alike = |pair: &&[f64]| (0.5 * median..=1.5 * median).contains(&(pair[1] - pair[0]));
        let alike = values.windows(2).filter(is_alike).count();
        (median > 0.0 && 10 * alike >= 9 * (values.len() - 1)).then_some(median)
    }

    /// Whether the value rises from row to row, but for the rows where a trial begins. A damaged clock may fall in one row of a
    /// hundred, and stand still in half of them.
    pub fn rises(&self, starts: &[usize], damaged: bool) -> bool {
        let falls = self.falls.iter().filter(|row| starts.binary_search(row).is_err()).count();
        let (most, stays) = if damaged { (self.rows.max(200) / 100, self.rows / 2) } else { (0, 0) };
        self.rows > self.empty + 1 && self.falls.len() <= LISTED && falls <= most && self.stays <= stays
    }
}
