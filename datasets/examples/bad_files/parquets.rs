//! Spoiled Parquet files: cells, types, pieces of files, and footers that claim what is not there.

use acm_datasets::files::table::{Column, write_parquet};
use polars_core::prelude as polars;
use polars_io::prelude::ParquetWriter;

use super::case::{Case, Said};
use super::good::{COLUMNS, Set, csv, rows};
use super::parquet_bytes::Claims;

const FILE: &str = "data/run_p.parquet";

/// Every case.
pub fn all() -> Vec<Case> {
    [cells(), types(), pieces(), claims(), other_formats()].into_iter().flatten().collect()
}

fn case(name: &str, said: Said, spoil: impl Fn(&Set) -> std::io::Result<()> + 'static) -> Case {
    Case { name: format!("Parquet: {name}"), spoil: Box::new(spoil), said }
}

fn said(words: &[&str]) -> Said {
    Said::of(3, "run_p.parquet", words)
}

fn bytes(bytes: Vec<u8>) -> impl Fn(&Set) -> std::io::Result<()> {
    move |set| set.write(FILE, &bytes)
}

fn columns(rows: &[[f64; 4]]) -> Vec<(String, Column)> {
    let column = |i: usize| Column::Number(rows.iter().map(|r| r[i]).collect());
    COLUMNS.iter().enumerate().map(|(i, name)| (name.to_string(), column(i))).collect()
}

fn write(set: &Set, columns: &[(String, Column)]) -> std::io::Result<()> {
    write_parquet(&set.file(FILE), columns).map_err(std::io::Error::other)
}

fn cells() -> Vec<Case> {
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
        // NaN of an output is a lost marker
        for (j, column) in COLUMNS.iter().enumerate().filter(|(_, column)| !value.is_nan() || **column != "y") {
            let row = [1, 30, 60][(j + k) % 3];
            let said = said(&[shown, "correct the cell"]).row(row).column(column);
            cases.push(case(&format!("{value} in column {column}, row {row}"), said, move |set| {
                let mut rows = rows(4);
                rows[row - 1][j] = value;
                write(set, &columns(&rows))
            }));
        }
    }
    for (j, column) in COLUMNS.iter().enumerate().take(3) {
        let said = said(&["the cell is empty", "fill it or delete the row"]).row(7).column(column);
        cases.push(case(&format!("a null in column {column}"), said, move |set| {
            let values = |i: usize| -> Vec<Option<f64>> {
                rows(4).iter().enumerate().map(|(t, r)| (i != j || t != 6).then_some(r[i])).collect()
            };
            let columns = COLUMNS.iter().enumerate().map(|(i, n)| polars::Column::new((*n).into(), values(i)));
            frame(set, columns.collect())
        }));
    }
    let back = said(&["time goes back from"]).row(40).column("t");
    cases.push(case("time goes back", back, |set| {
        let mut rows = rows(4);
        rows[39][0] = 50.0;
        write(set, &columns(&rows))
    }));
    let twice = said(&["repeats row 11"]).row(12).column("t");
    cases.push(case("a row twice", twice, |set| {
        let mut rows = rows(4);
        rows[11] = rows[10];
        write(set, &columns(&rows))
    }));
    cases
}

/// Columns that are no numbers, through the usual writer.
fn frame(set: &Set, columns: Vec<polars::Column>) -> std::io::Result<()> {
    let mut frame = polars::DataFrame::new_infer_height(columns).map_err(std::io::Error::other)?;
    let file = std::fs::File::create(set.file(FILE))?;
    ParquetWriter::new(file).finish(&mut frame).map(|_| ()).map_err(std::io::Error::other)
}

fn types() -> Vec<Case> {
    let mut cases = vec![];
    for (j, column) in COLUMNS.iter().enumerate() {
        let with = move |other: fn(Vec<f64>) -> polars::Column| {
            move |set: &Set| {
                let column = |i: usize| {
                    let values: Vec<f64> = rows(4).iter().map(|r| r[i]).collect();
                    let mut column = if i == j { other(values) } else { polars::Column::new("".into(), values) };
                    column.rename(COLUMNS[i].into());
                    column
                };
                frame(set, (0..4).map(column).collect())
            }
        };
        let text = said(&["\"one\" is not a number"]).row(1).column(column);
        cases.push(case(
            &format!("text in column {column}"),
            text,
            with(|values| polars::Column::new("".into(), vec!["one"; values.len()])),
        ));
        let binary =
            said(&["values of type binary are not numbers", "write the column as 64-bit floats"]).column(column);
        cases.push(case(
            &format!("bytes in column {column}"),
            binary,
            with(|values| polars::Column::new("".into(), vec![b"x".as_slice(); values.len()])),
        ));
        let nested = said(&["are not numbers", "write the column as 64-bit floats"]).column(column);
        let claims = Claims { spoiled: vec![column], children: 2, ..Claims::honest(&COLUMNS, 60) };
        cases.push(case(&format!("a structure as column {column}"), nested, bytes(claims.bytes())));
        let others: Vec<&'static str> = COLUMNS.into_iter().filter(|c| c != column).collect();
        let missing = said(&["is missing", "correct the name"]).column(column);
        cases.push(case(&format!("column {column} is missing"), missing, bytes(Claims::honest(&others, 60).bytes())));
        let codec = said(&["compressed with lzo", "write the file with zstd"]).column(column);
        let claims = Claims { spoiled: vec![column], codec: 3, ..Claims::honest(&COLUMNS, 60) };
        cases.push(case(&format!("a codec that is not known, column {column}"), codec, bytes(claims.bytes())));
    }
    let unknown = said(&["an unknown codec", "write the file with zstd"]).column("y");
    let claims = Claims { spoiled: vec!["y"], codec: 99, ..Claims::honest(&COLUMNS, 60) };
    cases.push(case("codec 99", unknown, bytes(claims.bytes())));
    cases
}

fn pieces() -> Vec<Case> {
    let mut cases = vec![];
    for part in 1..=12 {
        let name = format!("the first {part} of 13 parts");
        cases.push(case(&name, said(&["breaks off after", "copy it again"]), move |set| {
            let whole = set.read(FILE)?;
            set.write(FILE, &whole[..whole.len() * part / 13])
        }));
    }
    cases.push(case("no bytes", said(&["does not begin as", "copy it again"]), bytes(vec![])));
    cases.push(case("eight bytes", said(&["does not begin as"]), bytes(b"PAR1PAR1".to_vec())));
    cases.push(case("another beginning", said(&["does not begin as"]), |set| {
        let whole = set.read(FILE)?;
        set.write(FILE, [b"PARX", &whole[4..]].concat())
    }));
    cases.push(case("encrypted", said(&["breaks off after", "copy it again"]), |set| {
        let whole = set.read(FILE)?;
        set.write(FILE, [&whole[..whole.len() - 4], b"PARE"].concat())
    }));
    for (what, size) in [("longer than the file", u32::MAX), ("of no bytes", 0), ("of one byte", 1)] {
        cases.push(case(&format!("a footer {what}"), said(&["footer", "copy it again"]), move |set| {
            let mut whole = set.read(FILE)?;
            let at = whole.len() - 8;
            whole[at..at + 4].copy_from_slice(&size.to_le_bytes());
            set.write(FILE, whole)
        }));
    }
    cases.push(case("a footer of structures without end", said(&["footer", "copy it again"]), |set| {
        let footer = vec![0x1c; 50_000];
        let size = (footer.len() as u32).to_le_bytes();
        set.write(FILE, [b"PAR1".as_slice(), &footer, &size, b"PAR1"].concat())
    }));
    cases
}

fn claims() -> Vec<Case> {
    let honest = |rows| Claims::honest(&COLUMNS, rows);
    let again = "copy it again";
    let mut cases = vec![
        // in order but for the time, so that the other claims are known to be what is refused
        case("one value for all", said(&["repeats row 1", "delete one"]).row(2).column("t"), |set| {
            set.write(FILE, Claims { groups: 1, ..Claims::honest(&COLUMNS, 60) }.bytes())
        }),
        case("groups without rows", said(&["repeats row 1", "delete one"]).row(2).column("t"), |set| {
            set.write(FILE, Claims { groups: 40, ..Claims::honest(&COLUMNS, 60) }.bytes())
        }),
        case("no rows", said(&["no rows", "record it again"]), |set| write(set, &columns(&[]))),
        case("10^12 rows in the footer", said(&["claims 1000000000000 rows", again]), {
            bytes(Claims { footer_rows: 1_000_000_000_000, ..honest(60) }.bytes())
        }),
        case("10^12 rows in the group", said(&["60 values in 1000000000000 rows", again]).column("t"), {
            bytes(Claims { footer_rows: 1_000_000_000_000, group_rows: 1_000_000_000_000, ..honest(60) }.bytes())
        }),
        case(
            "fewer rows than there are",
            said(&["claims 59 rows", again]),
            bytes(Claims { footer_rows: 59, ..honest(60) }.bytes()),
        ),
        case(
            "less than no rows",
            said(&["no number of rows", again]),
            bytes(Claims { footer_rows: -60, ..honest(60) }.bytes()),
        ),
        case(
            "less than no rows in the group",
            said(&["no number of rows", again]),
            bytes(Claims { group_rows: -60, ..honest(60) }.bytes()),
        ),
    ];
    for rows in [20_000_000i64, 2_000_000_000] {
        // 160 MB and 16 GB of numbers for each column, from a file of 500 bytes
        cases.push(case(
            &format!("one value {rows} times"),
            said(&["claims", "rows or more", again]),
            bytes(honest(rows).bytes()),
        ));
    }
    for column in COLUMNS {
        let of = |claims: Claims| Claims { spoiled: vec![column], ..claims };
        let mut spoiled = |what: &str, words: &[&str], claims: Claims| {
            let words: Vec<&str> = words.iter().copied().chain([again]).collect();
            let name = format!("{what}, column {column}");
            cases.push(case(&name, said(&words).column(column), bytes(of(claims).bytes())));
        };
        spoiled("more values than rows", &["100 values in 60 rows"], Claims { values: 100, ..honest(60) });
        spoiled("a page with more values", &["pages have 100 values"], Claims { page_values: 100, ..honest(60) });
        spoiled("a page with fewer values", &["has no header"], Claims { page_values: 10, ..honest(60) });
        spoiled("a page of 2 GB", &["claim"], Claims { more_decompressed: i64::from(i32::MAX) - 100, ..honest(60) });
        spoiled("a page of 2^61 bytes", &["claim"], Claims { more_decompressed: 1 << 61, ..honest(60) });
        spoiled("a page beyond its column", &["would end at byte"], Claims { more_compressed: 1000, ..honest(60) });
        spoiled("a page of less than no bytes", &["is incomplete"], Claims { more_compressed: -1000, ..honest(60) });
        spoiled("a column beyond the file", &["would end at byte"], Claims { longer: 1 << 40, ..honest(60) });
        spoiled("a column at another place", &["would end at byte"], Claims { offset: 1 << 50, ..honest(60) });
        spoiled(
            "a column at a place before the file",
            &["does not say where"],
            Claims { offset: -100_000, ..honest(60) },
        );
    }
    cases
}

fn other_formats() -> Vec<Case> {
    let mut cases = vec![];
    for (what, contents) in [
        ("a CSV file", csv(&rows(4)).into_bytes()),
        ("a pointer of Git LFS", b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 5\n".to_vec()),
        ("a web page", b"<!DOCTYPE html><html></html>".to_vec()),
    ] {
        let name = format!("{what} under the name of a Parquet file");
        cases.push(case(&name, said(&["does not begin as a Parquet file"]), bytes(contents)));
    }
    cases
}
