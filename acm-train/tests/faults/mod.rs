//! What disturbs a run, and how to see that it did no harm. Tests and examples share this: few in the tests, many by hand.

#![allow(dead_code)] // each user takes its part

pub mod disks;
pub mod errors;
pub mod folder;
pub mod kills;
pub mod mutation;
pub mod mutations;
pub mod questions;
pub mod races;
pub mod saved;
