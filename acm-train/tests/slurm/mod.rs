//! Runs as tasks of a real Slurm, on the loopback of this machine. The test and the example share this.

#![allow(dead_code)] // each user takes its part

pub mod loopback;
pub mod same;
pub mod sweep;
