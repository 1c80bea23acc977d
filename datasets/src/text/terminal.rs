//! Tables and paragraphs in a terminal, wrapped to its width; nothing is cut.

use std::io::{IsTerminal, stdout};

use comfy_table::{Attribute, Cell, CellAlignment, ContentArrangement, Table, TableStyle, presets};

/// Outputs of which each has a column of its own; more have a row each, or stay with the records.
pub const MOST_ACROSS: usize = 6;

/// Columns of a paragraph where there is no terminal: in a pipe or a log.
const PARAGRAPH: usize = 100;

/// Columns of the terminal; where standard output is none, of the variable `COLUMNS`, and without it as many as are needed.
pub fn width() -> Option<usize> {
    let seen = stdout().is_terminal().then(terminal_size::terminal_size).flatten().map(|(width, _)| width.0.into());
    seen.or_else(|| std::env::var("COLUMNS").ok()?.parse().ok()).filter(|width| *width > 0)
}

/// A paragraph in lines that fit, those after the first indented by `hanging`.
pub fn paragraph(words: &str, hanging: &str) -> String {
    let options = textwrap::Options::new(width().unwrap_or(PARAGRAPH).max(20))
        .subsequent_indent(hanging)
        .word_separator(textwrap::WordSeparator::AsciiSpace)
        .word_splitter(textwrap::WordSplitter::NoHyphenation);
    textwrap::wrap(words, options).join("\n")
}

/// A cell of a table, in bold where it stands out.
pub fn cell(text: impl ToString, bold: bool) -> Cell {
    let cell = Cell::new(text);
    if bold { cell.add_attribute(Attribute::Bold) } else { cell }
}

/// A table between two rules; all columns but the first `words` hold numbers and are flush right.
pub fn ruled(header: Vec<String>, rows: Vec<Vec<String>>, words: usize) -> Table {
    let mut table = framed(presets::UTF8_BORDERS_ONLY);
    table.set_header(header);
    table.add_rows(rows);
    flush_right(&mut table, words);
    table
}

/// A table with the lines of `preset`, no wider than the terminal.
pub fn framed(preset: TableStyle) -> Table {
    let mut table = Table::new();
    table.load_style(preset);
    match width() {
        Some(width) => table.set_content_arrangement(ContentArrangement::Dynamic).set_width(width.min(1 << 15) as u16),
        None => table.set_content_arrangement(ContentArrangement::Disabled),
    };
    table
}

/// Numbers stand flush right, from column `words` on.
pub fn flush_right(table: &mut Table, words: usize) {
    table.column_iter_mut().skip(words).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
}

/// Rows as columns, the header as the first column.
pub fn turned(header: Vec<String>, rows: &[Vec<String>]) -> (Vec<String>, Vec<Vec<String>>) {
    let column = |c: usize| rows.iter().map(move |row| row.get(c).cloned().unwrap_or_default());
    let line = |(c, name): (usize, &String)| std::iter::once(name.clone()).chain(column(c)).collect();
    let mut lines: Vec<Vec<String>> = header.iter().enumerate().map(line).collect();
    let head = if lines.is_empty() { vec![] } else { lines.remove(0) };
    (head, lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_become_columns() {
        let text = |words: &[&str]| words.iter().map(ToString::to_string).collect::<Vec<_>>();
        let (head, rows) = turned(text(&["", "x", "y"]), &[text(&["a", "1", "2"]), text(&["b", "3", "4"])]);
        assert_eq!((head, rows), (text(&["", "a", "b"]), vec![text(&["x", "1", "3"]), text(&["y", "2", "4"])]));
    }
}
