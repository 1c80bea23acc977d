//! A table of results: numbers and words in columns, for pandas, polars and people.

use acm_eval::tables::{Cell, Column, Table};
use numpy::PyArray1;
use pyo3::{
    exceptions::PyKeyError,
    prelude::*,
    types::{PyCapsule, PyDict, PyList},
};

use crate::{arrow, values::Values};

/// A table of results. ``pandas.DataFrame.from_arrow(frame)`` and ``polars.DataFrame(frame)`` take it without pyarrow;
/// ``frame["column"]`` is an array of numbers (nan where a cell is empty) or a list of words.
#[pyclass(frozen, module = "acm", mapping)]
pub struct Frame {
    columns: Vec<(String, Values)>,
}

impl Frame {
    /// Of columns of one length.
    pub fn new(columns: Vec<(&str, Values)>) -> Self {
        Self { columns: columns.into_iter().map(|(name, values)| (name.to_string(), values)).collect() }
    }

    /// Of columns whose names are made.
    pub fn named(columns: Vec<(String, Values)>) -> Self {
        Self { columns }
    }

    /// Of a table of a page, with every digit and its standard deviations in columns of their own.
    pub fn of_table(table: &Table) -> Self {
        let of = |(index, column): (usize, &Column)| {
            let cells = || table.rows.iter().map(|row| &row.cells[index]);
            let name = heading(column);
            if column.text {
                return vec![(name, Values::Words(cells().map(|cell| word(cell, column)).collect()))];
            }
            let sd: Vec<Option<f64>> = cells().map(|cell| cell.spread().and_then(|spread| spread.sd)).collect();
            let spread = sd.iter().any(Option::is_some).then(|| (format!("sd of {name}"), Values::Numbers(sd)));
            [(name, Values::Numbers(cells().map(number).collect()))].into_iter().chain(spread).collect()
        };
        Self { columns: table.columns.iter().enumerate().flat_map(of).collect() }
    }

    fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, values)| values.len())
    }

    fn cell(&self, row: usize, values: &Values) -> String {
        match values {
            Values::Numbers(values) => values[row].map_or(String::new(), |value| value.to_string()),
            Values::Words(values) => values[row].clone().unwrap_or_default(),
        }
    }
}

/// The column's title with its SI unit.
fn heading(column: &Column) -> String {
    let unit = &column.display.si;
    if unit.is_empty() { column.title.clone() } else { format!("{} [{unit}]", column.title) }
}

fn word(cell: &Cell, column: &Column) -> Option<String> {
    match cell {
        Cell::Empty => None,
        cell => Some(column.show(cell)),
    }
}

fn number(cell: &Cell) -> Option<f64> {
    match cell {
        Cell::Count(count) => Some(*count as f64),
        cell => cell.spread().map(|spread| spread.mean),
    }
}

#[pymethods]
impl Frame {
    /// Names of the columns.
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.columns.iter().map(|(name, _)| name.clone()).collect()
    }

    fn __len__(&self) -> usize {
        self.rows()
    }

    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let found = self.columns.iter().find(|(own, _)| own == name);
        let (_, values) = found.ok_or_else(|| {
            PyKeyError::new_err(format!("there is no column {name:?}; there are {}", self.columns().join(", ")))
        })?;
        Ok(match values {
            Values::Numbers(values) => {
                let values = values.iter().map(|value| value.unwrap_or(f64::NAN)).collect();
                PyArray1::from_vec(py, values).into_any()
            }
            Values::Words(values) => PyList::new(py, values)?.into_any(),
        })
    }

    /// Columns by name: arrays of numbers, lists of words.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        self.columns.iter().try_for_each(|(name, _)| dict.set_item(name, self.__getitem__(py, name)?))?;
        Ok(dict)
    }

    /// A DataFrame of pandas.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("pandas")?.getattr("DataFrame")?.call1((self.to_dict(py)?,))
    }

    /// A DataFrame of polars.
    fn to_polars<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("polars")?.getattr("DataFrame")?.call1((slf,))
    }

    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // A request is the consumer's wish, which it casts to itself.
        drop(requested_schema);
        arrow::give(py, &self.columns)
    }

    fn __repr__(&self) -> String {
        let row = |row: usize| self.columns.iter().map(|(_, values)| self.cell(row, values)).collect::<Vec<_>>();
        let lines: Vec<Vec<String>> = [self.columns()].into_iter().chain((0..self.rows()).map(row)).collect();
        let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        let line = |cells: &Vec<String>| {
            let padded = cells.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}")).collect::<Vec<_>>();
            padded.join("  ").trim_end().to_string()
        };
        lines.iter().map(line).collect::<Vec<_>>().join("\n")
    }

    /// The table in HTML.
    pub fn _repr_html_(&self) -> String {
        let head: String = self.columns.iter().map(|(name, _)| format!("<th>{}</th>", escaped(name))).collect();
        let cells = |row: usize| -> String {
            self.columns.iter().map(|(_, values)| format!("<td>{}</td>", escaped(&self.cell(row, values)))).collect()
        };
        let rows: String = (0..self.rows()).map(|row| format!("<tr>{}</tr>", cells(row))).collect();
        format!("<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>")
    }
}

/// Text as it stands in HTML, and in an attribute.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
