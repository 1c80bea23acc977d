//! Recordings in the formats of others: real samples against other readers, files made here, and damage.

#![allow(missing_docs)]

mod damage;
mod motive;
mod samples;
mod ulog;
mod ulog_file;
