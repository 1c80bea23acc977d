//! Summary of each column of a file: what a draft needs to know about the values, with the first of them.
//!
//! [`columns`] is the only function here that knows how files are read.

use std::path::Path;

use super::names;
use crate::error::{DataError, Problems};
use crate::formats::{self, Format, Keep};
use crate::ingest::recording::csv::Csv;
use crate::ingest::recording::csv::decimal::Decimal;
use crate::ingest::recording::csv::missing::is_missing;
use crate::ingest::recording::{Cells, Content, DataFile, Held, TimeColumn, Wanted, schema};

/// Longer lists of rows are not kept.
const LISTED: usize = 4096;

/// Values that are kept, from the first.
const KEPT: usize = 1 << 17;

/// Steps from value to value that show the pace.
const STEPS: usize = 1000;

/// Foreign files above this size, in bytes, are read for names and units alone.
const LARGE: u64 = 1 << 28;

/// One column of one file.
#[derive(Debug, Clone)]
pub(super) struct Look {
    pub name: String,
    /// Unit, by the file or by the column's name.
    pub unit: Option<String>,
    pub kind: Held,
    /// Text that is dates or times of day, which are read as time.
    pub dates: bool,
    pub rows: usize,
    pub empty: usize,
    pub low: f64,
    pub high: f64,
    /// All numbers are integers.
    pub whole: bool,
    /// Rows whose value is below the one before; `None` if they are too many.
    pub falls: Option<Vec<usize>>,
    /// Rows where runs of equal cells begin, and those cells; `None` if they are too many.
    pub runs: Option<Vec<(usize, String)>>,
    /// The first numbers; a large file must not fill the memory.
    pub values: Vec<f64>,
    texts: usize,
    stays: usize,
    last: Option<f64>,
}

/// The columns of a file.
pub(super) fn columns(path: &Path, format: Format) -> Result<Vec<Look>, DataError> {
    match format {
        Format::Csv => csv(path),
        Format::Parquet => parquet(path),
        _ => foreign(path, format),
    }
}

fn csv(path: &Path) -> Result<Vec<Look>, DataError> {
    let bytes = match Content::held(path)? {
        Content::Held(bytes) => bytes,
        Content::OnDisk(..) => Vec::new(),
    };
    let open = |wanted: &Wanted| Csv::new(path, bytes.clone(), wanted);
    let csv = open(&Wanted::default())?;
    let numbers = csv.names.iter().filter(|name| !name.is_empty()).map(|name| (name.clone(), true)).collect();
    let wanted = Wanted { numbers, ..Wanted::default() };
    // numbers that can mean two things are asked for by `check`
    let marked = |mark| open(&Wanted { decimal: Some(mark), ..Wanted::default() })?.read(&wanted, &mut Vec::new());
    let read = match csv.read(&wanted, &mut Vec::new()) {
        Err(DataError::NoRows { .. }) => return Ok(csv.names.iter().map(|name| Look::new(name, None)).collect()),
        read => read.or_else(|first| marked(',').or_else(|_| marked('.')).map_err(|_| first))?,
    };
    let unit = |name: &String| csv.units.as_ref().and_then(|units| units.get(name)).map(String::as_str);
    let look = |name: &String| {
        let Cells::Text(texts) = read.cells.get(name)? else { return None };
        let mut look = Look::new(name, unit(name));
        texts.iter().for_each(|cell| look.cell(cell.trim(), read.decimal));
        look.kind = if 2 * look.texts > look.rows - look.empty { Held::Text } else { Held::Number };
        let dates = (look.kind == Held::Text).then(|| dates(&csv, name)).flatten();
        Some(dates.unwrap_or(look))
    };
    // a column that cannot be asked for is listed without its values
    Ok(csv.names.iter().map(|name| look(name).unwrap_or_else(|| Look::new(name, None))).collect())
}

/// A column of dates or times of day.
fn dates(csv: &Csv, name: &str) -> Option<Look> {
    let time = Some(TimeColumn { column: name.to_string(), unit: None, counts: false });
    let wanted = Wanted { numbers: [(name.to_string(), true)].into(), time, ..Wanted::default() };
    let mut read = csv.read(&wanted, &mut Vec::new()).ok()?;
    let Some(Cells::Ticks(_, ticks)) = read.cells.remove(name) else { return None };
    let mut look = Look { dates: true, ..Look::new(name, None) };
    ticks.into_iter().for_each(|tick| look.plain(tick.map_or(f64::NAN, |tick| tick as f64 / 1e9)));
    Some(look)
}

fn parquet(path: &Path) -> Result<Vec<Look>, DataError> {
    let held = schema(path, &Content::of(path)?)?;
    let of = |kind: Held| held.iter().filter(move |(_, held)| *held == kind).map(|(name, _)| name.clone());
    let time = of(Held::Time).next().map(|column| TimeColumn { column, unit: None, counts: false });
    let numbers = of(Held::Number).chain(time.iter().map(|time| time.column.clone())).map(|name| (name, true));
    let mut wanted = vec![Wanted { numbers: numbers.collect(), time, ..Wanted::default() }];
    let text = |name| Wanted { label: Some(name), ..Wanted::default() };
    wanted.extend(of(Held::Text).map(text));
    let mut looks: Vec<Look> =
        held.iter().map(|(name, held)| Look { kind: held.clone(), ..Look::new(name, None) }).collect();
    for wanted in wanted.iter().filter(|wanted| !wanted.numbers.is_empty() || wanted.label.is_some()) {
        let (file, _) = DataFile::open(path, Some(Format::Parquet), wanted, false)?;
        for piece in 0..file.pieces() {
            let mut problems = Vec::new();
            let Some(read) = file.read(piece, &mut problems) else {
                Problems(problems).into_result()?;
                continue;
            };
            for look in &mut looks {
                let clock = wanted.time.as_ref().filter(|time| time.column == look.name).and(read.ticks.as_ref());
                let label = wanted.label.as_ref().filter(|label| **label == look.name).and(read.labels.as_ref());
                read.numbers.get(&look.name).into_iter().flatten().for_each(|value| look.plain(*value));
                clock.iter().flat_map(|ticks| &ticks.values).for_each(|t| look.plain(t.map_or(f64::NAN, |t| t as f64)));
                label.into_iter().flatten().for_each(|cell| look.cell(cell, Decimal::default()));
            }
        }
    }
    Ok(looks)
}

/// Motion capture and logs.
fn foreign(path: &Path, format: Format) -> Result<Vec<Look>, DataError> {
    let size = std::fs::metadata(path).map_err(|e| DataError::file_system("read", path, &e))?.len();
    let take = formats::read(path, format, if size > LARGE { Keep::Nothing } else { Keep::All })?;
    let mut looks = Vec::new();
    for group in take.groups {
        looks.extend(group.columns.into_iter().map(|column| {
            let mut look = Look::new(&column.name, column.unit);
            column.values.iter().for_each(|value| look.plain(*value));
            look.rows = group.samples;
            look
        }));
    }
    Ok(looks)
}

impl Look {
    fn new(name: &str, unit: Option<&str>) -> Look {
        Look {
            name: name.to_string(),
            unit: unit.and_then(names::known).or_else(|| names::unit(name).map(|(_, unit)| unit)),
            kind: Held::Number,
            dates: false,
            rows: 0,
            empty: 0,
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
            whole: true,
            falls: Some(Vec::new()),
            runs: Some(Vec::new()),
            values: Vec::new(),
            texts: 0,
            stays: 0,
            last: None,
        }
    }

    /// A cell as it is written.
    fn cell(&mut self, cell: &str, decimal: Decimal) {
        let cell = if is_missing(cell) { "" } else { cell };
        match decimal.number(cell) {
            Some(value) => self.number(value, || cell.to_string()),
            None => {
                let is_new = self.runs.as_ref().is_some_and(|runs| runs.last().is_none_or(|(_, last)| last != cell));
                self.run(is_new, || cell.to_string());
                (self.rows, self.last) = (self.rows + 1, None);
                if cell.is_empty() { self.empty += 1 } else { self.texts += 1 }
            }
        }
    }

    fn plain(&mut self, value: f64) {
        self.number(value, || value.to_string());
    }

    fn number(&mut self, value: f64, cell: impl FnOnce() -> String) {
        self.run(self.last != Some(value), cell);
        self.rows += 1;
        if !value.is_finite() {
            self.empty += 1;
            return;
        }
        (self.low, self.high) = (self.low.min(value), self.high.max(value));
        self.whole &= value.fract() == 0.0;
        if self.values.len() < KEPT {
            self.values.push(value);
        }
        if let Some(last) = self.last.replace(value) {
            self.step(value - last);
        }
    }

    fn step(&mut self, step: f64) {
        if step < 0.0 {
            self.falls = self.falls.take().filter(|rows| rows.len() < LISTED);
            let row = self.rows - 1;
            self.falls.iter_mut().for_each(|rows| rows.push(row));
        }
        self.stays += usize::from(step == 0.0);
    }

    fn run(&mut self, is_new: bool, cell: impl FnOnce() -> String) {
        if is_new {
            self.runs = self.runs.take().filter(|runs| runs.len() < LISTED);
            if let Some(runs) = &mut self.runs {
                runs.push((self.rows, cell()));
            }
        }
    }

    /// Rows where runs of equal cells begin; `None` if they are too many.
    pub fn starts(&self) -> Vec<usize> {
        self.runs.iter().flatten().map(|(row, _)| *row).collect()
    }

    /// Whether it can name trials: text or whole numbers.
    pub fn is_label(&self) -> bool {
        self.kind == Held::Text || (self.kind == Held::Number && self.whole)
    }

    /// Median step from value to value, where nine steps of ten are about as long.
    pub fn pace(&self) -> Option<f64> {
        let mut steps: Vec<f64> = self.values.windows(2).take(STEPS).map(|pair| pair[1] - pair[0]).collect();
        steps.sort_by(f64::total_cmp);
        let median = steps.get(steps.len() / 2).copied().filter(|step| *step > 0.0)?;
        let alike = steps.iter().filter(|step| (0.5 * median..=1.5 * median).contains(*step)).count();
        (10 * alike >= 9 * steps.len()).then_some(median)
    }

    /// Whether the value rises from row to row, but for the rows where a trial begins. A damaged clock may fall in one row of a
    /// hundred, and stand still in half of them.
    pub fn rises(&self, starts: &[usize], damaged: bool) -> bool {
        let Some(falls) = &self.falls else { return false };
        let count = falls.iter().filter(|row| starts.binary_search(row).is_err()).count();
        let (falls, stays) = if damaged { (self.rows.max(200) / 100, self.rows / 2) } else { (0, 0) };
        self.rows > self.empty + 1 && count <= falls && self.stays <= stays
    }
}
