//! Tables of root mean squares for the terminal.

use acm_core::display::{DIGITS, Display, significant};
use acm_datasets::text::terminal::{MOST_ACROSS, ruled};

use super::rms::Rms;
use crate::run::evaluation::summary::total_name;
use crate::run::record::DataStamp;

/// Returns a table under its title; all columns but the first `words` are numbers.
pub fn table(title: &str, header: &[String], rows: Vec<Vec<String>>, words: usize) -> String {
    format!("{title}\n{}", ruled(header.to_vec(), rows, words))
}

/// Returns how root mean squares of these data are shown, by the largest of them.
pub fn display<'r>(data: &DataStamp, largest_of: impl IntoIterator<Item = &'r Rms>) -> Display {
    Display::of(&data.unit, largest_of.into_iter().map(|rms| rms.total).fold(0.0, f64::max))
}

/// Returns components and total, as shown; the total alone of more outputs than fit.
pub fn cells(rms: &Rms, display: &Display) -> Vec<String> {
    let components = if rms.components.len() > MOST_ACROSS { &[] } else { rms.components.as_slice() };
    components.iter().chain([&rms.total]).map(|value| cell(*value, display)).collect()
}

/// Returns one value, as shown.
pub fn cell(value: f64, display: &Display) -> String {
    significant(value * display.factor, DIGITS)
}

/// Returns the heads of the columns that [`cells`] fills.
pub fn heads(data: &DataStamp, outputs: &[String]) -> Vec<String> {
    let total = total_name(&data.unit, outputs.len());
    let outputs = if outputs.len() > MOST_ACROSS { &[] } else { outputs };
    outputs.iter().cloned().chain([total.to_string()]).collect()
}

/// Returns the data's title, with a word that says so where they are synthetic.
pub fn title(data: &DataStamp) -> String {
    let kind = if data.synthetic { " — synthetic data" } else { "" };
    format!("{}{kind}", data.title)
}

/// Joins literal heads and computed ones.
pub fn header(first: &[&str], rest: Vec<String>) -> Vec<String> {
    first.iter().map(ToString::to_string).chain(rest).collect()
}
