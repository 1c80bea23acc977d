//! Tables of root mean squares for the terminal.

use comfy_table::{CellAlignment, Table, presets::UTF8_BORDERS_ONLY};

use super::rms::Rms;
use crate::{
    record::DataStamp,
    summary::{shown_unit, total_name},
};

/// A table under its title; all columns but the first `words` are numbers.
pub fn table(title: &str, header: &[String], rows: Vec<Vec<String>>, words: usize) -> String {
    let mut table = Table::new();
    table.load_style(UTF8_BORDERS_ONLY).set_header(header.to_vec());
    table.add_rows(rows);
    for column in table.column_iter_mut().skip(words) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    format!("{title}\n{table}")
}

/// Components and total, as shown: lengths in mm.
pub fn cells(rms: &Rms, data: &DataStamp) -> Vec<String> {
    rms.components.iter().chain([&rms.total]).map(|value| cell(*value, data)).collect()
}

/// One value, as shown.
pub fn cell(value: f64, data: &DataStamp) -> String {
    format!("{:.2}", value * shown_unit(&data.unit).0)
}

/// Heads of the columns that [`cells`] fills.
pub fn heads(outputs: &[String]) -> Vec<String> {
    let total = total_name(outputs.len());
    outputs.iter().cloned().chain([total.to_string()]).collect()
}

/// The data's title, with a word that says so where they are synthetic.
pub fn title(data: &DataStamp) -> String {
    let kind = if data.synthetic { " — synthetic data" } else { "" };
    format!("{}{kind}", data.title)
}

/// Joins literal heads and computed ones.
pub fn header(first: &[&str], rest: Vec<String>) -> Vec<String> {
    first.iter().map(ToString::to_string).chain(rest).collect()
}
