//! Classification of a text cell that is not a number, with a remedy.

/// Description of a text cell, and a remedy; for the column of `time`, or for another.
pub(super) fn written(cell: &str, time: bool) -> (&'static str, &'static str) {
    let number = |text: String| text.parse::<f64>().is_ok();
    let dates = match time {
        true => "write it as ISO 8601, such as 2026-11-03T10:00:00.125Z, or as seconds",
        false => "write a number, or name another column in the manifest",
    };
    if number(cell.replacen(',', ".", 1)) {
        (": it has a decimal comma", "write a decimal point (pandas: to_csv with decimal=\".\")")
    } else if is_date_of_iso(cell) {
        (" but a date", dates)
    } else if is_other_date(cell) {
        (": it is a date of another form", dates)
    } else if is_clock(cell) {
        (" but a time of day", dates)
    } else if number(cell.replace('\u{2212}', "-").replace(['\u{2013}', '\u{2014}'], "-")) {
        ("", "correct the cell or delete the row (write the sign as a hyphen)")
    } else if number(cell.replace(['\'', ' ', '_', '\u{a0}', '\u{202f}', '\u{2009}'], "")) {
        ("", "correct the cell or delete the row (write it without separators between thousands)")
    } else if number(cell.replace(['d', 'D'], "e")) {
        ("", "correct the cell or delete the row (write the exponent with e)")
    } else if number(cell.trim_end_matches(|c: char| c.is_alphabetic() || "%°/ ".contains(c)).to_string()) {
        ("", "correct the cell or delete the row (the unit belongs into the manifest)")
    } else {
        ("", "correct the cell or delete the row")
    }
}

/// ISO 8601: `2026-11-03`, and whatever follows a `T` or a space.
fn is_date_of_iso(cell: &str) -> bool {
    shaped(cell, "0000-00-00") && matches!(cell.as_bytes().get(10), None | Some(b'T' | b't' | b' '))
}

/// `3.11.2026`, `11/03/26 10:00`, `2026/11/03`, `3-Nov-2026`.
fn is_other_date(cell: &str) -> bool {
    let day = cell.split([' ', 'T']).next().unwrap_or_default();
    let digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    let month = |part: &str| part.len() == 3 && part.bytes().all(|byte| byte.is_ascii_alphabetic());
    let part = |part: &&str| (matches!(part.len(), 1 | 2 | 4) && digits(part)) || month(part);
    let is_date = |parts: Vec<&str>| {
        parts.len() == 3 && parts.iter().all(part) && (parts[2].len() == 2 || parts.iter().any(|part| part.len() == 4))
    };
    ['.', '/', '-'].into_iter().any(|sign| is_date(day.split(sign).collect()))
}

/// `9:30`, `09:30:00`, `09:30:00.125`.
fn is_clock(cell: &str) -> bool {
    shaped(cell, "00:00") || shaped(cell, "0:00")
}

/// Whether a cell begins with digits where the shape has a 0, and with the shape's other letters.
fn shaped(cell: &str, shape: &str) -> bool {
    let fits = |(cell, shape): (u8, u8)| if shape == b'0' { cell.is_ascii_digit() } else { cell == shape };
    cell.len() >= shape.len() && cell.bytes().zip(shape.bytes()).all(fits)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn dates_and_clocks_are_told_from_other_text() {
        let what = |cell| written(cell, true).0;
        for date in ["2026-11-03", "2026-11-03T10:00:00", "2026-11-03 10:00:00.125+01:00"] {
            assert_eq!(what(date), " but a date", "{date}");
        }
        for clock in ["12:30", "9:30", "09:30:00.125"] {
            assert_eq!(what(clock), " but a time of day", "{clock}");
        }
        for date in ["25.10.2026 10:00:00.000", "03/11/2026", "2026/11/03 10:00", "2026-1-3", "3-Nov-2026"] {
            assert_eq!(what(date), ": it is a date of another form", "{date}");
        }
        for other in ["2026-11-03x", "1.2.3", "1.234.567", ":30", "a2:30", "123:40", "ä0:00"] {
            assert_eq!(what(other), "", "{other}");
        }
        assert_eq!(what("-3,5e2"), ": it has a decimal comma");
        assert_eq!(what("1,234,5"), "");
    }
}
