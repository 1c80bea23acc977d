//! Evaluation of runs: errors on scored and held-out trials, spread over runs, intervals, and the verdict.

pub mod alone;
pub mod floors;
pub mod held_out;
pub mod intervals;
pub mod score;
pub mod spread;
pub mod summary;
pub mod verdict;
