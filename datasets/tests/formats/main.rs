//! Recordings in the formats of others: real samples against other readers, files made here, and damage.

#![allow(missing_docs)]

mod cut_off;
#[cfg(feature = "mcap")]
mod mcap;
mod motive;
#[allow(dead_code)] // some are damaged by another test
#[path = "../../examples/fuzz_files/recordings.rs"]
mod recordings;
mod samples;
mod ulog;
mod ulog_file;
