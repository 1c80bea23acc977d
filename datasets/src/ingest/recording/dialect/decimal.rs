//! Decimal separators: point or comma.

use std::path::Path;

use super::{Plain, Told};
use crate::error::DataError;

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

/// Converts decimal commas to points, where the manifest states them or a number shows them.
pub(super) fn points(
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
    if let Some((r, cell)) = pointed(rows) {
        let row = r + plain.first_row - 1;
        let what = format!("{cell:?} has a point, and other numbers of the file have a decimal comma");
        let remedy = "write all numbers alike: a point may be one of thousands";
        return Err(DataError::BadText { path: path.to_path_buf(), row, what, remedy });
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

/// The first number with a point, and its row.
fn pointed(rows: &[Vec<String>]) -> Option<(usize, String)> {
    let is = |cell: &&String| cell.contains('.') && cell.trim().parse::<f64>().is_ok();
    rows.iter().enumerate().skip(1).find_map(|(r, row)| row.iter().find(is).map(|cell| (r, cell.clone())))
}
