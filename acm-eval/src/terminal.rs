//! The main table in the terminal.

use comfy_table::{Attribute, Cell as Shown, CellAlignment, ContentArrangement, Table as Grid, presets};

use crate::{
    report::{Chapter, Report},
    tables::{Cell, Table},
};

/// What to print after a report: each data set's main table, marked where the data are synthetic.
pub fn summary(report: &Report) -> String {
    report.chapters.iter().map(chapter).collect::<Vec<_>>().join("\n\n")
}

fn chapter(chapter: &Chapter) -> String {
    let data = &chapter.section.data;
    let mark = if data.synthetic { " — SYNTHETIC DATA, made by a simulator" } else { "" };
    let main = chapter.tables.iter().find(|table| matches!(table.name, "errors" | "folds"));
    match main {
        Some(table) => format!("{}{mark}\n{}\n{}", data.title, table.title, grid(table)),
        None => format!("{}{mark}\nno scores yet", data.title),
    }
}

fn grid(table: &Table) -> Grid {
    let mut grid = Grid::new();
    grid.load_style(presets::UTF8_FULL_CONDENSED).set_content_arrangement(ContentArrangement::Dynamic);
    grid.set_header(table.columns.iter().map(|column| column.heading()));
    for row in &table.rows {
        grid.add_row(row.cells.iter().zip(&table.columns).map(|(cell, column)| {
            let shown = Shown::new(cell.show(column.digits));
            let shown = if column.text { shown } else { shown.set_alignment(CellAlignment::Right) };
            if matches!(cell, Cell::Best(_)) { shown.add_attribute(Attribute::Bold) } else { shown }
        }));
    }
    grid
}
