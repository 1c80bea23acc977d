//! ULog of PX4: topics, each at its own instants.
//!
//! ```text
//! header (16 bytes) · definitions · data          record: size (u16) · type (u8) · payload
//! ```
//!
//! The crate `px4-ulog`, PX4's own, decodes the records; [`records`] finds them in the file and goes on behind damage.
//! A column is `topic.field`, of further instances `topic[1].field`; nested and repeated fields are `a.b[2]`. The format has no
//! units. Time is `timestamp`, µs since boot.
//!
//! Source: docs.px4.io, "ULog File Format".

mod records;
mod topics;

use std::cell::RefCell;
use std::path::Path;

use px4_ulog::stream_parser::LogParser;
use px4_ulog::stream_parser::model::{DataMessage, DropoutMessage};

use self::records::{Records, Seen};
use self::topics::Topics;
use super::{Format, Keep, Take, no_such};
use crate::error::DataError;
use crate::files::regular;

/// Largest number of damaged stretches that are listed; of more, only the number.
const TOLD: usize = 5;

pub(super) fn read(path: &Path, keep: Keep) -> Result<Take, DataError> {
    let failed = |e: &std::io::Error| DataError::file_system("read", path, e);
    let file = regular::open(path).map_err(|e| failed(&e))?;
    let topics = RefCell::new(Topics::new(path, keep));
    let dropouts = RefCell::new((0usize, 0.0));
    let mut on_data = |message: &DataMessage| topics.borrow_mut().take(message);
    let mut on_dropout = |message: &DropoutMessage| {
        let mut all = dropouts.borrow_mut();
        *all = (all.0 + 1, all.1 + f64::from(message.duration_ms) / 1000.0);
    };
    let mut parser = LogParser::default();
    parser.set_data_message_callback(&mut on_data);
    parser.set_dropout_message_callback(&mut on_dropout);
    let mut records = Records::new(file);
    let header = records.header().map_err(|e| failed(&e))?;
    let header = header.filter(|header| parser.consume_bytes(header).is_ok());
    if header.is_none() {
        return Err(no_such(
            path,
            1,
            "the file does not begin as a ULog does",
            "copy it again, or name another `format`",
        ));
    }
    let mut lost = Vec::new();
    while let Some(seen) = records.next().map_err(|e| failed(&e))? {
        match seen {
            Seen::Record(record) => {
                if let Err(error) = parser.consume_bytes(record) {
                    parser.clear_leftover();
                    records.refuse(&error.description);
                }
            }
            Seen::Gap(what) => lost.push(what),
        }
        records.append_at(*parser.appended_offsets());
        topics.borrow_mut().full()?;
    }
    let more = lost.len().saturating_sub(TOLD);
    lost.truncate(TOLD);
    lost.extend((more > 0).then(|| format!("{more} more stretches are damaged and not read")));
    let in_data = parser.in_data();
    lost.extend(records.refused());
    drop(parser);
    let topics = topics.into_inner();
    let untimed = topics.untimed.iter().cloned().collect::<Vec<_>>().join(", ");
    let groups = topics.groups()?;
    let undefined = lost.iter().find(|what| what.contains("type_and_name"));
    if groups.is_empty() && (!untimed.is_empty() || undefined.is_some()) {
        let what = undefined.cloned().unwrap_or_else(|| format!("topics without a `timestamp` of 64 bits ({untimed})"));
        let remedy = "convert the log with `ulog2csv`, and read the tables";
        return Err(DataError::Unsupported { path: path.to_path_buf(), what, remedy });
    }
    if groups.is_empty() {
        let what = if in_data { "it has no samples" } else { "its definitions cannot be read" };
        let reason = [vec![what.to_string()], lost].concat().join("; ");
        return Err(DataError::Damaged { path: path.to_path_buf(), reason });
    }
    let mut take = Take { groups, lost, ..Take::new(Format::Ulog) };
    take.notes.push("time is `timestamp`, µs since boot; the format has no units".into());
    take.notes.extend((!untimed.is_empty()).then(|| format!("skipped, without a `timestamp` of 64 bits: {untimed}")));
    let (count, seconds) = dropouts.into_inner();
    if count > 0 {
        take.notes.push(format!("the logger left out {count} stretches, {seconds:.3} s together"));
    }
    Ok(take)
}
