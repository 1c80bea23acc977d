//! What is read, and what must hold for whatever is read: a data set or a message of at most 4 kB, no panic, and little memory.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use acm_datasets::formats::{self, Format, Keep};
use acm_datasets::{Campaign, DataError};
use polars_core::prelude as polars;
use polars_io::prelude::{ParquetCompression, ParquetWriter};

use crate::good::{COLUMNS, MANIFEST, Set, csv, parquet, rows};
use crate::lab::Lab;
use crate::parquet_bytes::Claims;
use crate::recordings;

/// Bytes that reading a set may hold.
const MOST: u64 = 200_000_000;

/// Seconds of a take of several sources.
const SECONDS: f64 = 8.0;

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    Csv,
    Parquet,
    Manifest,
    Motive,
    Vicon,
    Trc,
    Ulog,
    Mcap,
    /// One file of a set of several sources.
    Sources(Format),
}

impl Target {
    pub const ALL: [Target; 11] = [
        Target::Csv,
        Target::Parquet,
        Target::Manifest,
        Target::Motive,
        Target::Vicon,
        Target::Trc,
        Target::Ulog,
        Target::Mcap,
        Target::Sources(Format::Csv),
        Target::Sources(Format::Motive),
        Target::Sources(Format::Ulog),
    ];

    pub fn name(self) -> &'static str {
        match self {
            Target::Csv => "csv",
            Target::Parquet => "parquet",
            Target::Manifest => "manifest",
            Target::Sources(Format::Motive) => "sources-motive",
            Target::Sources(Format::Ulog) => "sources-ulog",
            Target::Sources(_) => "sources-csv",
            other => other.format().map_or("", Format::name),
        }
    }

    /// The format of a recording that is not a table.
    fn format(self) -> Option<Format> {
        match self {
            Target::Motive => Some(Format::Motive),
            Target::Vicon => Some(Format::Vicon),
            Target::Trc => Some(Format::Trc),
            Target::Ulog => Some(Format::Ulog),
            Target::Mcap => Some(Format::Mcap),
            _ => None,
        }
    }

    /// Where it stands in the set.
    fn file(self) -> &'static str {
        match self {
            Target::Csv => "data/run_b.csv",
            Target::Parquet => "data/run_p.parquet",
            Target::Manifest => "data/manifest.toml",
            Target::Sources(Format::Motive) => "a_mocap.csv",
            Target::Sources(Format::Ulog) => "flight.ulg",
            Target::Sources(_) => "a_motors.csv",
            _ => "data/recording",
        }
    }

    /// Files in order, which are damaged.
    pub fn corpus(self) -> std::io::Result<Vec<Vec<u8>>> {
        let text = csv(&rows(1));
        match self {
            Target::Csv => Ok(vec![
                text.clone().into_bytes(),
                text.replace('\n', "\r\n").into_bytes(),
                format!("\u{feff}{}", text.replacen("t,q,h,y", "\"t\",\"q\",h,y", 1)).into_bytes(),
                b"t,q,h,y\n0,1,2,3\n100,1,2,\n200,2,2,5\n".to_vec(),
            ]),
            Target::Manifest => {
                let more =
                    "[folds]\nvalidation = [[\"a\"], [\"b\"]]\n[conditions.a]\nload = { value = 1.0, unit = \"kg\" }\n";
                let cut = "[cut.d]\nhead = { until = 3.0, role = \"excluded\" }\ntail = { role = \"calibration\" }\n";
                let arm =
                    "[arm]\nlength = { value = 1.0, unit = \"m\" }\nstrain = { basis = \"legendre\", order = 1 }\n";
                Ok([more, cut, arm].iter().map(|part| format!("{MANIFEST}{part}").into_bytes()).collect())
            }
            Target::Parquet => parquets(),
            Target::Motive => Ok(recordings::motive()),
            Target::Vicon => Ok(recordings::vicon()),
            Target::Trc => Ok(recordings::trc()),
            Target::Ulog => Ok(recordings::ulog()),
            Target::Mcap => Ok(recordings::mcap()),
            Target::Sources(_) => {
                let text = std::fs::read(Lab::of(2, SECONDS).path().join(self.file()))?;
                Ok(vec![text])
            }
        }
    }

    /// Reads the bytes in place of a file in order; what does not hold.
    pub fn wrong(self, bytes: &[u8]) -> std::io::Result<Option<String>> {
        if let Some(format) = self.format() {
            return recording_wrong(format, bytes);
        }
        if let Target::Sources(_) = self {
            let lab = Lab::of(2, SECONDS);
            std::fs::write(lab.path().join(self.file()), bytes)?;
            return Ok(set_wrong(&lab.path(), |code| code == 3));
        }
        let set = Set::new()?;
        set.write(self.file(), bytes)?;
        Ok(set_wrong(&set.path(), |code| if self == Target::Manifest { matches!(code, 2..=4) } else { code == 3 }))
    }
}

/// Reads a set; what does not hold. Its exit code, if it is refused, is to fit.
fn set_wrong(folder: &Path, fits: impl Fn(u8) -> bool) -> Option<String> {
    let mut read = Ok(Err(DataError::Usage(String::new())));
    let check = || {
        let count = |read: &mut _| {
            *read = catch_unwind(AssertUnwindSafe(|| Campaign::check(folder, None, 50, 0.5)));
        };
        allocation_counter::measure(|| count(&mut read)).bytes_max
    };
    // allocations are counted by thread
    let held = rayon::ThreadPoolBuilder::new().num_threads(1).build().ok()?.install(check);
    if held > MOST {
        return Some(format!("it held {held} bytes"));
    }
    match read {
        Err(_) => Some("it panicked".into()),
        Ok(Ok(campaign)) => {
            let finite = campaign.trials.iter().all(|t| t.measured.iter().chain(&t.actuators).all(|v| v.is_finite()));
            (!finite).then(|| "a value is not finite".into())
        }
        Ok(Err(error)) => {
            let (code, text) = (error.exit_code(), error.to_string());
            let wrong = !fits(code) || text.is_empty() || text.len() > 4096;
            wrong.then(|| format!("code {code}, {} bytes: {text:.300}", text.len()))
        }
    }
}

/// Reads the bytes as a recording of a format; what does not hold.
fn recording_wrong(format: Format, bytes: &[u8]) -> std::io::Result<Option<String>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("recording");
    std::fs::write(&path, bytes)?;
    let read = catch_unwind(AssertUnwindSafe(|| formats::read(&path, format, Keep::All)));
    Ok(match read {
        Err(_) => Some("it panicked".into()),
        Ok(Ok(take)) => {
            let whole = |group: &formats::Group| {
                let lengths = group.columns.iter().map(|column| column.values.len());
                let timed = group.time.len() == group.samples || group.columns.is_empty();
                timed && lengths.into_iter().all(|length| length == group.samples)
            };
            let wrong = take.groups.iter().find(|group| !whole(group));
            wrong.map(|group| format!("group {:?} has columns of other lengths than its time", group.name))
        }
        Ok(Err(error)) => {
            let (code, text) = (error.exit_code(), error.to_string());
            let built = format == Format::Mcap && !cfg!(feature = "mcap") && code == 2;
            (code != 3 && !built || !text.contains("recording") || text.len() > 4096)
                .then(|| format!("code {code}, {} bytes: {text:.300}", text.len()))
        }
    })
}

/// Written by the usual writer with every compression, in several groups, with text and with nulls; and by hand.
fn parquets() -> std::io::Result<Vec<Vec<u8>>> {
    use ParquetCompression::{Brotli, Gzip, Lz4Raw, Snappy, Uncompressed, Zstd};
    let mut corpus = vec![Claims::honest(&COLUMNS, 60).bytes()];
    for compression in [Uncompressed, Snappy, Gzip(None), Zstd(None), Lz4Raw, Brotli(None)] {
        corpus.push(written(compression, false)?);
    }
    corpus.push(written(Uncompressed, true)?);
    let folder = tempfile::tempdir()?;
    parquet(&folder.path().join("a.parquet"), &rows(4));
    corpus.push(std::fs::read(folder.path().join("a.parquet"))?);
    Ok(corpus)
}

fn written(compression: ParquetCompression, text: bool) -> std::io::Result<Vec<u8>> {
    let column = |(i, name): (usize, &&str)| {
        let values: Vec<f64> = rows(4).iter().map(|r| r[i]).collect();
        if text && i == 1 {
            return polars::Column::new((*name).into(), values.iter().map(|v| format!("{v}")).collect::<Vec<_>>());
        }
        let holes = |(t, v): (usize, f64)| (i != 3 || t % 7 != 0).then_some(v);
        polars::Column::new((*name).into(), values.into_iter().enumerate().map(holes).collect::<Vec<_>>())
    };
    let mut frame = polars::DataFrame::new_infer_height(COLUMNS.iter().enumerate().map(column).collect())
        .map_err(std::io::Error::other)?;
    let mut bytes = Vec::new();
    let writer = ParquetWriter::new(&mut bytes).with_compression(compression).with_row_group_size(Some(25));
    writer.finish(&mut frame).map_err(std::io::Error::other)?;
    Ok(bytes)
}
