//! Data sets written to a temporary folder, read through the library and through `acm-data`.

#![allow(missing_docs)]

mod describe;
mod measured;
mod parquet_types;
mod problems;
mod reading;
mod rig;
mod set;
mod spoiled;
mod streams;
mod trunk;
mod windows;
