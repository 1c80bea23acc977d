//! Spoiled Parquet files: cells, types, pieces of files, and footers that claim what is not there.

use polars_core::prelude as polars;
use polars_io::prelude::ParquetWriter;

use super::case::{Case, Said};
use super::good::{COLUMNS, Set, csv, parquet, rows};
use super::parquet_bytes::Claims;

const FILE: &str = "data/run_p.parquet";

/// Every case.
pub fn all() -> Vec<Case> {
    [cells(), types(), pieces(), claims(), other_formats()].into_iter().flatten().collect()
}

fn case(name: &str, said: Said, spoil: impl Fn(&Set) -> std::io::Result<()> + 'static) -> Case {
    Case::new(format!("Parquet: {name}"), said, spoil)
}

fn said(words: &[&str]) -> Said {
    Said::of(3, "run_p.parquet", words)
}

fn bytes(bytes: impl Into<Vec<u8>>) -> impl Fn(&Set) -> std::io::Result<()> {
    let bytes = bytes.into();
    move |set| set.write(FILE, &bytes)
}

/// The file with its bytes changed.
fn edited(change: impl Fn(Vec<u8>) -> Vec<u8>) -> impl Fn(&Set) -> std::io::Result<()> {
    move |set| set.write(FILE, change(set.read(FILE)?))
}

/// The file with its rows changed.
fn changed(change: impl Fn(&mut Vec<[f64; 4]>)) -> impl Fn(&Set) -> std::io::Result<()> {
    move |set| {
        let mut rows = rows(4);
        change(&mut rows);
        parquet(&set.file(FILE), &rows);
        Ok(())
    }
}

/// The file with other values in column `j`.
fn with(j: usize, other: polars::Column) -> impl Fn(&Set) -> std::io::Result<()> {
    move |set| {
        let values = |i: usize| rows(4).iter().map(|row| row[i]).collect::<Vec<f64>>();
        let mut columns: Vec<_> = (0..4).map(|i| polars::Column::new(COLUMNS[i].into(), values(i))).collect();
        columns[j] = other.clone().with_name(COLUMNS[j].into());
        let mut frame = polars::DataFrame::new_infer_height(columns).map_err(std::io::Error::other)?;
        let file = std::fs::File::create(set.file(FILE))?;
        ParquetWriter::new(file).finish(&mut frame).map(|_| ()).map_err(std::io::Error::other)
    }
}

fn cells() -> Vec<Case> {
    let marker = "a lost marker is an empty cell";
    let mut cases = vec![];
    for (k, (value, shown)) in [
        (f64::INFINITY, "inf is not finite"),
        (f64::NEG_INFINITY, "-inf is not finite"),
        (1e300, "1e300 is beyond"),
        (-1e200, "-1e200 is beyond"),
    ]
    .into_iter()
    .enumerate()
    {
        for (j, column) in COLUMNS.iter().enumerate() {
            let row = [1, 30, 60][(j + k) % 3];
            let remedy = if value.is_infinite() && *column == "y" { marker } else { "correct the cell" };
            let said = said(&[shown, remedy]).row(row).column(column);
            let name = format!("{value} in column {column}, row {row}");
            cases.push(case(&name, said, changed(move |rows| rows[row - 1][j] = value)));
        }
    }
    for (j, column) in COLUMNS.iter().enumerate().take(3) {
        let said = said(&["the cell is empty", "fill it or delete the row"]).row(7).column(column);
        let values: Vec<Option<f64>> = (0..).zip(rows(4)).map(|(t, row)| (t != 6).then_some(row[j])).collect();
        cases.push(case(&format!("a null in column {column}"), said, with(j, polars::Column::new("".into(), values))));
    }
    let back = said(&["time goes back from"]).row(40).column("t");
    cases.push(case("time goes back", back, changed(|rows| rows[39][0] = 50.0)));
    let twice = said(&["repeats row 11"]).row(12).column("t");
    cases.push(case("a row twice", twice, changed(|rows| rows[11] = rows[10])));
    cases.push(case("no rows", said(&["no rows", "record it again"]), changed(Vec::clear)));
    cases
}

fn types() -> Vec<Case> {
    let float = "write the column as 64-bit floats";
    let mut cases = vec![];
    for (j, column) in COLUMNS.iter().enumerate() {
        let mut push = |what: &str, said: Said, spoil: Box<dyn Fn(&Set) -> std::io::Result<()>>| {
            cases.push(case(&format!("{what}, column {column}"), said.column(column), spoil));
        };
        let claims = |claims: Claims| Box::new(bytes(Claims { spoiled: vec![column], ..claims }.bytes()));
        let honest = || Claims::honest(&COLUMNS, 60);
        let other = |values| Box::new(with(j, values));
        let text = polars::Column::new("".into(), vec!["one"; 60]);
        push("text", said(&["\"one\" is not a number"]).row(1), other(text));
        let binary = polars::Column::new("".into(), vec![b"x".as_slice(); 60]);
        push("bytes", said(&["values of type binary are not numbers", float]), other(binary));
        push("a structure", said(&["are not numbers", float]), claims(Claims { children: 2, ..honest() }));
        let others: Vec<&'static str> = COLUMNS.into_iter().filter(|c| c != column).collect();
        push(
            "missing",
            said(&["is missing", "correct the name"]),
            Box::new(bytes(Claims::honest(&others, 60).bytes())),
        );
        let lzo = said(&["compressed with lzo", "write the file with zstd"]);
        push("a codec that is not known", lzo, claims(Claims { codec: 3, ..honest() }));
        let unknown = said(&["an unknown codec", "write the file with zstd"]);
        push("codec 99", unknown, claims(Claims { codec: 99, ..honest() }));
    }
    cases
}

fn pieces() -> Vec<Case> {
    let (again, beginning) = ("copy it again", "does not begin as");
    let off = || said(&["breaks off after", "truncated or damaged", again]);
    let mut cases = vec![];
    for part in 1..=12 {
        let first = edited(move |whole| whole[..whole.len() * part / 13].to_vec());
        cases.push(case(&format!("the first {part} of 13 parts"), off(), first));
    }
    cases.push(case("no bytes", said(&[beginning, again]), bytes("")));
    cases.push(case("eight bytes", said(&[beginning]), bytes("PAR1PAR1")));
    let other = edited(|whole| [b"PARX", &whole[4..]].concat());
    cases.push(case("another beginning", said(&[beginning]), other));
    let encrypted = edited(|whole| [&whole[..whole.len() - 4], b"PARE"].concat());
    cases.push(case("encrypted", off(), encrypted));
    for (what, size) in [("longer than the file", u32::MAX), ("of no bytes", 0), ("of one byte", 1)] {
        let resized = edited(move |mut whole| {
            let at = whole.len() - 8;
            whole[at..at + 4].copy_from_slice(&size.to_le_bytes());
            whole
        });
        cases.push(case(&format!("a footer {what}"), said(&["footer", again]), resized));
    }
    let endless = [b"PAR1".as_slice(), &[0x1c; 50_000], &50_000u32.to_le_bytes(), b"PAR1"].concat();
    cases.push(case("a footer of structures without end", said(&["footer", again]), bytes(endless)));
    cases
}

fn claims() -> Vec<Case> {
    let again = "copy it again";
    let honest = || Claims::honest(&COLUMNS, 60);
    let of = |name: &str, said: Said, claims: Claims| case(name, said, bytes(claims.bytes()));
    let repeated = || said(&["repeats row 1", "delete one"]).row(2).column("t");
    let (many, none) = (1_000_000_000_000, said(&["no number of rows", again]));
    let in_group = said(&["60 values in 1000000000000 rows", again]).column("t");
    let mut cases = vec![
        // in order but for the time, so that the other claims are known to be what is refused
        of("one value for all", repeated(), honest()),
        of("groups without rows", repeated(), Claims { groups: 40, ..honest() }),
        of(
            "10^12 rows in the footer",
            said(&["claims 1000000000000 rows", again]),
            Claims { footer_rows: many, ..honest() },
        ),
        of("10^12 rows in the group", in_group, Claims { footer_rows: many, group_rows: many, ..honest() }),
        of("fewer rows than there are", said(&["claims 59 rows", again]), Claims { footer_rows: 59, ..honest() }),
        of("less than no rows", none.clone(), Claims { footer_rows: -60, ..honest() }),
        of("less than no rows in the group", none, Claims { group_rows: -60, ..honest() }),
    ];
    for rows in [20_000_000i64, 2_000_000_000] {
        // 160 MB and 16 GB of numbers for each column, from a file of 500 bytes
        let said = said(&["claims", "rows or more", again]);
        cases.push(of(&format!("one value {rows} times"), said, Claims::honest(&COLUMNS, rows)));
    }
    let two_gigabytes = i64::from(i32::MAX) - 100;
    for (what, words, claims) in [
        ("more values than rows", "100 values in 60 rows", Claims { values: 100, ..honest() }),
        ("a page with more values", "pages have 100 values", Claims { page_values: 100, ..honest() }),
        ("a page with fewer values", "has no header", Claims { page_values: 10, ..honest() }),
        ("a page of 2 GB", "claim", Claims { more_decompressed: two_gigabytes, ..honest() }),
        ("a page of 2^61 bytes", "claim", Claims { more_decompressed: 1 << 61, ..honest() }),
        ("a page beyond its column", "would end at byte", Claims { more_compressed: 1000, ..honest() }),
        ("a page of less than no bytes", "is incomplete", Claims { more_compressed: -1000, ..honest() }),
        ("a column beyond the file", "would end at byte", Claims { longer: 1 << 40, ..honest() }),
        ("a column at another place", "would end at byte", Claims { offset: 1 << 50, ..honest() }),
        ("a column at a place before the file", "does not say where", Claims { offset: -100_000, ..honest() }),
    ] {
        for column in COLUMNS {
            let said = said(&[words, again]).column(column);
            let claims = Claims { spoiled: vec![column], ..claims.clone() };
            cases.push(of(&format!("{what}, column {column}"), said, claims));
        }
    }
    cases
}

fn other_formats() -> Vec<Case> {
    let of =
        |(what, contents): (&str, String)| case(what, said(&["does not begin as a Parquet file"]), bytes(contents));
    [
        ("a CSV file", csv(&rows(4))),
        ("a pointer of Git LFS", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 5\n".into()),
        ("a web page", "<!DOCTYPE html><html></html>".into()),
    ]
    .map(of)
    .into()
}
