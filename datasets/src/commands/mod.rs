//! One command a file; each writes to a text that `main` prints.

mod braille;
pub mod check;
pub mod describe;
pub mod generate;
pub mod import;
pub mod statistics;
