//! From data files to trials.
//!
//! Files are located, read as columns of numbers or piece by piece, split and cut into trials.

pub(crate) mod cut;
pub(crate) mod layout;
pub mod locate;
pub(crate) mod periodic;
pub(crate) mod recording;
pub(crate) mod split;
pub(crate) mod stamps;
pub(crate) mod stream;
