//! Spoiled CSV files: their rows, their header, their encoding, and files that are something else.

use super::case::{Case, Said};
use super::good::{COLUMNS, Set, csv, rows};

/// Every case.
pub fn all() -> Vec<Case> {
    [rows_of_text(), time(), headers(), encodings(), other_formats(), trials()].into_iter().flatten().collect()
}

fn case(name: &str, said: Said, spoil: impl Fn(&Set) -> std::io::Result<()> + 'static) -> Case {
    Case { name: name.into(), spoil: Box::new(spoil), said }
}

/// The file with one line replaced.
fn line(row: usize, text: &'static str) -> impl Fn(&Set) -> std::io::Result<()> {
    move |set| {
        let file = csv(&rows(1));
        let lines = file.lines().enumerate().map(|(i, line)| if i + 1 == row { text } else { line });
        set.write("data/run_b.csv", lines.map(|line| format!("{line}\n")).collect::<String>())
    }
}

fn file(text: impl Into<Vec<u8>>) -> impl Fn(&Set) -> std::io::Result<()> {
    let bytes = text.into();
    move |set| set.write("data/run_b.csv", &bytes)
}

fn said(words: &[&str]) -> Said {
    Said::of(3, "run_b.csv", words)
}

fn rows_of_text() -> Vec<Case> {
    let mut cases = vec![];
    for row in [2, 31, 61] {
        let short = said(&["2 cells under 4 columns", "complete the row or delete it"]).row(row).column("h");
        cases.push(case(&format!("short row {row}"), short, line(row, "1,2")));
        let long = said(&["6 cells under 4 columns", "cell 5 has no column"]).row(row);
        cases.push(case(&format!("long row {row}"), long, line(row, "1,2,3,4,5,6")));
        let quote = said(&["a quotation mark is opened", "close or delete it"]).row(row).column("q");
        cases.push(case(&format!("open quotation mark in row {row}"), quote, line(row, "100,\"3.5,13.5,4")));
        let semicolons = said(&["1 cells under 4 columns"]).row(row).column("q");
        cases.push(case(&format!("semicolons in row {row}"), semicolons, line(row, "100;3.5;13.5;4")));
        let comma = said(&["5 cells under 4 columns"]).row(row);
        cases.push(case(&format!("bare decimal comma in row {row}"), comma, line(row, "100,3,5,13.5,4")));
    }
    for row in [2, 31] {
        cases.push(case(
            &format!("blank row {row}"),
            said(&["0 cells under 4 columns"]).row(row).column("t"),
            line(row, ""),
        ));
    }
    let text = csv(&rows(1)).replacen("\n100,", "\n\"1\n00\",", 1);
    cases.push(case("line end within quotes", said(&["is not a number"]).row(3).column("t"), file(text)));
    let text = "t,q,h,y,note\n".to_string()
        + &csv(&rows(1)).lines().skip(1).map(|l| format!("{l},\"two\nlines\"\n")).collect::<String>();
    let text = text.replacen("\n1000,", "\nlate,", 1);
    cases.push(case(
        "rows are counted as a spreadsheet counts them",
        said(&["\"late\""]).row(12).column("t"),
        file(text),
    ));
    cases
}

fn time() -> Vec<Case> {
    let mut cases = vec![];
    for row in [12usize, 40] {
        let (before, at) = (100 * (row - 3), 100 * (row - 2));
        let with = move |stamp: String| {
            move |set: &Set| {
                let text = csv(&rows(1)).replacen(&format!("\n{at},"), &format!("\n{stamp},"), 1);
                set.write("data/run_b.csv", text)
            }
        };
        let back = said(&["time goes back from", "sort the file or split the trial"]).row(row).column("t");
        cases.push(case(&format!("time goes back in row {row}"), back, with((before - 50).to_string())));
        let still =
            said(&["time stands still, duplicate time stamp", "delete one of the two rows"]).row(row).column("t");
        cases.push(case(&format!("time stands still in row {row}"), still, with(before.to_string())));
        let negative = said(&["time goes back from"]).row(row).column("t");
        cases.push(case(&format!("negative time in row {row}"), negative, with("-5".into())));
        let repeated = said(&["repeats row", "delete one of them"]).row(row + 1).column("t");
        cases.push(case(&format!("row {row} twice"), repeated, move |set| {
            let text = csv(&rows(1));
            let line = text.lines().nth(row - 1).unwrap_or_default().to_string() + "\n";
            set.write("data/run_b.csv", text.replacen(&line, &line.repeat(2), 1))
        }));
    }
    let wraps = said(&["time goes back from"]).row(32).column("t");
    cases.push(case("a clock that begins anew", wraps, |set| {
        let mut rows = rows(1);
        rows[30..].iter_mut().for_each(|row| row[0] -= 3000.0);
        set.write("data/run_b.csv", csv(&rows))
    }));
    cases
}

fn headers() -> Vec<Case> {
    let mut cases = vec![];
    let header = |text: &str| file(csv(&rows(1)).replacen("t,q,h,y", text, 1));
    let gone = |column: &str, words: &[&str]| {
        let words: Vec<&str> = ["is missing", "correct the name"].iter().chain(words).copied().collect();
        said(&words).column(column)
    };
    for column in COLUMNS {
        let other = COLUMNS.map(|c| if c == column { "other" } else { c }).join(",");
        cases.push(case(&format!("column {column} is missing"), gone(column, &["`other`"]), header(&other)));
        let large = COLUMNS.map(|c| if c == column { c.to_uppercase() } else { c.into() }).join(",");
        let meant = format!("did you mean `{}`?", column.to_uppercase());
        cases.push(case(&format!("column {column} in capitals"), gone(column, &[&meant]), header(&large)));
        let twice = format!("{},{column}", COLUMNS.join(","));
        let text = csv(&rows(1)).replacen("t,q,h,y", &twice, 1);
        let text: String =
            text.lines().map(|l| if l.starts_with('t') { format!("{l}\n") } else { format!("{l},1\n") }).collect();
        let doubled = said(&["is there 2 times", "rename or delete the others"]).column(column);
        cases.push(case(&format!("column {column} twice"), doubled, file(text)));
        for (what, mark, shown) in [
            ("a zero-width space", "\u{200b}", "\\u{200b}"),
            ("a soft hyphen", "\u{ad}", "\\u{ad}"),
            ("a turn to the left", "\u{202e}", "\\u{202e}"),
            ("an accent", "\u{301}", "\\u{301}"),
        ] {
            let marked = COLUMNS.map(|c| if c == column { format!("{c}{mark}") } else { c.into() }).join(",");
            let meant = format!("did you mean `{column}{shown}`?");
            cases.push(case(
                &format!("{what} in the name of column {column}"),
                gone(column, &[&meant]),
                header(&marked),
            ));
        }
    }
    cases.push(case("no header", gone("q", &["is missing"]), |set| {
        set.write("data/run_b.csv", csv(&rows(1)).split_once('\n').map_or("", |(_, body)| body))
    }));
    cases.push(case(
        "a mark of order within the header",
        gone("q", &["did you mean `\\u{feff}q`?"]),
        header("t,\u{feff}q,h,y"),
    ));
    let many = (0..5000).map(|i| format!("column{i}")).collect::<Vec<_>>().join(",");
    cases.push(case("5000 other columns", gone("q", &["and 4960 more"]), file(many + "\n1\n")));
    cases.push(case("a header of 200 kB", gone("q", &["…"]), file("z".repeat(200_000) + "\n1\n")));
    cases
}

fn encodings() -> Vec<Case> {
    let good = csv(&rows(1));
    let utf16: Vec<u8> = good.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let utf8 = "save the file as CSV in UTF-8";
    let mut cases = vec![case("UTF-16 without a mark", said(&["zero byte"]).row(1), file(utf16))];
    for (j, column) in COLUMNS.iter().enumerate() {
        for row in [3usize, 50] {
            let spoiled = |byte: u8| -> Vec<u8> {
                let lines = good.lines().enumerate().map(|(i, line)| {
                    let mut cells: Vec<Vec<u8>> = line.split(',').map(|c| c.as_bytes().to_vec()).collect();
                    if i + 1 == row {
                        cells[j].push(byte);
                    }
                    [cells.join(&b','), b"\n".to_vec()].concat()
                });
                lines.collect::<Vec<_>>().concat()
            };
            let latin = said(&["not UTF-8", utf8]).row(row).column(column);
            cases.push(case(&format!("Latin-1 in column {column}, row {row}"), latin, file(spoiled(0xb0))));
            let zero = said(&["zero byte", "copy it again"]).row(row).column(column);
            cases.push(case(&format!("zero byte in column {column}, row {row}"), zero, file(spoiled(0))));
        }
    }
    cases
}

fn other_formats() -> Vec<Case> {
    let mut cases = vec![
        case("empty file", said(&["the file is empty", "copy it again"]), file("")),
        case("a header alone", said(&["no rows below its header"]), file("t,q,h,y\n")),
        case("one line end", said(&["the file is empty"]), file("\n")),
        case("a mark of order alone", said(&["the file is empty"]), file("\u{feff}")),
        case(
            "a pointer of Git LFS",
            said(&["Git LFS", "git lfs pull"]).row(1),
            file("version https://git-lfs.github.com/spec/v1\noid sha256:0\n"),
        ),
        case("JSON", said(&["is missing"]).column("q"), file("{\"t\": [0, 1]}\n")),
        case("a line of a program's log", said(&["is missing"]).column("q"), file("[INFO] recording started\n")),
        case(
            "a line of 200 kB",
            said(&["is not a number"]).row(2).column("q"),
            file(format!("t,q,h,y\n0,{},1,1\n", "8x8".to_string() + &"7".repeat(200_000) + "x")),
        ),
        case(
            "200 kB of separators",
            said(&["the cell is empty"]).row(2).column("q"),
            file(format!("t,q,h,y\n{}\n", ",".repeat(200_000))),
        ),
        case(
            "200 kB of quotation marks",
            said(&["is opened"]).row(2).column("t"),
            file(format!("t,q,h,y\n{}\n", "\"".repeat(200_001))),
        ),
        case("a file of 5 GB without contents", said(&["are past the limit", "one file per trial"]), |set| {
            std::fs::File::create(set.file("data/run_b.csv"))?.set_len(5 << 30)
        }),
    ];
    for (ending, how) in [("xz", "xz"), ("zst", "zstd"), ("zip", "zip")] {
        let named = Said::of(3, &format!("run_b.csv.{ending}"), &["compressed with", how, "decompress it"]);
        cases.push(case(&format!("a table with the ending .{ending}"), named, move |set| {
            std::fs::rename(set.file("data/run_b.csv"), set.file(&format!("data/run_b.csv.{ending}")))?;
            let manifest = String::from_utf8_lossy(&set.read("data/manifest.toml")?).into_owned();
            set.write("data/manifest.toml", manifest.replace("\"run_*.csv\"", "\"run_*.csv*\""))
        }));
    }
    for (what, start, words) in [
        ("a spreadsheet", &b"PK\x03\x04\x14\0"[..], &["spreadsheet", "save the table as CSV"][..]),
        ("zstd", &[0x28, 0xb5, 0x2f, 0xfd, 0], &["zstd", "decompress it"]),
        ("a web page", b"<!DOCTYPE html><html>", &["a web page", "download the table itself"]),
    ] {
        cases.push(case(&format!("{what} under the name of a CSV file"), said(words).row(1), file(start.to_vec())));
    }
    cases
}

/// Files in order that do not make trials.
fn trials() -> Vec<Case> {
    let few = |words: &[&str]| said(words);
    vec![
        case(
            "one row",
            few(&["trial `b` has 1 samples", "fewer than 2", "record it longer"]),
            file("t,q,h,y\n0,1,2,3\n"),
        ),
        case("shorter than a window", few(&["31 samples", "fewer than 50 of a window"]), file(csv(&rows(1)[..31]))),
        case("a gap", few(&["30 samples", "without a gap over 0.5 s"]), |set| {
            let mut rows = rows(1);
            rows[30..].iter_mut().for_each(|r| r[0] += 2000.0);
            set.write("data/run_b.csv", csv(&rows))
        }),
        case("every marker lost", few(&["trial `b` has 0 samples"]), |set| {
            let rows = rows(1);
            let lines = rows.iter().map(|r| format!("{},{},{},\n", r[0], r[1], r[2]));
            set.write("data/run_b.csv", "t,q,h,y\n".to_string() + &lines.collect::<String>())
        }),
        case("a trial without a role", Said::of(3, "run_e.csv", &["has no role", "[roles]"]), |set| {
            set.write("data/run_e.csv", csv(&rows(5)))
        }),
        case("a name that looks like another", Said::of(3, "manifest.toml", &["has no role"]), |set| {
            set.write("data/run_a\u{301}.csv", csv(&rows(5)))
        }),
    ]
}
