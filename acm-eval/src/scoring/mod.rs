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
//! | F | with an effect of the library | (b² − a²)/(b² − floor²) on untouched trials, b the best of the three befores |
//! | coverage | parameters with a counterpart | the true value lies within the 95 % interval |
//!
//! The truth is opened after the finding is made, and by nothing else than [`row`].

mod attempt;
mod matching;
mod parameters;
mod plan;
mod row;
mod score;
mod share;
mod text;

pub use attempt::attempt;
pub use parameters::ParameterRow;
pub use plan::{Plan, Task};
pub use row::{Row, Top};
pub use score::{Score, Summary};
pub use share::{Share, quantile};
pub use text::{heading, line, table};
