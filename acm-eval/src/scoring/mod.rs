//! Scoring of the loop: campaigns with a sealed truth are traced and compared with it.
//!
//! ```text
//! plan: seeds × designs ─▶ attempt: generate → trace → finding ─▶ row: finding against truth ─▶ score: shares, quantiles
//! ```
//!
//! | room or file | what |
//! | --- | --- |
//! | [`plan`], [`seeds`] | which campaigns are tried, from two lists of seeds |
//! | [`mod@attempt`] | one campaign or rig: made, traced, compared |
//! | [`answer`] | what a finding claims beside what is true |
//! | [`aliases`] | the table of effects that data of a kind cannot tell apart, and the command that makes it |
//! | [`single`] | campaigns of one cause, of pairs, nulls, causes outside the library |
//! | [`figures`] | names, shares, intervals over answers of any kind; the reliability diagram |
//! | [`kept`] | rows on the disk, one on each line |
//!
//! The truth is opened after the finding is made, and by nothing else than [`single`] and [`answer`].

pub mod aliases;
pub mod answer;
mod attempt;
pub mod figures;
pub mod kept;
mod plan;
mod seeds;
mod share;
pub mod single;

pub use attempt::{attempt, attempt_several, attempt_small_rig};
pub use plan::{Key, Plan, Task, Tried, several_tasks};
pub use seeds::{LENGTH, Seeds};
pub use share::{Share, quantile};
