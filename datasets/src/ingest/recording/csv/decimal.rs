//! Decimal separator of a file: a point or a comma.
//!
//! | evidence | meaning |
//! | --- | --- |
//! | `decimal` in the manifest | the other sign separates thousands, in groups of three digits |
//! | `0,5`, `12,34`, where no comma separates cells | decimal comma |
//! | `0.5`, `12.34`, or commas between cells | decimal point |
//! | `1,234`, or `1.234` where no comma separates cells, and none of the above | ambiguous: refused until `decimal` says which |
//! | `0,5` beside `1.5` | ambiguous |

use std::borrow::Cow;
use std::path::Path;

use crate::error::DataError;
use crate::ingest::recording::header::visible;

/// How the numbers of a file are written; by default with a decimal point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Decimal {
    /// The sign before the fraction is a comma.
    comma: bool,
    /// The other sign separates thousands.
    thousands: bool,
}

/// Cells that show how numbers are written.
#[derive(Debug, Default)]
pub(crate) struct Evidence {
    comma: Found,
    point: Found,
}

/// Row, column and text of a cell.
type Shown = (usize, String, String);

/// The first number with a fraction, and the first that may have one or be more than a thousand; each with its row.
#[derive(Debug, Default)]
struct Found {
    fraction: Option<Shown>,
    either: Option<Shown>,
}

impl Evidence {
    /// Looks at a cell.
    pub fn see(&mut self, row: usize, column: &str, cell: &str) {
        for (sign, found) in [(',', &mut self.comma), ('.', &mut self.point)] {
            let place = match is_fraction(cell, sign) {
                Some(true) => &mut found.fraction,
                Some(false) => &mut found.either,
                None => continue,
            };
            place.get_or_insert_with(|| (row, column.to_string(), cell.trim().to_string()));
        }
    }

    /// Decides how the numbers are written; a decimal comma becomes a note.
    ///
    /// # Errors
    /// A number that can mean two things, with its row.
    pub fn decide(
        self,
        path: &Path,
        separator: char,
        given: Option<char>,
        notes: &mut Vec<String>,
    ) -> Result<Decimal, DataError> {
        let refuse = |(row, column, cell): Shown, what: String| {
            let remedy = "write decimal = \",\" or decimal = \".\" in [table], [[source]] or [data]";
            let (path, what) = (path.to_path_buf(), format!("column `{}`: {cell:?} {what}", visible(&column)));
            Err(DataError::BadText { path, row, what, remedy })
        };
        let two = || "may be a fraction or more than a thousand".to_string();
        let Evidence { comma, point } = self;
        let is_comma = match (given, comma.fraction) {
            (Some(given), _) => given == ',',
            (None, Some((_, _, written))) if separator != ',' => match point.fraction.or(point.either) {
                Some(point) => return refuse(point, format!("has a point, and {written:?} has a comma")),
                None => true,
            },
            (None, _) => match (comma.either, point.fraction, point.either) {
                (Some(comma), ..) => return refuse(comma, two()),
                (None, None, Some(point)) if separator != ',' => return refuse(point, two()),
                _ => false,
            },
        };
        notes.extend(is_comma.then(|| "numbers have a decimal comma".to_string()));
        Ok(Decimal { comma: is_comma, thousands: given.is_some() })
    }
}

impl Decimal {
    /// The number in a cell without blanks around it; `None` if it is none.
    pub fn number(self, cell: &str) -> Option<f64> {
        let (fraction, other) = if self.comma { (',', '.') } else { ('.', ',') };
        let plain = match cell.contains(other) {
            false => Cow::Borrowed(cell),
            true if self.thousands && is_grouped(cell.split(fraction).next().unwrap_or(cell), other) => {
                Cow::Owned(cell.replace(other, ""))
            }
            true => return None,
        };
        match self.comma {
            true => plain.replacen(',', ".", 1).parse().ok(),
            false => plain.parse().ok(),
        }
    }
}

/// Whether a number with this sign must have a fraction, or may be more than a thousand; `None` if it is no such number.
fn is_fraction(cell: &str, sign: char) -> Option<bool> {
    let cell = cell.trim();
    let (before, after) = cell.split_once(sign)?;
    let other = if sign == ',' { '.' } else { ',' };
    let digits = before.trim_start_matches(['-', '+']);
    if cell.contains(other) || digits.is_empty() || after.is_empty() {
        return None;
    }
    let may_be_thousands = is_grouped(cell, sign) && !digits.starts_with('0');
    let number = || format!("{before}.{after}").parse::<f64>().is_ok();
    (may_be_thousands || number()).then_some(!may_be_thousands)
}

/// Whether the digits of a whole number stand in groups of three: `1,234`, `-12,345,678`.
fn is_grouped(cell: &str, sign: char) -> bool {
    let mut groups = cell.trim_start_matches(['-', '+']).split(sign);
    let digits = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    let first = groups.next().unwrap_or_default();
    (1..=3).contains(&first.len()) && digits(first) && groups.all(|group| group.len() == 3 && digits(group))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decide(cells: &[&str], separator: char, given: Option<char>) -> Result<Decimal, String> {
        let mut evidence = Evidence::default();
        cells.iter().enumerate().for_each(|(i, cell)| evidence.see(i + 2, "q", cell));
        evidence.decide(Path::new("a.csv"), separator, given, &mut Vec::new()).map_err(|e| e.to_string())
    }

    /// Oracle: by hand.
    #[test]
    fn numbers_are_read_or_asked_for() {
        let read = |cells: &[&str], separator, given| {
            decide(cells, separator, given).map(|decimal| cells.iter().map(|c| decimal.number(c)).collect::<Vec<_>>())
        };
        assert_eq!(read(&["0,5", "1,234", "-3"], ';', None), Ok(vec![Some(0.5), Some(1.234), Some(-3.0)]));
        assert_eq!(read(&["0.020", "12.345"], ';', None), Ok(vec![Some(0.02), Some(12.345)]));
        assert_eq!(read(&["1.234,5", "1.234", "1.5"], ';', Some(',')), Ok(vec![Some(1234.5), Some(1234.0), None]));
        assert_eq!(
            read(&["-1,401", "1,234,567.5", "1,5"], ',', Some('.')),
            Ok(vec![Some(-1401.0), Some(1234567.5), None])
        );
        assert_eq!(read(&["1.234", "1.5e-3"], ',', None), Ok(vec![Some(1.234), Some(1.5e-3)]));
        for (cells, separator) in [
            (&["1,234"][..], ';'),
            (&["7", "12.345"], ';'),
            (&["1.234.567"], '\t'),
            (&["0,5", "1.5"], ';'),
            (&["1,401"], ','),
        ] {
            let message = decide(cells, separator, None).expect_err("ambiguous");
            assert!(message.contains("row ") && message.contains("decimal = "), "{cells:?}: {message}");
        }
    }
}
