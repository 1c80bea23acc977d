//! Data sets written to a temporary folder, read through the library and through `acm-data`.

#![allow(missing_docs)]

mod describe;
mod fuzz;
mod import;
mod manifest;
mod measured;
mod problems;
mod reading;
mod rig;
mod set;
mod streams;
mod trunk;
mod windows;
