//! Simulated rigs as data sets: simulations of `acm_sim` with a manifest, in memory or as a folder.
//!
//! | module | what |
//! | --- | --- |
//! | [`store`] | the synthetic flight campaign in one table |
//! | [`large`] | the same many times over, in a stream |
//! | [`mod@statistics`] | its statistics beside those of the paper |
//! | [`undeclared`] | campaigns of the arm with undeclared mechanisms |
//! | [`small_rig`] | small rigs beside the arm |

pub mod large;
pub mod small_rig;
pub mod statistics;
pub mod store;
pub mod undeclared;

pub use large::write_repeated;
pub use statistics::{StatisticRow, StatisticsError, samples_in_domain, statistics};
pub use store::{write, write_json};
