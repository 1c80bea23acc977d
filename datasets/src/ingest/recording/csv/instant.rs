//! Dates and times of day (ISO 8601), as ticks of a nanosecond.
//!
//! ```text
//! 2026-11-03T10:00:00.125+01:00    2026-11-03 10:00:00,125    10:00:00.125
//! ```
//!
//! Days from 1970 by the civil calendar (Hinnant 2013, "chrono-compatible low-level date algorithms"), times in whole nanoseconds.
//! A clock alone that falls by more than half a day has passed midnight.

use std::path::Path;

use super::missing::is_missing;
use crate::error::{DataError, shown};
use crate::ingest::recording::cells::Texts;
use crate::ingest::recording::header::visible;
use crate::ingest::recording::ticks::TickType;

const SECOND: i128 = 1_000_000_000;
const DAY: i128 = 86_400 * SECOND;

/// An instant in ns, and what it is.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Instant {
    nanoseconds: i128,
    dated: bool,
    zoned: bool,
}

/// Whether a cell is a date or a time of day that [`ticks`] reads.
pub(super) fn is_instant(cell: &str) -> bool {
    instant(cell).is_some()
}

/// The cells of a column as instants in ns; `None` if the first is none, or a number follows it. An empty cell stays
/// empty.
///
/// # Errors
/// A cell that differs in form from the first, with its row.
pub(super) fn ticks(
    (path, column): (&Path, &str),
    cells: &Texts,
    row: impl Fn(usize) -> usize,
    notes: &mut Vec<String>,
) -> Result<Option<(TickType, Vec<Option<i64>>)>, DataError> {
    let mut written = cells.iter().filter(|cell| !is_missing(cell.trim()));
    let first = written.next().and_then(instant);
    let is_number = written.next().is_some_and(|cell| cell.trim().parse::<f64>().is_ok());
    let Some(first) = first.filter(|_| !is_number) else { return Ok(None) };
    let (mut ticks, mut before, mut midnights) = (Vec::with_capacity(cells.len()), first.nanoseconds, 0);
    for (i, cell) in cells.iter().enumerate() {
        if is_missing(cell.trim()) {
            ticks.push(None);
            continue;
        }
        let bad = |what: &str| {
            let what = format!("column `{}`: {:?} {what}", visible(column), shown(cell));
            let (what, remedy) = (what, "write every time in one form, such as 2026-11-03T10:00:00.125Z");
            DataError::BadText { path: path.to_path_buf(), row: row(i), what, remedy }
        };
        let found = instant(cell).ok_or_else(|| bad("is not a time of the form of the first row"))?;
        if found.dated != first.dated || found.zoned != first.zoned {
            return Err(bad("has a date or a zone and the first row has none, or the reverse"));
        }
        let mut nanoseconds = found.nanoseconds + midnights * DAY;
        if !found.dated && before - nanoseconds > DAY / 2 {
            midnights += 1;
            nanoseconds += DAY;
        }
        before = nanoseconds;
        ticks.push(Some(i64::try_from(nanoseconds).map_err(|_| bad("is not between the years 1678 and 2262"))?));
    }
    let kind = match (first.dated, first.zoned) {
        (true, true) => "dates with zones",
        (true, false) => "dates without a zone",
        (false, _) => "times of day",
    };
    notes.push(format!("time is written as {kind}"));
    notes.extend((midnights > 0).then(|| format!("the clock passes midnight {midnights} times")));
    let name = if first.dated { "date" } else { "time of day" }.to_string();
    let local = first.dated && !first.zoned;
    Ok(Some((TickType { name, unit: "s", per_second: 1_000_000_000, seconds: 1, duration: false, local }, ticks)))
}

fn instant(cell: &str) -> Option<Instant> {
    let cell = cell.trim();
    if !cell.is_ascii() || cell.len() < 5 {
        return None;
    }
    let (days, clock, dated) = match cell.as_bytes().get(10) {
        Some(b'T' | b't' | b' ') if cell.as_bytes()[4] == b'-' => (days(&cell[..10])?, &cell[11..], true),
        _ => (0, cell, false),
    };
    let (clock, zone) = zone(clock)?;
    let nanoseconds = days * DAY + of_day(clock)? - zone.unwrap_or(0);
    Some(Instant { nanoseconds, dated, zoned: zone.is_some() })
}

/// Days since 1970-01-01.
fn days(date: &str) -> Option<i128> {
    let mut parts = date.split('-').map(|part| part.parse::<i128>().ok());
    let (year, month, day) = (parts.next()??, parts.next()??, parts.next()??);
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let longest = match month {
        2 => 28 + i128::from(leap),
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => return None,
    };
    if day < 1 || day > longest {
        return None;
    }
    let shifted = if month <= 2 { year - 1 } else { year };
    let era = shifted.div_euclid(400);
    let of_era = shifted.rem_euclid(400);
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    Some(era * 146_097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719_468)
}

/// The clock, and the zone behind it in ns.
fn zone(clock: &str) -> Option<(&str, Option<i128>)> {
    if let Some(clock) = clock.strip_suffix(['Z', 'z']) {
        return Some((clock, Some(0)));
    }
    let Some(at) = clock.rfind(['+', '-']) else { return Some((clock, None)) };
    let (sign, digits) = (if &clock[at..=at] == "-" { -1 } else { 1 }, clock[at + 1..].replace(':', ""));
    if !matches!(digits.len(), 2 | 4) || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let hours: i128 = digits[..2].parse().ok()?;
    let minutes: i128 = digits.get(2..).filter(|m| !m.is_empty()).map_or(Some(0), |m| m.parse().ok())?;
    Some((&clock[..at], Some(sign * (hours * 3600 + minutes * 60) * SECOND)))
}

/// `10:00`, `10:00:00`, `10:00:00.125`, in ns.
fn of_day(clock: &str) -> Option<i128> {
    let mut parts = clock.trim().splitn(3, ':');
    let whole =
        |part: &str| part.parse::<i128>().ok().filter(|_| part.len() <= 2 && part.bytes().all(|b| b.is_ascii_digit()));
    let (hours, minutes) = (whole(parts.next()?)?, whole(parts.next()?)?);
    let seconds = parts.next().unwrap_or("0");
    let (seconds, fraction) = seconds.split_once(['.', ',']).unwrap_or((seconds, ""));
    let seconds = whole(seconds)?;
    let digits: String = fraction.chars().chain("000000000".chars()).take(9).collect();
    let nanoseconds: i128 = digits.parse().ok().filter(|_| fraction.bytes().all(|byte| byte.is_ascii_digit()))?;
    (hours < 24 && minutes < 60 && seconds <= 60)
        .then_some(((hours * 60 + minutes) * 60 + seconds) * SECOND + nanoseconds)
}
