//! Spoiled CSV files: their rows, their header, and files that are something else.

use super::case::{Case, Said};
use super::good::{COLUMNS, MANIFEST, Set, csv, rows};

/// Every case.
pub fn all() -> Vec<Case> {
    [rows_of_text(), time(), headers(), other_formats(), trials(), layers()].into_iter().flatten().collect()
}

fn file(text: impl Into<Vec<u8>>) -> impl Fn(&Set) -> std::io::Result<()> {
    let bytes = text.into();
    move |set| set.write("data/run_b.csv", &bytes)
}

/// The file with its rows changed.
fn changed(change: impl Fn(&mut [[f64; 4]])) -> impl Fn(&Set) -> std::io::Result<()> {
    let mut rows = rows(1);
    change(&mut rows);
    file(csv(&rows))
}

fn said(words: &[&str]) -> Said {
    Said::of(3, "run_b.csv", words)
}

/// What a row is replaced by, the column of the message, and its words.
const ROWS: &[(&str, &str, &[&str])] = &[
    ("1,2", "h", &["2 cells under 4 columns", "complete the row or delete it"]),
    ("1,2,3,4,5,6", "", &["6 cells under 4 columns", "cell 5 has no column"]),
    ("100,\"3.5,13.5,4", "q", &["a quotation mark is opened in column `q` and never closed", "close or delete it"]),
    ("100;3.5;13.5;4", "q", &["1 cells under 4 columns"]),
    ("100,3,5,13.5,4", "", &["5 cells under 4 columns"]),
    ("", "t", &["0 cells under 4 columns", "delete it"]),
];

fn rows_of_text() -> Vec<Case> {
    let good = csv(&rows(1));
    let mut cases = vec![];
    for (text, column, words) in ROWS {
        // blank rows at the end are no mistake
        for row in [2, 31, 61].into_iter().filter(|row| !(text.is_empty() && *row == 61)) {
            let mut lines: Vec<&str> = good.split('\n').collect();
            lines[row - 1] = text;
            let said = said(words).row(row).column(column);
            cases.push(Case::new(format!("row {row} is {text:?}"), said, file(lines.join("\n"))));
        }
    }
    let text = good.replacen("\n100,", "\n\"1\n00\",", 1);
    cases.push(Case::new("line end within quotes", said(&["is not a number"]).row(3).column("t"), file(text)));
    let text = good.replace('\n', ",\"two\nlines\"\n").replacen(",\"two\nlines\"", ",note", 1);
    let text = text.replacen("\n1000,", "\nlate,", 1);
    let late = said(&["\"late\""]).row(12).column("t");
    cases.push(Case::new("rows are counted as a spreadsheet counts them", late, file(text)));
    cases
}

fn time() -> Vec<Case> {
    let good = csv(&rows(1));
    let mut cases = vec![];
    for row in [12usize, 40] {
        let at = 100 * (row - 2);
        let seconds = |stamp: usize| stamp as f64 / 1000.0;
        let (before, back) = (seconds(at - 100), seconds(at - 150));
        for (stamp, problem, remedy) in [
            (at - 150, format!("time goes back from {before} s to {back} s"), "sort the file or split the trial"),
            (at - 100, format!("time stands still, duplicate time stamp {before} s"), "delete one of the two rows"),
        ] {
            let said = said(&[&problem, remedy]).row(row).column("t");
            let text = good.replacen(&format!("\n{at},"), &format!("\n{stamp},"), 1);
            cases.push(Case::new(format!("time {stamp} ms in row {row}"), said, file(text)));
        }
        let line = good.lines().nth(row - 1).unwrap_or_default().to_string() + "\n";
        let words = [&format!("repeats row {row}"), &format!("time {} s", seconds(at)), "delete one of them"];
        let twice = said(&words).row(row + 1).column("t");
        cases.push(Case::new(format!("row {row} twice"), twice, file(good.replacen(&line, &line.repeat(2), 1))));
    }
    let back = |row| said(&["time goes back from"]).row(row).column("t");
    cases.push(Case::new("negative time", back(12), changed(|rows| rows[10][0] = -5.0)));
    let begins_anew = changed(|rows| rows[30..].iter_mut().for_each(|row| row[0] -= 3000.0));
    cases.push(Case::new("a clock that begins anew", back(32), begins_anew));
    let alone = said(&["correct the time of row 12, which stands alone"]).row(13).column("t");
    cases.push(Case::new("a stamp far ahead", alone, changed(|rows| rows[10][0] = 1.7e12)));
    cases
}

fn headers() -> Vec<Case> {
    let good = csv(&rows(1));
    let mut cases = vec![];
    let header = |text: &str| file(good.replacen("t,q,h,y", text, 1));
    let gone =
        |column: &str, words: &[&str]| said(&[&["is missing", "correct the name"], words].concat()).column(column);
    for column in COLUMNS {
        let renamed = |name: &str| header(&COLUMNS.map(|c| if c == column { name } else { c }).join(","));
        let name = format!("column {column} is missing");
        cases.push(Case::new(name, gone(column, &["`other`"]), renamed("other")));
        let twice = good.replace('\n', ",1\n").replacen(",1", &format!(",{column}"), 1);
        let doubled = said(&["is there 2 times", "rename or delete the others"]).column(column);
        cases.push(Case::new(format!("column {column} twice"), doubled, file(twice)));
        let capital = column.to_uppercase();
        for (written, shown) in [
            (capital.clone(), capital),
            // a zero-width space, a soft hyphen, a turn to the left, an accent
            (format!("{column}\u{200b}"), format!("{column}\\u{{200b}}")),
            (format!("{column}\u{ad}"), format!("{column}\\u{{ad}}")),
            (format!("{column}\u{202e}"), format!("{column}\\u{{202e}}")),
            (format!("{column}\u{301}"), format!("{column}\\u{{301}}")),
        ] {
            let meant = format!("did you mean `{shown}`?");
            cases.push(Case::new(
                format!("column {column} as {written:?}"),
                gone(column, &[&meant]),
                renamed(&written),
            ));
        }
    }
    let body = good.split_once('\n').map_or("", |(_, body)| body).to_string();
    let many = (0..5000).map(|i| format!("column{i}")).collect::<Vec<_>>().join(",");
    let marked = gone("q", &["did you mean `\\u{feff}q`?"]);
    cases.extend([
        Case::new("no header", gone("q", &[]), file(body)),
        Case::new("a mark of order within the header", marked, header("t,\u{feff}q,h,y")),
        Case::new("5000 other columns", gone("q", &["and 4960 more"]), file(many + "\n1\n")),
        Case::new("a header of 200 kB", gone("q", &["…"]), file("z".repeat(200_000) + "\n1\n")),
    ]);
    cases
}

fn other_formats() -> Vec<Case> {
    let utf16: Vec<u8> = csv(&rows(1)).encode_utf16().flat_map(u16::to_le_bytes).collect();
    let again = ["no rows below its header", "delete it, or record it again"];
    let lfs = "version https://git-lfs.github.com/spec/v1\noid sha256:0\n";
    let first = |column, words: &[&str]| said(words).row(2).column(column);
    let first_cells = |cells: String| file(format!("t,q,h,y\n{cells}\n"));
    let size = ["5368709120 bytes are past the limit", "one file per trial"];
    let mut cases = vec![
        Case::new("UTF-16 without a mark", said(&["zero byte"]).row(1), file(utf16)),
        Case::new("empty file", said(&["the file is empty", "copy it again"]), file("")),
        Case::new("a header alone", said(&again), file("t,q,h,y\n")),
        Case::new("one line end", said(&["the file is empty"]), file("\n")),
        Case::new("a mark of order alone", said(&["the file is empty"]), file("\u{feff}")),
        Case::new("a pointer of Git LFS", said(&["Git LFS", "git lfs pull"]).row(1), file(lfs)),
        Case::new("JSON", said(&["is missing"]).column("q"), file("{\"t\": [0, 1]}\n")),
        Case::new("a line of a log", said(&["is missing"]).column("q"), file("[INFO] recording started\n")),
        Case::new(
            "200 kB of digits",
            first("q", &["is not a number"]),
            first_cells(format!("0,8x8{},1,1", "7".repeat(200_000))),
        ),
        Case::new("200 kB of separators", first("q", &["the cell is empty"]), first_cells(",".repeat(200_000))),
        Case::new("200 kB of quotation marks", first("t", &["is opened"]), first_cells("\"".repeat(200_001))),
        Case::new("a file of 5 GB without contents", said(&size), |set| {
            std::fs::File::create(set.file("data/run_b.csv"))?.set_len(5 << 30)
        }),
        Case::new("a spreadsheet", said(&["spreadsheet", "save the table as CSV"]).row(1), file(b"PK\x03\x04\x14\0")),
        Case::new("zstd", said(&["zstd", "decompress it"]).row(1), file([0x28, 0xb5, 0x2f, 0xfd, 0])),
        Case::new(
            "a web page",
            said(&["a web page", "download the table itself"]).row(1),
            file("<!DOCTYPE html><html>"),
        ),
    ];
    for (name, words) in [
        ("run_e.csv.xz", ["compressed with xz", "decompress it"]),
        ("run_e.csv.zst", ["compressed with zstd", "decompress it"]),
        ("run_e.csv.zip", ["compressed with zip", "decompress it"]),
        ("run_e.xlsx", ["neither .csv nor .parquet", "convert the file"]),
    ] {
        cases.push(Case::new(format!("a table named {name}"), Said::of(3, name, &words), move |set| {
            set.write(&format!("data/{name}"), "x")?;
            set.edit("data/manifest.toml", "\"run_*.csv\", \"run_*.parquet\"", "\"run_*\"")
        }));
    }
    cases
}

/// Files in order that do not make trials.
fn trials() -> Vec<Case> {
    let short = ["trial `b` has 1 samples", "fewer than 2", "record it longer", "exclude it"];
    let window = ["trial `b` has 31 samples", "fewer than 50 of a window", "shorter window"];
    let gap = ["trial `b` has 30 samples in one stretch without a gap over 0.5 s"];
    let role = ["manifest.toml", "trial `e` (run_e.csv) has no role", "[roles]"];
    let same =
        ["trials `a` (run_a.csv) and `c` (run_c.csv) hold the same values", "held-out trial `c`", "tests nothing"];
    let rest = ["trials `a` (run_a.csv) and `b` (run_b.csv) hold the same values; if one is a copy"];
    let names = ["200 of the 200 trials", "leave `trial` out of [table]", "rate_hz"];
    let lost =
        csv(&rows(1)).lines().skip(1).map(|l| l[..=l.rfind(',').unwrap_or(0)].to_string() + "\n").collect::<String>();
    vec![
        Case::new("one row", said(&short), file("t,q,h,y\n0,1,2,3\n")),
        Case::new("shorter than a window", said(&window), file(csv(&rows(1)[..31]))),
        Case::new("a gap", said(&gap), changed(|rows| rows[30..].iter_mut().for_each(|r| r[0] += 2000.0))),
        Case::new("every marker lost", said(&["trial `b` has 0 samples"]), file(format!("t,q,h,y\n{lost}"))),
        Case::new("a trial without a role", Said::of(3, "run_e.csv", &role), |set| {
            set.write("data/run_e.csv", csv(&rows(5)))
        }),
        Case::new("a name that looks like another", Said::of(3, "manifest.toml", &["has no role"]), |set| {
            set.write("data/run_a\u{301}.csv", csv(&rows(5)))
        }),
        Case::new(
            "a trial in two files",
            Said::of(3, "run_a2.csv", &["trial `a`", "run_a.csv", "different names"]),
            |set| {
                set.write("data/run_a2.csv", csv(&rows(9)))?;
                set.edit("data/manifest.toml", "run_(.*)", "run_(.).*")
            },
        ),
        Case::new("a trial and its copy", Said::of(0, "run_c.csv", &same), |set| {
            set.write("data/run_c.csv", csv(&rows(0)))
        }),
        Case::new("two trials at rest", Said::of(0, "run_b.csv", &rest), |set| {
            let rest = csv(&rows(0).iter().map(|row| [row[0], 3.0, 12.0, 40.0]).collect::<Vec<_>>());
            set.write("data/run_a.csv", &rest)?;
            set.write("data/run_b.csv", &rest)
        }),
        Case::new("a name for each row", Said::of(3, "poses.csv", &names).column("name"), |set| {
            let row = |i: usize| format!("p{i},{},{},12,{}\n", 100 * i, i % 7, 3 * i);
            set.write("data/poses.csv", "name,t,q,h,y\n".to_string() + &(0..200).map(row).collect::<String>())?;
            let names: String = (0..200).map(|i| format!("\"p{i}\", ")).collect();
            let text = MANIFEST.replace("run_*.csv", "poses.csv").replace("file = \"run_(.*)\"", "column = \"name\"");
            let text = text.replace("\"a\", \"b\"", &names).replace("\"c\"", "").replace("\"d\"", "");
            set.write("data/manifest.toml", text)
        }),
    ]
}

/// Many problems at once: none hides another.
fn layers() -> Vec<Case> {
    let of_each = [
        "9 problems",
        "run_a.csv, row 3, column `q`: \"x",
        "likewise row 5",
        "run_a.csv, row 6, column `q`: \"NaN\" is a missing value",
        "run_a.csv, row 6, column `t`: time stands still, duplicate time stamp 0.3 s",
        "time goes back from 0.85 s to 0.84 s",
        "run_b.csv, row 7",
        "run_e.csv: column `y` is missing",
        "run_e.csv, row 3, column `q`: \"x",
        "run_e.csv, row 12, column `t`: the row repeats row 11",
        "trial `e` (run_e.csv) has no role",
    ];
    let beside = ["2 problems", "column `h` is missing", "warning: ", "no pattern matches walk.csv"];
    vec![
        Case::new("several problems in three files", Said::of(3, "run_a.csv", &of_each), |set| {
            let text = csv(&rows(5)).replacen("t,q,h,y", "t,q,h,z", 1).replacen("\n100,", "\n100,x", 1);
            let line = text.lines().nth(10).unwrap_or_default().to_string() + "\n";
            set.write("data/run_e.csv", text.replacen(&line, &line.repeat(2), 1))?;
            set.edit("data/run_b.csv", "\n500,", "\n300,")?;
            set.edit("data/run_a.csv", "\n100,", "\n100,x")?;
            set.edit("data/run_a.csv", "\n300,", "\n300,x")?;
            set.edit("data/run_a.csv", "\n400,", "\n300,NaN,12.5,4\n400,")?;
            set.edit("data/run_a.csv", "\n900,", "\n850,1,12.5,4\n840,1,12.5,4\n900,")
        }),
        Case::new("a table that no pattern matches beside a missing column", said(&beside), |set| {
            set.write("data/walk.csv", "t\n")?;
            set.edit("data/run_b.csv", "t,q,h,y", "t,q,height,y")
        }),
    ]
}
