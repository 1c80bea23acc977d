//! A CSV file as rows of fields, with quotes.

use std::path::Path;

/// Headings and rows.
pub struct Csv {
    pub headings: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Csv {
    /// Reads `page/tables/<name>.csv`.
    pub fn read(root: &Path, name: &str) -> Self {
        let path = root.join("page/tables").join(format!("{name}.csv"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut rows = text.lines().map(fields);
        Self { headings: rows.next().unwrap(), rows: rows.collect() }
    }

    /// The row whose first fields are `start`.
    pub fn row(&self, start: &[&str]) -> &[String] {
        let found = self.rows.iter().find(|row| start.iter().zip(row.iter()).all(|(a, b)| a == b));
        found.unwrap_or_else(|| panic!("no row {start:?} in {:?}", self.rows))
    }

    /// The number under `heading`, the `nth` of that name.
    pub fn number(&self, row: &[String], heading: &str, nth: usize) -> f64 {
        let column = (0..self.headings.len()).filter(|&c| self.headings[c] == heading).nth(nth);
        let column = column.unwrap_or_else(|| panic!("no column {heading} in {:?}", self.headings));
        row[column].parse().unwrap_or_else(|_| panic!("{heading}: {:?} is no number", row[column]))
    }
}

fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match (c, quoted) {
            ('"', _) => quoted = !quoted,
            (',', false) => fields.push(String::new()),
            (other, _) => fields.last_mut().unwrap().push(other),
        }
    }
    fields
}
