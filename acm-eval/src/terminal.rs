//! The main table in the terminal.

use std::{
    io::{self, Write},
    path::Path,
};

use comfy_table::{Attribute, Cell as Shown, CellAlignment, ContentArrangement, Table as Grid, presets};

use crate::{
    chapter::Chapter,
    error::EvalError,
    report::Report,
    tables::{Cell, Column, Table},
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

/// What to print after a report: each chapter's main table, marked where the data are synthetic.
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

fn grid(table: &Table) -> Grid {
    let mut grid = Grid::new();
    grid.load_style(presets::UTF8_FULL_CONDENSED).set_content_arrangement(ContentArrangement::Dynamic);
    grid.set_header(table.columns.iter().map(Column::heading));
    for row in &table.rows {
        grid.add_row(row.cells.iter().zip(&table.columns).map(|(cell, column)| {
            let shown = Shown::new(cell.show(column.digits));
            let shown = if column.text { shown } else { shown.set_alignment(CellAlignment::Right) };
            if matches!(cell, Cell::Best(_)) { shown.add_attribute(Attribute::Bold) } else { shown }
        }));
    }
    grid
}
