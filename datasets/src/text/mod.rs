//! Text for people: help and tables in a terminal, commands in messages, lists of row numbers, natural order of names,
//! similar names.

pub mod help;
pub mod hint;
pub(crate) mod natural;
pub(crate) mod rows;
pub mod spelling;
pub mod terminal;
