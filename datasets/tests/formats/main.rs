//! Recordings in the formats of others: real samples against other readers, files made here, and damage.

#![allow(missing_docs)]

mod motive;
mod samples;
mod ulog;
mod ulog_file;
