//! Answers: claims of a finding beside the truth, independent of their file formats.
//!
//! | file | what |
//! | --- | --- |
//! | [`claim`] | claims, causes, and how right the names are |
//! | [`finding`] | from findings and truths to answers |
//! | [`matching`] | which name stands for which cause |

mod claim;
mod finding;
pub mod matching;

pub use claim::{Alias, Answer, Claim, Interval, Names, TrueCause, ends, is_named, rights};
pub use finding::{claims, small_rig, undeclared};

#[cfg(test)]
pub use claim::{answer, cause, claim};
