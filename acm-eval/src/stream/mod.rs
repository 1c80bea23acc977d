//! From a run folder to an estimator beside a robot, sample by sample.
//!
//! ```text
//! run folder ─ saved::load, best::load ─▶ Parts, Wiring, Domain ─▶ Robot ─┬─ Session: lines in, answers out
//!                                                                        └─ Sampler: numbers in, answers out
//! ```

pub mod best;
mod lines;
pub mod robot;
pub mod sampler;
pub mod saved;
pub mod session;
pub mod wiring;
