//! From text to values: each knows its file, line and column, and a refused one underlines its key.

pub(super) mod complaint;
pub(super) mod decode;
pub(super) mod fault;
pub(super) mod source;
mod text;
