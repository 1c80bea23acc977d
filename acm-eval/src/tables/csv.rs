//! A table as comma-separated values, with every digit.

use super::{Cell, Column, Row, Table};
use crate::spread::Spread;

impl Table {
    /// Comma-separated values with every digit; `mean ± sd` becomes two columns.
    pub fn csv(&self) -> String {
        let spread: Vec<bool> =
            (0..self.columns.len()).map(|c| self.rows.iter().any(|row| has_sd(&row.cells[c]))).collect();
        let mut lines = vec![self.csv_heading(&spread)];
        lines.extend(self.rows.iter().map(|row| csv_row(row, &spread)));
        lines.join("\n") + "\n"
    }

    fn csv_heading(&self, spread: &[bool]) -> String {
        let heading = |(column, &spread): (&Column, &bool)| match spread {
            true => vec![column.heading(), format!("sd of {}", column.heading())],
            false => vec![column.heading()],
        };
        let fields: Vec<String> = self.columns.iter().zip(spread).flat_map(heading).map(|name| quoted(&name)).collect();
        fields.join(",")
    }
}

fn csv_row(row: &Row, spread: &[bool]) -> String {
    let mut fields = Vec::new();
    for (cell, &spread) in row.cells.iter().zip(spread) {
        let (value, sd) = match cell {
            Cell::Text(text) => (quoted(text), None),
            Cell::Count(count) => (count.to_string(), None),
            Cell::Number(s) | Cell::Best(s) => (s.mean.to_string(), s.sd),
            Cell::Empty => (String::new(), None),
        };
        fields.push(value);
        if spread {
            fields.push(sd.map_or(String::new(), |sd| sd.to_string()));
        }
    }
    fields.join(",")
}

fn has_sd(cell: &Cell) -> bool {
    matches!(cell, Cell::Number(Spread { sd: Some(_), .. }) | Cell::Best(Spread { sd: Some(_), .. }))
}

fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(mean: f64, sd: Option<f64>) -> Cell {
        Cell::Number(Spread { mean, sd })
    }

    fn table(rows: Vec<Vec<Cell>>) -> Table {
        let columns = vec![Column::text("model"), Column::number("x", "mm", 2), Column::number("n", "", 0)];
        let rows = rows.into_iter().map(|cells| Row { cells, ..Row::default() }).collect();
        Table { name: "t", title: String::new(), note: String::new(), columns, rows, folded: false }
    }

    #[test]
    fn csv_has_all_digits_two_columns_for_a_spread_and_quotes_where_needed() {
        let rows = vec![
            vec![Cell::Text("a, \"b\"".into()), number(1.0 / 3.0, Some(0.5)), Cell::Count(12_345)],
            vec![Cell::Text("c".into()), number(2.0, None), Cell::Empty],
        ];
        let expected = "model,x [mm],sd of x [mm],n\n\"a, \"\"b\"\"\",0.3333333333333333,0.5,12345\nc,2,,\n";
        assert_eq!(table(rows).csv(), expected);
    }
}
