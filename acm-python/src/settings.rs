//! Settings as Python has them: a TOML file, or a dictionary with the keys of such a file.

use std::path::{Path, PathBuf};

use pyo3::{prelude::*, types::PyDict};
use serde_json::Value as Json;
use toml::{Table, Value};

use crate::errors::usage;

/// Where values come from.
pub enum Settings {
    /// A TOML file.
    File(PathBuf),
    /// Its keys.
    Keys(Table),
}

impl Settings {
    /// Of a path or a dictionary; nothing is an empty dictionary.
    ///
    /// # Errors
    /// Something else, or a value that TOML has no form for.
    pub fn of(object: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        match object {
            None => Ok(Self::Keys(Table::new())),
            Some(object) if object.is_instance_of::<PyDict>() => Ok(Self::Keys(table(object)?)),
            Some(path) => Ok(Self::File(path.extract()?)),
        }
    }
}

/// A dictionary as the table of a TOML file.
///
/// # Errors
/// A value that TOML has no form for.
pub fn table(object: &Bound<'_, PyAny>) -> PyResult<Table> {
    match toml(json(object)?)? {
        Some(Value::Table(table)) => Ok(table),
        _ => Err(usage("settings are a dictionary, with the keys of a TOML file")),
    }
}

/// A list, of TOML's values.
///
/// # Errors
/// As [`table`].
pub fn list(object: &Bound<'_, PyAny>) -> PyResult<Vec<Value>> {
    match toml(json(object)?)? {
        Some(Value::Array(members)) => Ok(members),
        _ => Err(usage(format!("{object} is no list"))),
    }
}

/// Edits of a file, `key=value` as the command line has them, of a dictionary with dotted keys or tables.
///
/// # Errors
/// As [`table`].
pub fn edits(object: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<String>> {
    let Some(object) = object else { return Ok(vec![]) };
    let mut edits = vec![];
    flatten("", &table(object)?, &mut edits);
    Ok(edits)
}

/// One edit.
pub fn edit(key: &str, path: &Path) -> String {
    format!("{key}={}", Value::from(path.display().to_string()))
}

/// The leaves of a table as edits.
pub fn flatten(prefix: &str, table: &Table, edits: &mut Vec<String>) {
    for (key, value) in table {
        let key = format!("{prefix}{key}");
        match value {
            Value::Table(inner) if !inner.is_empty() => flatten(&format!("{key}."), inner, edits),
            value => edits.push(format!("{key}={value}")),
        }
    }
}

/// What Python's json makes of an object; paths become text, and arrays lists.
fn json(object: &Bound<'_, PyAny>) -> PyResult<Json> {
    let py = object.py();
    let plain = py.import("acm._plain")?.getattr("plain")?;
    let text: String = py.import("json")?.call_method1("dumps", (plain.call1((object,))?,))?.extract()?;
    serde_json::from_str(&text)
        .map_err(|error| usage(format!("{error}; give finite numbers, texts, lists and dictionaries")))
}

/// The same in TOML, which has no null: such keys are left out.
fn toml(value: Json) -> PyResult<Option<Value>> {
    Ok(Some(match value {
        Json::Null => return Ok(None),
        Json::Bool(flag) => Value::Boolean(flag),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => Value::Integer(whole),
            None => Value::Float(number.as_f64().ok_or_else(|| usage(format!("{number} is no number of TOML")))?),
        },
        Json::String(text) => Value::String(text),
        Json::Array(members) => {
            let members: PyResult<Vec<Option<Value>>> = members.into_iter().map(toml).collect();
            Value::Array(members?.into_iter().flatten().collect())
        }
        Json::Object(members) => {
            let mut table = Table::new();
            for (key, member) in members {
                if let Some(member) = toml(member)? {
                    table.insert(key, member);
                }
            }
            Value::Table(table)
        }
    }))
}

/// A value of Rust as plain objects of Python, every number with its bits.
///
/// # Errors
/// A value that JSON has no form for.
pub fn object<'py>(py: Python<'py>, value: &impl serde::Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| usage(error.to_string()))?;
    py.import("json")?.call_method1("loads", (text,))
}
