//! How well the loop finds what nobody declared: campaigns with a sealed truth, traced, and compared with it.
//!
//! ```text
//! plan: seeds × designs ─▶ attempt: generate → trace → finding ─▶ row: finding against truth ─▶ score: shares, quantiles
//! ```
//!
//! | figure | of which campaigns | what |
//! | --- | --- | --- |
//! | top-1 | with an effect of the library | the effect found first is the true one, or one that the data cannot tell from it |
//! | truth in set | the same | the true name stands among the names found or their equivalents |
//! | false alarms | without a mechanism | any effect is named |
//! | abstentions | outside of the library | nothing is named for sure |
//! | F | with an effect of the library | (b² − a²)/(b² − floor²) on held-out trials, b the best baseline |
//! | coverage | parameters with a counterpart | the true value lies within the 95 % interval |
//!
//! Campaigns of several causes ([`several`]) and small rigs ([`small_rigs`]) have figures of their own, over answers
//! ([`claim`]) that know nothing of how findings and truths are written; their seeds stand in [`seeds`].
//!
//! The truth is opened after the finding is made, and by nothing else than [`row`] and [`answers`].

mod answers;
mod attempt;
mod claim;
mod lines;
mod matching;
mod parameters;
mod plan;
mod row;
mod score;
mod seeds;
mod several;
mod share;
mod small_rigs;
mod text;

pub use attempt::{attempt, attempt_several, attempt_small_rig};
pub use claim::{Answer, Claim, Interval, Names, TrueCause};
pub use lines::{rig_heading, rig_line, rig_table, several_heading, several_line, several_table};
pub use parameters::ParameterRow;
pub use plan::{Plan, Task, several_tasks};
pub use row::{Row, Top};
pub use score::{Score, Summary};
pub use seeds::Seeds;
pub use several::{Bin, Figures, SeveralRow};
pub use share::{Share, quantile};
pub use small_rigs::{RigFigures, RigRow, RigScore};
pub use text::{heading, line, table};
