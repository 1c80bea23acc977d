//! The tables: how each differs from `t,q,y`, and what is to become of it.

use std::io::Write;

use flate2::Compression;
use flate2::write::GzEncoder;

/// What is to become of a table.
pub enum Wanted {
    /// Read, with these of the four rows.
    Right(&'static [usize]),
    /// Refused, with these words.
    Refused(&'static [&'static str]),
}

/// One table.
pub struct Case {
    pub name: &'static str,
    pub bytes: Vec<u8>,
    /// Further keys of `[[source]]` or `[table]`.
    pub keys: &'static str,
    pub wanted: Wanted,
}

use Wanted::{Refused, Right};

const ALL: &[usize] = &[0, 1, 2, 3];
pub const PLAIN: &str = "t,q,y\n0,0.5,10\n0.1,0.25,20\n0.2,1.5,30\n0.3,-2,40\n";

fn case(name: &'static str, bytes: impl Into<Vec<u8>>, wanted: Wanted) -> Case {
    Case { name, bytes: bytes.into(), keys: "", wanted }
}

/// Read.
fn right(name: &'static str, bytes: impl Into<Vec<u8>>) -> Case {
    case(name, bytes, Right(ALL))
}

/// Refused with these words.
fn refused(name: &'static str, bytes: impl Into<Vec<u8>>, parts: &'static [&'static str]) -> Case {
    case(name, bytes, Refused(parts))
}

fn wide(text: &str, mark: [u8; 2], of: fn(u16) -> [u8; 2]) -> Vec<u8> {
    mark.into_iter().chain(text.encode_utf16().flat_map(of)).collect()
}

fn gzip(text: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(text).and_then(|()| encoder.finish()).unwrap_or_default()
}

fn with(from: &str, to: &str) -> String {
    assert!(PLAIN.contains(from), "{from:?}");
    PLAIN.replacen(from, to, 1)
}

/// Another separator, and another sign before the fraction.
fn other(text: &str, separator: char, decimal: char) -> String {
    text.replace(',', "\u{1}").replace('.', &decimal.to_string()).replace('\u{1}', &separator.to_string())
}

pub fn all() -> Vec<Case> {
    [encodings(), separators(), headers(), cells(), missing(), times(), rows()].into_iter().flatten().collect()
}

fn encodings() -> Vec<Case> {
    let packed = gzip(PLAIN.as_bytes());
    vec![
        right("plain", PLAIN),
        right("mark of order", format!("\u{feff}{PLAIN}")),
        right("carriage returns", PLAIN.replace('\n', "\r\n")),
        right("lone carriage returns", PLAIN.replace('\n', "\r")),
        right("no line end at the end", PLAIN.trim_end()),
        right("empty lines at the end", format!("{PLAIN}\n\r\n\n")),
        right("UTF-16, little", wide(PLAIN, [0xff, 0xfe], u16::to_le_bytes)),
        right("UTF-16, big", wide(PLAIN, [0xfe, 0xff], u16::to_be_bytes)),
        right("gzip", packed.clone()),
        refused("gzip that is cut off", packed[..packed.len() - 9].to_vec(), &["gzip", "cannot be decompressed"]),
        right("gzip of UTF-16", gzip(&wide(PLAIN, [0xff, 0xfe], u16::to_le_bytes))),
        refused("a zero byte", with("0.25", "0.2\0"), &["row 3", "zero byte"]),
        refused("an empty file", "", &["empty"]),
    ]
}

fn separators() -> Vec<Case> {
    let with_keys = |case: Case, keys: &'static str| Case { keys, ..case };
    let thousands = "t,q,y\n0,0.5,\"10\"\n0.1,0.25,\"20\"\n0.2,1.5,\"30.000\"\n0.3,-2,40\n";
    vec![
        right("semicolons", other(PLAIN, ';', '.')),
        right("tabs", other(PLAIN, '\t', '.')),
        right("bars", other(PLAIN, '|', '.')),
        right("blanks", other(PLAIN, ' ', '.')),
        right("several blanks", PLAIN.replace(',', "   ")),
        right("blanks and a comment sign before the header", format!("# {}", other(PLAIN, ' ', '.'))),
        right("semicolons and decimal commas", other(PLAIN, ';', ',')),
        right("tabs and decimal commas", other(PLAIN, '\t', ',')),
        with_keys(right("semicolons that the manifest gives", other(PLAIN, ';', '.')), "separator = \";\"\n"),
        with_keys(
            right("decimal commas that the manifest gives", other(PLAIN, ';', ',')),
            "separator = \";\"\ndecimal = \",\"\n",
        ),
        refused(
            "decimal commas in a table with commas",
            "t,q,y\n0,0,5,10\n0.1,0,25,20\n",
            &["row 2", "3 columns", "4 cells"],
        ),
        refused("three digits behind a comma", "t;q;y\n0;1,234;10\n1;2,500;20\n", &["row 2", "1,234", "decimal = "]),
        refused(
            "three digits behind a point, beside whole numbers",
            "t;q;y\n0;1;12.345\n1;2;13.456\n",
            &["row 2", "12.345", "decimal = "],
        ),
        right("three digits behind a point between commas", thousands),
        with_keys(
            right(
                "thousands in groups that the manifest gives",
                "t,q,y\n0,0.5,10\n0.1,0.25,20\n0.2,1.5,30\n0.3,-2,\"0,040\"\n",
            ),
            "decimal = \".\"\n",
        ),
        refused(
            "thousands with points and decimal commas",
            "t;q;y\n0;1.234,5;10\n1;0,5;20\n",
            &["row 2", "column `q`", "1.234,5"],
        ),
        refused(
            "points and decimal commas in one file",
            "t;q;y\n0;1.234;10\n1;0,5;20\n",
            &["row 2", "1.234", "decimal"],
        ),
        refused("a header with semicolons above commas", PLAIN.replacen("t,q,y", "t;q;y", 1), &["row 2"]),
        refused("two separators that both fit", "t,a;q,y\n0,1;2,3\n1,1;2,3\n", &["row 1", "separator = "]),
        right("a first row that names the separator", format!("sep=;\n{}", other(PLAIN, ';', '.'))),
        right(
            "a first row in capitals and quotes that names it",
            format!("\u{feff}\"SEP=;\"\n{}", other(PLAIN, ';', ',')),
        ),
    ]
}

fn headers() -> Vec<Case> {
    vec![
        right("quotes in the header", with("t,q,y", "\"t\",\"q\",\"y\"")),
        right("blanks in the header", with("t,q,y", " t , q, y ")),
        right("columns in another order", "y,t,q\n10,0,0.5\n20,0.1,0.25\n30,0.2,1.5\n40,0.3,-2\n"),
        right(
            "columns that nobody asked for",
            "t,note,q,y,note\n0,a,0.5,10,b\n0.1,,0.25,20,b\n0.2,c,1.5,30,\n0.3,d,-2,40,b\n",
        ),
        right(
            "commas in quotes of other columns",
            "t,q,y,\"a,b\"\n0,0.5,10,\"x,y\"\n0.1,0.25,20,x\n0.2,1.5,30,\"\"\n0.3,-2,40,\"1,5\"\n",
        ),
        right("a separator behind every row", PLAIN.replace('\n', ",\n")),
        right("a separator behind every row but the header", PLAIN.replace('\n', ",\n").replacen("y,", "y", 1)),
        right(
            "all that a spreadsheet writes",
            "\u{feff}\"t\",q, y ,note,note\r\n\"0\", 0.5 ,10,\"a, b\",x\r\n0.1,0.25,20,,\r\n0.2,1.5,30,,\r\n0.3,-2,40,\"a\",x",
        ),
        right("a row of units", with("t,q,y\n", "t,q,y\n[s],[rad],[mm]\n")),
        right("a row of units without brackets", with("t,q,y\n", "t,q,y\ns,rad,mm\n")),
        refused(
            "a row of other units",
            with("t,q,y\n", "t,q,y\ns,rad,m\n"),
            &["column `y`", "\"m\"", "\"mm\"", "correct the unit"],
        ),
        refused("a row with another unit of time", with("t,q,y\n", "t,q,y\nms,rad,mm\n"), &["column `t`", "\"ms\""]),
        refused("two rows of units", with("t,q,y\n", "t,q,y\ns,rad,mm\ns,rad,mm\n"), &["row"]),
        refused("units in the header", with("t,q,y", "t [s],q [rad],y [mm]"), &["column `q` is missing", "q [rad]"]),
        refused("a missing column", with("t,q,y", "t,p,y"), &["column `q` is missing", "`p`"]),
        right("a comment above the header", format!("# recorded on Monday\n{PLAIN}")),
        right("keys and values above the header", format!("Operator,Ann\nRig,2\n\n{PLAIN}")),
        right(
            "doubled quotes in a header",
            "t,q,y,\"a \"\"b\"\"\"\n0,0.5,10,1\n0.1,0.25,20,1\n0.2,1.5,30,1\n0.3,-2,40,1\n",
        ),
        refused("the header again in the middle", with("0.2,", "t,q,y\n0.2,"), &["row 4"]),
    ]
}

fn cells() -> Vec<Case> {
    vec![
        right("blanks around numbers", PLAIN.replace(',', " , ")),
        right("numbers in quotes", with("0.25", "\"0.25\"")),
        right("exponents and signs", with("0.25", "+2.5E-1").replace("1.5", "15e-1").replace("10\n", "1.0e+1\n")),
        right("no digit before the point", with("0.25", ".25").replace("-2,", "-2.,")),
        right("negative zero", with("0,0.5", "-0.0,0.5")),
        right("denormal numbers", with("0,0.5", "5e-324,0.5")),
        refused("text", with("0.25", "abc"), &["row 3", "column `q`"]),
    ]
}

/// Samples without an output are left out.
fn missing() -> Vec<Case> {
    const REST: &[usize] = &[0, 2, 3];
    let output = |name, cell: &str| case(name, with(",20", &format!(",{cell}")), Right(REST));
    vec![
        output("an empty output", ""),
        output("nan", "nan"),
        output("NaN", "NaN"),
        output("nan of Windows", "-nan(ind)"),
        output("quiet nan of Windows", "1.#QNAN"),
        output("#N/A", "#N/A"),
        output("NULL", "NULL"),
        output("a dash", "-"),
    ]
}

fn times() -> Vec<Case> {
    let dated = |times: [&str; 4]| {
        format!("t,q,y\n{},0.5,10\n{},0.25,20\n{},1.5,30\n{},-2,40\n", times[0], times[1], times[2], times[3])
    };
    let stepped =
        |form: &str| dated([0, 1, 2, 3].map(|k| form.replace('#', &k.to_string())).each_ref().map(String::as_str));
    let other_form: &[&str] = &["row 2", "column `t`", "a date of another form", "2026-11-03T10:00:00"];
    vec![
        right(
            "ISO 8601 with zones",
            dated([
                "2026-11-03T10:00:00.0+01:00",
                "2026-11-03T09:00:00.1Z",
                "2026-11-03T10:00:00.2+0100",
                "2026-11-03T04:00:00.3-05",
            ]),
        ),
        right("dates with a blank", stepped("2026-11-03 10:00:00.#")),
        right("dates with a comma before the fraction", other(&stepped("2026-11-03 10:00:00.#"), ';', ',')),
        right("times of day over midnight", dated(["23:59:59.9", "00:00:00.0", "00:00:00.1", "00:00:00.2"])),
        refused(
            "an hour that comes twice",
            dated(["2026-10-25T02:59:59", "2026-10-25T02:00:00", "2026-10-25T02:00:01", "2026-10-25T02:00:02"]),
            &["row 3", "set back by one hour at 02:59:59", "zone"],
        ),
        refused(
            "a zone here and none there",
            stepped("2026-11-03T10:00:00.#Z").replacen(".1Z", ".1", 1),
            &["row 3", "zone"],
        ),
        refused(
            "a month that is none",
            stepped("2026-11-03T10:00:0#Z").replacen("11-03T10:00:01", "13-03T10:00:01", 1),
            &["row 3", "2026-13-03"],
        ),
        refused("day and month that nobody can tell apart", stepped("03/11/2026 10:00:0#"), other_form),
        refused("a German date", stepped("3.11.2026 10:00:0#"), other_form),
        refused("twelve hours", stepped("10:00:0# AM"), &["row 2", "column `t`"]),
        refused(
            "numbers that become dates",
            dated(["0", "0.1", "2026-11-03T10:00:02Z", "2026-11-03T10:00:03Z"]),
            &["row 4", "column `t`"],
        ),
        refused(
            "dates that become numbers",
            dated(["2026-11-03T10:00:00Z", "2026-11-03T10:00:01Z", "2", "3"]),
            &["row 4"],
        ),
        refused("time that goes back", with("0.2,", "0.05,"), &["row 4", "sort the file"]),
        refused(
            "a counter that starts again",
            "t,q,y\n65516,0.5,10\n65526,0.25,20\n0,1.5,30\n10,-2,40\n",
            &["row 4", "starts again at 0 after 65535", "counters = "],
        ),
    ]
}

fn rows() -> Vec<Case> {
    vec![
        refused("a row that is too short", with("0.25,20", "0.25"), &["row 3", "2 cells"]),
        refused("a row of means at the end", format!("{PLAIN}mean,0.06,25\n"), &["row 6", "mean"]),
        right("a line end within quotes", "t,note,q,y\n0,\"a\nb\",0.5,10\n0.1,,0.25,20\n0.2,c,1.5,30\n0.3,d,-2,40\n"),
        right(
            "quotes within quotes",
            "t,note,q,y\n0,\"a \"\"b\"\" c\",0.5,10\n0.1,,0.25,20\n0.2,c,1.5,30\n0.3,d,-2,40\n",
        ),
    ]
}
