//! A table as comma-separated values, with every digit.

use acm_core::display::Display;

use super::{Cell, Column, Digits, Row, Table};

impl Table {
    /// Writes comma-separated values with every digit; `mean ± sd` becomes two columns.
    pub fn csv(&self) -> String {
        let spread: Vec<bool> =
            (0..self.columns.len()).map(|c| self.rows.iter().any(|row| has_sd(&row.cells[c]))).collect();
        let mut lines = vec![self.csv_heading(&spread)];
        lines.extend(self.rows.iter().map(|row| csv_row(row, &self.columns, &spread)));
        lines.join("\n") + "\n"
    }

    fn csv_heading(&self, spread: &[bool]) -> String {
        let heading = |(column, &spread): (&Column, &bool)| {
            let heading = stored(column).label(&column.title);
            let sd = spread.then(|| format!("sd of {heading}"));
            std::iter::once(heading).chain(sd)
        };
        let fields: Vec<String> = self.columns.iter().zip(spread).flat_map(heading).map(|name| quoted(&name)).collect();
        fields.join(",")
    }
}

/// Returns the unit of a column in a file, which does not depend on the size of its numbers, so that files can be
/// combined.
fn stored(column: &Column) -> Display {
    match column.digits {
        Digits::Fixed(_) => column.display.clone(),
        Digits::Significant => Display::fixed(&column.display.si),
    }
}

fn csv_row(row: &Row, columns: &[Column], spread: &[bool]) -> String {
    let mut fields = Vec::new();
    for ((cell, column), &spread) in row.cells.iter().zip(columns).zip(spread) {
        let factor = stored(column).factor;
        let sd = cell.spread().and_then(|spread| spread.sd).map(|sd| (factor * sd).to_string());
        fields.push(match cell {
            Cell::Text(text) => quoted(text),
            Cell::Count(count) => count.to_string(),
            _ => cell.spread().map_or(String::new(), |spread| (factor * spread.mean).to_string()),
        });
        if spread {
            fields.push(sd.unwrap_or_default());
        }
    }
    fields.join(",")
}

fn has_sd(cell: &Cell) -> bool {
    cell.spread().is_some_and(|spread| spread.sd.is_some())
}

/// Returns a field of a file of comma-separated values.
pub(crate) fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spread::Spread;

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

    #[test]
    fn a_file_has_one_unit_whatever_the_page_shows() {
        let column = |size| Column::measure("x", &Display::of("N*m", size));
        let csv = |column: Column| {
            let rows = vec![Row { cells: vec![Cell::number(2.5e-4)], ..Row::default() }];
            let (name, title, note, columns) = ("t", String::new(), String::new(), vec![column]);
            (columns[0].heading(), Table { name, title, note, columns, rows, folded: false }.csv())
        };
        assert_eq!(csv(column(2.5e-4)), ("x [µN·m]".into(), "x [N·m]\n0.00025\n".into()));
        assert_eq!(csv(column(2.5)), ("x [N·m]".into(), "x [N·m]\n0.00025\n".into()));
        assert_eq!(csv(Column::measure("x", &Display::of("m", 2.5e-4))).1, "x [mm]\n0.25\n");
    }
}
