//! Format of a file: by its extension, and by its first bytes where several formats share one.

use std::io::Read;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::DataError;
use crate::files::regular;

/// Bytes that are looked at.
const HEAD: u64 = 1 << 16;

/// A format of recordings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Format {
    /// A table with a header.
    Csv,
    /// A table with types.
    Parquet,
    /// CSV of OptiTrack Motive.
    Motive,
    /// CSV of Vicon Nexus.
    Vicon,
    /// TRC, of markers.
    Trc,
    /// ULog of PX4.
    Ulog,
    /// MCAP with messages of ROS 2.
    Mcap,
}

impl Format {
    /// Every format.
    pub const ALL: &[Format] =
        &[Format::Csv, Format::Parquet, Format::Motive, Format::Vicon, Format::Trc, Format::Ulog, Format::Mcap];

    /// Name in a manifest.
    pub fn name(self) -> &'static str {
        match self {
            Format::Csv => "csv",
            Format::Parquet => "parquet",
            Format::Motive => "motive",
            Format::Vicon => "vicon",
            Format::Trc => "trc",
            Format::Ulog => "ulog",
            Format::Mcap => "mcap",
        }
    }

    /// Whether it is a table, whose time the manifest names.
    pub fn is_table(self) -> bool {
        matches!(self, Format::Csv | Format::Parquet)
    }
}

/// The format of a file; `None` where it is none that is known.
///
/// # Errors
/// The file system.
pub fn recognise(path: &Path) -> Result<Option<Format>, DataError> {
    let failed = |e: &std::io::Error| DataError::file_system("read", path, e);
    let mut head = Vec::new();
    regular::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut head)).map_err(|e| failed(&e))?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    Ok(of(&name, &head))
}

/// Format by the name in lower case, and the first bytes.
fn of(name: &str, head: &[u8]) -> Option<Format> {
    let ends = |ending: &str| name.ends_with(ending);
    if head.starts_with(b"ULog\x01\x12\x35") || ends(".ulg") || ends(".ulog") {
        return Some(Format::Ulog);
    }
    if head.starts_with(b"\x89MCAP") || ends(".mcap") {
        return Some(Format::Mcap);
    }
    if head.starts_with(b"PAR1") || ends(".parquet") {
        return Some(Format::Parquet);
    }
    let text = String::from_utf8_lossy(head);
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    if text.starts_with("PathFileType") || ends(".trc") {
        return Some(Format::Trc);
    }
    if is_motive(text) {
        return Some(Format::Motive);
    }
    if is_vicon(text) {
        return Some(Format::Vicon);
    }
    let table = [".csv", ".tsv", ".txt", ".csv.gz", ".tsv.gz", ".txt.gz"].iter().any(|ending| ends(ending));
    table.then_some(Format::Csv)
}

/// A first row of keys and values, or a row of labels that begins with `Frame,Time`.
fn is_motive(text: &str) -> bool {
    let is_labels = |line: &str| matches!(labels(line), ["Frame", "Time" | "Time (Seconds)"]);
    labels(text.lines().next().unwrap_or_default())[0] == "Format Version"
        || text.lines().skip(1).take(12).any(is_labels)
}

/// A section's name, and `Frame,Sub Frame` three rows below it; other sections may precede it.
fn is_vicon(text: &str) -> bool {
    text.lines().take(200).any(|line| labels(line) == ["Frame", "Sub Frame"])
}

/// The first two cells of a line with a third, whatever separates them.
fn labels(line: &str) -> [&str; 2] {
    let mut cells = line.split([',', ';', '\t']).map(|cell| cell.trim().trim_matches('"'));
    let labels = [cells.next().unwrap_or_default(), cells.next().unwrap_or_default()];
    if cells.next().is_some() { labels } else { [""; 2] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn names_and_first_rows_tell_the_format() {
        let of = |name, text: &str| of(name, text.as_bytes());
        assert_eq!(of("a.csv", "Format Version,1.23,Take Name,x"), Some(Format::Motive));
        assert_eq!(of("a.csv", ",,Type\nFrame,Time (Seconds),X"), Some(Format::Motive));
        assert_eq!(of("a.csv", "\nTrajectories\n100\n,,A\nFrame,Sub Frame,X"), Some(Format::Vicon));
        assert_eq!(of("a.csv", "Format Version;1,23;Take Name;x"), Some(Format::Motive));
        assert_eq!(
            of("a.csv", "Events\n50\na,b,c\n\nTrajectories\n100\n\t\tA\nFrame\tSub Frame\tX"),
            Some(Format::Vicon)
        );
        assert_eq!(of("a.csv", "PathFileType,4,(X/Y/Z)"), Some(Format::Trc));
        assert_eq!(of("a.csv", "t,q\n0,1"), Some(Format::Csv));
        assert_eq!(of("a.csv", "Frame,Time,X\n0,1,2"), Some(Format::Csv), "a table whose header looks alike");
        assert_eq!(of("a.txt.gz", ""), Some(Format::Csv));
        assert_eq!(of("a.bin", "ULog\x01\x12\x35"), Some(Format::Ulog));
        assert_eq!(of("a.bin", "what"), None);
    }
}
