//! MCAP with messages of ROS 2: topics, each at its own instants.
//!
//! The crate `mcap` reads the records, chunk by chunk; `re_ros_msg` reads a channel's schema, [`layout`] makes a tree of it, and
//! [`fields`] takes the messages apart by it, whatever their type. Names are made once for all messages with the same fields. A column is `topic.field`, nested and repeated ones `a.b[2]`.
//!
//! Time is `header.stamp` where a message begins with a header that has one, and the time at which it was recorded elsewhere;
//! that is `topic.log_time` in any case. Both are seconds since 1970.
//!
//! Sources: mcap.dev/spec; docs.ros.org, "About ROS 2 interfaces".

mod fields;
mod layout;
mod message;
mod topic;
mod zstd;

use std::collections::BTreeMap;
use std::io::BufReader;
use std::path::Path;

use ::mcap::Channel;
use ::mcap::io::MessageReader;
use ::mcap::sans_io::LinearReaderOptions;

use self::topic::Topic;
use super::{Format, Group, Keep, Take, check_size, no_such};
use crate::error::{DataError, short};
use crate::files::regular;

/// A longer record is none of a recording of numbers. A record is held up to three times: compressed, decompressed, and as a message.
const RECORD_LIMIT: usize = 1 << 26;

/// Largest number of notes of one kind; of more, only the number.
const TOLD: usize = 8;

/// Reads a recording; where the crate's decoder panics on a damaged record, that is a message.
pub(super) fn read(path: &Path, keep: Keep) -> Result<Take, DataError> {
    let read = crate::ingest::recording::guarded(|| Ok(records(path, keep)));
    read.unwrap_or_else(|reason| Err(DataError::Damaged { path: path.to_path_buf(), reason }))
}

fn records(path: &Path, keep: Keep) -> Result<Take, DataError> {
    let file = regular::open(path).map_err(|e| DataError::file_system("read", path, &e))?;
    let options = LinearReaderOptions::default().with_record_length_limit(RECORD_LIMIT).with_validate_chunk_crcs(true);
    let (mut topics, mut by_channel): (Vec<Topic>, BTreeMap<u16, usize>) = (Vec::new(), BTreeMap::new());
    let (mut take, mut values, mut messages) = (Take::new(Format::Mcap), 0, 0usize);
    let mut reader = MessageReader::new_with_options(BufReader::with_capacity(1 << 18, file), options);
    let registered = zstd::Zstd::new().and_then(|zstd| reader.add_decompressor(zstd));
    registered.map_err(|e| DataError::Damaged { path: path.to_path_buf(), reason: e.to_string() })?;
    for message in reader {
        match message {
            Ok(message) => {
                messages += 1;
                let channel = &message.channel;
                let index = *by_channel.entry(channel.id).or_insert_with(|| topic_of(&mut topics, channel, keep));
                values += topics[index].take(&message, keep);
                check_size(path, values)?;
            }
            Err(error) => {
                let why = short(&error.to_string(), 120);
                take.lost.push(format!("after {messages} messages the file cannot be read on: {why}"));
            }
        }
    }
    if messages == 0 {
        let what = format!("there are no messages ({})", take.lost.join("; "));
        return Err(no_such(path, 1, what, "copy the file again, or recover it with `mcap recover`"));
    }
    let (mut notes, mut lost) = (Vec::new(), Vec::new());
    topics.sort_by(|a, b| a.name.cmp(&b.name));
    for topic in topics {
        let (group, said) = topic.finish();
        notes.extend(said.notes);
        lost.extend(said.lost);
        take.groups.extend(group);
    }
    if take.groups.is_empty() {
        let remedy = "record messages of ROS 2 (cdr, with schemas of ros2msg), or convert the recording to CSV";
        return Err(DataError::Unsupported { path: path.to_path_buf(), what: short(&notes.join("; "), 400), remedy });
    }
    one_name_each(&mut take.groups);
    few(notes, &mut take.notes);
    few(lost, &mut take.lost);
    Ok(take)
}

/// Index of the topic of a channel; channels of one topic with one schema share it.
fn topic_of(topics: &mut Vec<Topic>, channel: &Channel, keep: Keep) -> usize {
    topics.iter().position(|topic| topic.is_of(channel)).unwrap_or_else(|| {
        topics.push(Topic::new(channel, keep));
        topics.len() - 1
    })
}

/// Some of the sentences, and how many more.
fn few(all: Vec<String>, into: &mut Vec<String>) {
    let more = all.len().saturating_sub(TOLD);
    into.extend(all.into_iter().take(TOLD));
    into.extend((more > 0).then(|| format!("and {more} more topics alike")));
}

/// Channels of one topic may have several schemas.
fn one_name_each(groups: &mut [Group]) {
    for k in 1..groups.len() {
        if groups[k].name == groups[k - 1].name {
            groups[k].name += " (2)";
            groups[k].columns.iter_mut().for_each(|column| column.name += " (2)");
        }
    }
}
