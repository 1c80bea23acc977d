//! Traces what a nominal model misses to a physical effect that it lacks.
//!
//! | module | what |
//! | --- | --- |
//! | [`finding`] | the result, as it is written to `loop.json` |
//! | [`remainder`] | what a model leaves, trial by trial |
//!
//! Arrays in, a finding out: nothing here knows files, tables or pages.

pub mod finding;
pub mod remainder;
