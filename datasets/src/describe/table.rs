//! The look of all tables on a terminal.

use comfy_table::{Table, presets};

use crate::text::terminal::{flush_right, framed};

/// A table whose first `words` columns are text; the others are numbers.
pub fn table(header: &[&str], words: usize) -> Table {
    let mut table = framed(presets::UTF8_BORDERS_ONLY);
    table.set_header(header.to_vec());
    flush_right(&mut table, words);
    table
}
