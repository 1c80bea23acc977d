//! CSV as people have it, brought to the one form that [`super::csv`] reads: UTF-8, commas, decimal points, empty cells.
//!
//! | in the file | recognised by | else |
//! | --- | --- | --- |
//! | gzip, UTF-16, a mark of order | its first bytes | UTF-8 |
//! | separator `,` `;` tab `\|` | the only one that is in the header and as often in each row | refused: `separator = …` |
//! | decimal comma | a number such as `0,5` or `12,34` in a file without commas between cells | a point |
//! | `1,234` alone | nothing: it may be a thousand | refused: `decimal = …` |
//! | a row of units below the header | every cell of it is a unit or empty | none |
//! | missing values | `nan`, `NA`, `#N/A`, `null`, `none`, `-` | |
//! | time as a date or of day, ISO 8601 | the first cell of the column of time | a number |
//!
//! What was recognised is a note. Nothing else is changed, so that what is wrong keeps its row.

mod instant;
mod text;

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::DataError;

/// What a manifest tells of a file, in place of what is recognised.
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
    /// What was recognised.
    pub notes: Vec<String>,
    /// Units by column, where a row says them.
    pub units: BTreeMap<String, String>,
    /// The column of time was written as instants and is now in seconds from the first.
    pub instants: bool,
}

/// Names of a missing value, in small letters.
const MISSING: &[&str] = &["nan", "na", "n/a", "#n/a", "#na", "null", "none", "-", "--", "missing"];

/// Rows that the separator is recognised from.
const LOOKED_AT: usize = 200;

/// Brings a file to the one form.
pub(crate) fn plain(path: &Path, bytes: Vec<u8>, told: &Told) -> Result<Plain, DataError> {
    let mut plain = Plain { first_row: 2, ..Plain::default() };
    let text = text::decoded(path, bytes, &mut plain.notes)?;
    let separator = match told.separator {
        Some(separator) => separator,
        None => separator(path, &text)?,
    };
    if separator != ',' {
        plain.notes.push(format!("cells are separated by {separator:?}"));
    }
    let mut rows: Vec<Vec<String>> = text.lines().map(|line| cells(line, separator)).collect();
    let header: Vec<String> = rows.first().into_iter().flatten().map(|name| name.trim().to_string()).collect();
    units(&mut rows, &header, &mut plain);
    decimals(path, &mut rows, separator, told, &mut plain)?;
    missing(&mut rows, &mut plain.notes);
    if let Some(at) = told.time.as_ref().and_then(|time| header.iter().position(|name| name == time)) {
        plain.instants = instant::seconds(path, &mut rows, at, plain.first_row, &mut plain.notes)?;
    }
    let line = |row: &Vec<String>| row.iter().map(|cell| quoted(cell)).collect::<Vec<_>>().join(",");
    plain.bytes = rows.iter().map(|row| line(row) + "\n").collect::<String>().into_bytes();
    Ok(plain)
}

/// The cells of a line; quotes are taken off.
fn cells(line: &str, separator: char) -> Vec<String> {
    let (mut cells, mut quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            c if c == separator && !quoted => cells.push(String::new()),
            c => cells.last_mut().into_iter().for_each(|cell| cell.push(c)),
        }
    }
    cells
}

fn quoted(cell: &str) -> String {
    if cell.contains([',', '\n']) { format!("\"{cell}\"") } else { cell.to_string() }
}

/// The only character that separates the header and as many cells in each row.
fn separator(path: &Path, text: &str) -> Result<char, DataError> {
    let lines: Vec<&str> = text.lines().take(LOOKED_AT).collect();
    let Some(header) = lines.first() else { return Ok(',') };
    let fits = |separator: &char| {
        let count = cells(header, *separator).len();
        count > 1 && lines.iter().all(|line| line.trim().is_empty() || cells(line, *separator).len() == count)
    };
    let fitting: Vec<char> = [',', ';', '\t', '|'].into_iter().filter(fits).collect();
    match fitting.as_slice() {
        [one] => Ok(*one),
        [] => Ok(','),
        several => {
            let what = format!("{several:?} each separate as many cells in every row");
            let remedy = "say separator = \",\" or another in its [[source]]";
            Err(DataError::BadText { path: path.to_path_buf(), row: 1, what, remedy })
        }
    }
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
    plain.first_row = 3;
    rows.remove(1);
}

/// How a number with one comma can be meant.
enum Comma {
    Fraction,
    Either,
}

/// A number with one comma, such as `-0,5`, `1,234` or `1,5e-3`; none of other text.
fn comma(cell: &str) -> Option<Comma> {
    let (before, after) = cell.trim().split_once(',')?;
    let number = format!("{before}.{after}").parse::<f64>().is_ok();
    if !number || after.is_empty() || before.contains('.') {
        return None;
    }
    let whole = before.trim_start_matches(['-', '+']);
    let thousand = (1..=3).contains(&whole.len()) && whole != "0" && after.len() == 3;
    let digits = after.bytes().all(|b| b.is_ascii_digit()) && whole.bytes().all(|b| b.is_ascii_digit());
    Some(if thousand && digits { Comma::Either } else { Comma::Fraction })
}

fn decimals(
    path: &Path,
    rows: &mut [Vec<String>],
    separator: char,
    told: &Told,
    plain: &mut Plain,
) -> Result<(), DataError> {
    let found = |fits: fn(&Comma) -> bool| {
        let of = |(r, row): (usize, &Vec<String>)| {
            row.iter().find(|cell| comma(cell).as_ref().is_some_and(fits)).map(|cell| (r, cell.clone()))
        };
        rows.iter().enumerate().skip(1).find_map(of)
    };
    let fraction = found(|comma| matches!(comma, Comma::Fraction));
    let either = found(|comma| matches!(comma, Comma::Either));
    let is_comma = match (told.decimal, &fraction, &either) {
        (Some(told), ..) => told == ',',
        (None, Some(_), _) => separator != ',',
        (None, None, Some((r, cell))) => {
            let row = r + plain.first_row - 1;
            let what = format!("{cell:?} may be a fraction or more than a thousand");
            let remedy = "say decimal = \",\" or decimal = \".\" in its [[source]]";
            return Err(DataError::BadText { path: path.to_path_buf(), row, what, remedy });
        }
        (None, None, None) => false,
    };
    if !is_comma {
        return Ok(());
    }
    let how = if told.decimal.is_some() {
        "told".to_string()
    } else {
        format!("as {:?} shows", fraction.map_or(String::new(), |f| f.1))
    };
    plain.notes.push(format!("numbers have a decimal comma ({how})"));
    for cell in rows.iter_mut().skip(1).flatten() {
        if comma(cell).is_some() {
            *cell = cell.replacen(',', ".", 1);
        }
    }
    Ok(())
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
