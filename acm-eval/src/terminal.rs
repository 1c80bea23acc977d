//! The main table in the terminal.

use std::{
    io::{self, Write},
    path::Path,
};

use acm_datasets::text::terminal::{MOST_ACROSS, cell, flush_right, framed, turned};
use comfy_table::{Table as Grid, presets};

use crate::{
    chapter::Chapter,
    error::EvalError,
    report::Report,
    tables::{Cell, Column, Row, Table},
};

/// Prints a line, or several.
///
/// # Errors
/// Standard output is a file on a full disk. A reader that went away ends the program and is no failure.
pub fn print(text: &str) -> Result<(), EvalError> {
    let mut out = io::stdout().lock();
    let printed = writeln!(out, "{text}").and_then(|()| out.flush());
    printed.map_err(|source| EvalError::write(Path::new("standard output"), source))
}

/// Writes the terminal output after a report: each chapter's main table, marked where the data are synthetic.
pub fn summary(report: &Report) -> String {
    report.chapters.iter().map(chapter).collect::<Vec<_>>().join("\n\n")
}

fn chapter(chapter: &Chapter) -> String {
    let mark = if chapter.data.synthetic { " — SYNTHETIC DATA, made by a simulator" } else { "" };
    match chapter.tables.iter().find(|table| table.name == chapter.main) {
        Some(table) => format!("{}{mark}\n{}\n{}", chapter.title, table.title, grid(table)),
        None => format!("{}{mark}\nno scores yet", chapter.title),
    }
}

/// Columns of a table, at most; a wider one has a row for each of its columns.
const ACROSS: usize = MOST_ACROSS + 3;

fn grid(table: &Table) -> Grid {
    let mut header: Vec<String> = table.columns.iter().map(Column::heading).collect();
    let shown = |row: &Row| row.cells.iter().zip(&table.columns).map(|(cell, column)| column.show(cell)).collect();
    let mut rows: Vec<Vec<String>> = table.rows.iter().map(shown).collect();
    let best = |row: usize, column: usize| matches!(table.rows[row].cells[column], Cell::Best(_));
    let is_wide = header.len() > ACROSS;
    if is_wide {
        (header, rows) = turned(header, &rows);
    }
    let mut grid = framed(presets::UTF8_FULL_CONDENSED);
    grid.set_header(header);
    for (r, row) in rows.into_iter().enumerate() {
        let bold = |c: usize| if is_wide { c > 0 && best(c - 1, r + 1) } else { best(r, c) };
        grid.add_row(row.into_iter().enumerate().map(|(c, text)| cell(text, bold(c))));
    }
    let words = table.columns.iter().take_while(|column| column.text).count();
    flush_right(&mut grid, words);
    grid
}
