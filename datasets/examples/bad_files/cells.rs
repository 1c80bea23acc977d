//! Spoiled cells of CSV files: what stands in the cell, in which column and row.

use super::case::{Case, Said};
use super::good::{COLUMNS, csv, rows};

/// What is written, what the message must show, and what it must advise.
const TEXTS: &[(&str, &str, &str)] = &[
    ("broken", "\"broken\" is not a number", "correct the cell or delete the row"),
    ("O.25", "\"O.25\" is not a number", "correct the cell"),
    ("?", "\"?\" is not a number", "correct the cell"),
    ("1.5.2", "\"1.5.2\" is not a number", "correct the cell"),
    ("\"3,5\"", "\"3,5\" is not a number: it has a decimal comma", "write a decimal point"),
    ("1 234.5", "\"1 234.5\" is not a number", "separators between thousands"),
    ("1'234", "\"1'234\" is not a number", "separators between thousands"),
    ("1_000", "\"1_000\" is not a number", "separators between thousands"),
    ("\u{2212}1.5", "is not a number", "write the sign as a hyphen"),
    ("\u{ff11}\u{ff12}", "is not a number", "correct the cell"),
    ("\u{661}\u{662}", "is not a number", "correct the cell"),
    ("5 mm", "\"5 mm\" is not a number", "the unit belongs into the manifest"),
    ("12%", "\"12%\" is not a number", "the unit belongs into the manifest"),
    ("1.5d3", "\"1.5d3\" is not a number", "write the exponent with e"),
    ("2.5D-1", "\"2.5D-1\" is not a number", "write the exponent with e"),
    ("0x1F", "\"0x1F\" is not a number", "correct the cell"),
    ("1e", "\"1e\" is not a number", "correct the cell"),
    ("--1", "\"--1\" is not a number", "correct the cell"),
    ("TRUE", "\"TRUE\" is not a number", "correct the cell"),
    ("#REF!", "\"#REF!\" is not a number", "correct the cell"),
    ("=A1+1", "\"=A1+1\" is not a number", "correct the cell"),
    ("12:30", "\"12:30\" is not a number but a time of day", "write "),
    ("2026-11-21", "\"2026-11-21\" is not a number but a date", "write "),
    ("2026-11-21T09:30:00Z", "is not a number but a date", "write "),
    ("\u{202e}5", "is not a number", "correct the cell"),
    ("5\u{200b}", "is not a number", "correct the cell"),
    ("inf", "inf is not finite", "correct the cell"),
    ("-Infinity", "-Infinity is not finite", "correct the cell"),
    ("1e999", "1e999 is not finite", "correct the cell"),
    ("1e31", "1e31 is beyond", "correct the cell"),
    ("1e300", "1e300 is beyond", "correct the cell"),
    ("-1e200", "-1e200 is beyond", "correct the cell"),
];

/// Every text in every column, in rows at the beginning, in the middle and at the end.
pub fn all() -> Vec<Case> {
    let rows = [2, 31, 61];
    let mut cases = vec![];
    for (k, (text, shown, remedy)) in TEXTS.iter().enumerate() {
        for (j, column) in COLUMNS.iter().enumerate() {
            cases.push(cell(text, column, rows[(k + j) % 3], &[shown, remedy]));
        }
    }
    for column in ["t", "q", "h"] {
        for row in [2, 61] {
            for (text, shown) in
                [("", "the cell is empty"), ("  ", "the cell is empty"), ("NaN", "\"NaN\" is a missing value")]
            {
                cases.push(cell(text, column, row, &[shown, "fill it or delete the row"]));
            }
        }
    }
    for column in COLUMNS {
        for row in [3, 50] {
            cases.push(cell(b"3\xb0", column, row, &["not UTF-8", "save the file as CSV in UTF-8"]));
            cases.push(cell("3\0", column, row, &["zero byte", "copy it again"]));
        }
    }
    cases.push(cell("9x".repeat(100_000), "q", 31, &["\"9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x9x…\" is not a number"]));
    cases.push(cell(format!("\"{}\"", "a\nb".repeat(70_000)), "y", 31, &["is not a number"]));
    cases
}

fn cell(text: impl AsRef<[u8]>, column: &'static str, row: usize, words: &[&str]) -> Case {
    let text = text.as_ref().to_vec();
    let shown: String = String::from_utf8_lossy(&text).chars().take(20).collect();
    let said = Said::of(3, "run_b.csv", words).row(row).column(column);
    Case::new(format!("cell {shown:?} in column {column}, row {row}"), said, move |set| {
        let good = csv(&rows(1));
        let mut lines: Vec<&[u8]> = good.split('\n').map(str::as_bytes).collect();
        let mut cells: Vec<&[u8]> = lines[row - 1].split(|byte| *byte == b',').collect();
        cells[COLUMNS.iter().position(|c| *c == column).unwrap_or(0)] = &text;
        let line = cells.join(&b',');
        lines[row - 1] = &line;
        set.write("data/run_b.csv", lines.join(&b'\n'))
    })
}
