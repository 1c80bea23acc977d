//! CSV as laboratories write it, brought to the one form that [`super::csv`] reads: UTF-8, commas, decimal points, empty cells.
//!
//! | in the file | recognised by | else |
//! | --- | --- | --- |
//! | gzip, UTF-16, a mark of order | its first bytes | UTF-8 |
//! | separator `,` `;` tab `\|` | a first row `sep=;`, or the only one that is in the header and as often in each row | refused: `separator = …` |
//! | decimal comma | a number such as `0,5` or `12,34` in a file without commas between cells | a point |
//! | `0,5` and `1.5` in one file | nothing: points may be those of thousands | refused |
//! | `1,234` alone | nothing: it may be a thousand | refused: `decimal = …` |
//! | a row of units below the header | every cell of it is a unit or empty | none |
//! | missing values | `nan`, `NA`, `#N/A`, `null`, `none`, `-` | |
//! | time as a date or of day, ISO 8601 | the first cell of the column of time | a number |
//!
//! What was recognised is a note. Nothing else is changed, so that what is wrong keeps its row.

mod decimal;
mod instant;
mod rows;
mod text;

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::DataError;

/// Properties of a file that the manifest states; they override recognized ones.
#[derive(Debug, Clone, Default)]
pub(crate) struct Told {
    /// Between cells.
    pub separator: Option<char>,
    /// Before the fraction of a number: a comma or a point.
    pub decimal: Option<char>,
    /// The column of time.
    pub time: Option<String>,
}

/// A file in the one form.
#[derive(Debug, Default)]
pub(crate) struct Plain {
    /// UTF-8, with commas and decimal points.
    pub bytes: Vec<u8>,
    /// Row of the first sample in the file.
    pub first_row: usize,
    /// Recognized properties.
    pub notes: Vec<String>,
    /// Units by column, where a row says them.
    pub units: BTreeMap<String, String>,
    /// The column of time was written as instants and is now in seconds from the first.
    pub instants: bool,
}

/// Names of a missing value, in small letters.
const MISSING: &[&str] = &["nan", "na", "n/a", "#n/a", "#na", "null", "none", "-", "--", "missing"];

/// Brings a file to the one form.
pub(crate) fn plain(path: &Path, bytes: Vec<u8>, told: &Told) -> Result<Plain, DataError> {
    let mut plain = Plain { first_row: 2, ..Plain::default() };
    let text = text::decoded(path, bytes, &mut plain.notes)?;
    let (named, text) = rows::named(&text);
    plain.first_row += usize::from(named.is_some());
    let separator = match told.separator.or(named) {
        Some(separator) => separator,
        None => rows::separator(path, text)?,
    };
    if separator != ',' {
        plain.notes.push(format!("cells are separated by {separator:?}"));
    }
    let mut rows = rows::split(path, text, separator, plain.first_row - 1)?;
    let header: Vec<String> = rows.first().into_iter().flatten().map(|name| name.trim().to_string()).collect();
    units(&mut rows, &header, &mut plain);
    decimal::points(path, &mut rows, separator, told, &mut plain)?;
    missing(&mut rows, &mut plain.notes);
    if let Some(at) = told.time.as_ref().and_then(|time| header.iter().position(|name| name == time)) {
        plain.instants = instant::seconds(path, &mut rows, at, plain.first_row, &mut plain.notes)?;
    }
    let line = |row: &Vec<String>| row.iter().map(|cell| rows::quoted(cell)).collect::<Vec<_>>().join(",");
    plain.bytes = rows.iter().map(|row| line(row) + "\n").collect::<String>().into_bytes();
    Ok(plain)
}

/// A row of units below the header becomes a note and goes.
fn units(rows: &mut Vec<Vec<String>>, header: &[String], plain: &mut Plain) {
    let Some(row) = rows.get(1) else { return };
    let bare = |cell: &str| cell.trim().trim_matches(['[', ']', '(', ')']).to_string();
    let unit = |cell: &String| {
        let name = bare(cell);
        name.parse::<f64>().is_err() && crate::units::Unit::parse(&name).is_ok()
    };
    // "1" is a unit and a number: a row of numbers is none of units
    let some = row.iter().any(unit);
    let all = row.iter().all(|cell| unit(cell) || bare(cell).is_empty() || ["1", "-"].contains(&bare(cell).as_str()));
    if !(some && all) {
        return;
    }
    let named = header.iter().zip(row).map(|(name, cell)| (name.clone(), bare(cell)));
    plain.units = named.filter(|(_, unit)| !unit.is_empty() && unit != "-").collect();
    plain.notes.push("the row below the header has the units".into());
    plain.first_row += 1;
    rows.remove(1);
}

/// Names of missing values become empty cells.
fn missing(rows: &mut [Vec<String>], notes: &mut Vec<String>) {
    let mut counts = BTreeMap::<String, usize>::new();
    for cell in rows.iter_mut().skip(1).flatten() {
        let name = cell.trim();
        if MISSING.contains(&name.to_lowercase().as_str()) {
            *counts.entry(name.to_string()).or_insert(0) += 1;
            cell.clear();
        }
    }
    if !counts.is_empty() {
        let named: Vec<String> = counts.iter().map(|(name, count)| format!("{name:?} ({count} times)")).collect();
        notes.push(format!("missing values are written {}", named.join(", ")));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &[u8], told: &Told) -> Result<(String, Plain), String> {
        let plain = plain(Path::new("a.csv"), text.to_vec(), told).map_err(|e| e.to_string())?;
        Ok((String::from_utf8_lossy(&plain.bytes).into_owned(), plain))
    }

    fn time() -> Told {
        Told { time: Some("t".into()), ..Told::default() }
    }

    /// Oracle: by hand.
    #[test]
    fn tables_of_many_hands_become_one_form() {
        let plain = "t,q\n0,1.5\n1,\n";
        let utf16: Vec<u8> = [0xff, 0xfe].into_iter().chain(plain.encode_utf16().flat_map(u16::to_le_bytes)).collect();
        let cases: &[&[u8]] = &[
            b"t,q\n0,1.5\n1,\n",
            b"\xef\xbb\xbft,q\r\n0,1.5\r\n1,NaN\r\n",
            b"t;q\n0;1,5\n1;#N/A\n",
            b"\"t\"\t\"q\"\n0\t1.5\n1\tnull\n",
            &utf16,
        ];
        for case in cases {
            assert_eq!(of(case, &time()).expect("read").0, plain, "{:?}", String::from_utf8_lossy(case));
        }
        let (text, found) = of(b"t,q\n[s],[mm]\n0,1\n", &time()).expect("read");
        assert_eq!((text.as_str(), found.first_row), ("t,q\n0,1\n", 3));
        assert_eq!(found.units.get("q").map(String::as_str), Some("mm"));
    }

    /// Oracle: by hand.
    #[test]
    fn what_may_mean_two_things_is_asked_for_by_name() {
        let said = |text: &[u8], told: &Told| of(text, told).map(|_| ()).expect_err("refused");
        let message = said(b"t;q\n0;1,234\n1;2,500\n", &Told::default());
        assert!(
            message.contains("row 2") && message.contains("\"1,234\"") && message.contains("decimal = "),
            "{message}"
        );
        let told = Told { decimal: Some(','), ..Told::default() };
        assert_eq!(of(b"t;q\n0;1,234\n", &told).expect("told").0, "t,q\n0,1.234\n");
        let message = said(b"a,b;c\n1,2;3\n", &Told::default());
        assert!(message.contains("separator = "), "{message}");
        assert_eq!(
            of(b"t;q\n0;0,125\n1;1,234\n", &Told::default()).expect("one shows it").0,
            "t,q\n0,0.125\n1,1.234\n"
        );
    }

    /// Oracle: by hand.
    #[test]
    fn instants_become_seconds_from_the_first() {
        let text = b"t,q\n2026-11-03T10:00:00.500+01:00,1\n2026-11-03T09:00:02Z,2\n2026-11-04 10:00:00.5+01:00,3\n";
        assert_eq!(of(text, &time()).expect("read").0, "t,q\n0,1\n1.5,2\n86400,3\n");
        assert_eq!(of(b"t,q\n23:59:59.5,1\n00:00:00.25,2\n", &time()).expect("read").0, "t,q\n0,1\n0.75,2\n");
        let message =
            of(b"t,q\n2026-11-03T10:00:00Z,1\n2026-13-03T10:00:00Z,2\n", &time()).map(|_| ()).expect_err("refused");
        assert!(message.contains("row 3") && message.contains("2026-13-03"), "{message}");
        let mixed =
            of(b"t,q\n2026-11-03T10:00:00Z,1\n2026-11-03T10:00:01,2\n", &time()).map(|_| ()).expect_err("refused");
        assert!(mixed.contains("zone"), "{mixed}");
    }
}
