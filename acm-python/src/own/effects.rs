//! Effects of one's own, as an argument of the loop.

use std::path::PathBuf;

use acm_core::effects::own::read;
use pyo3::{prelude::*, types::PyString};
use toml::{Table, Value};

use crate::{
    errors::usage,
    settings::{list, table},
};

/// Name of what holds effects that Python made.
const PYTHON: &str = "Python";

/// Keys of a loop's configuration that name `effects`: an effect file, an effect, or a list of them and of dictionaries with the keys of
/// `[[effect]]`.
///
/// # Errors
/// Something else, or two files.
pub fn keys(effects: &Bound<'_, PyAny>) -> PyResult<Table> {
    let is_one = is_path(effects)? || effects.hasattr("definition")?;
    let members = if is_one { vec![effects.clone()] } else { effects.try_iter()?.collect::<PyResult<Vec<_>>>()? };
    let (mut keys, mut defined) = (Table::new(), vec![]);
    for member in members {
        if !is_path(&member)? {
            defined.push(definition(member)?);
        } else if let Some(other) =
            keys.insert("file".into(), member.extract::<PathBuf>()?.display().to_string().into())
        {
            return Err(usage(format!("{member} and {other} are two effect files; put their effects into one")));
        }
    }
    if !defined.is_empty() {
        keys.insert("define".into(), Value::Array(defined));
    }
    Ok(Table::from_iter([("effects".to_string(), keys.into())]))
}

fn is_path(object: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(object.is_instance_of::<PyString>() || object.hasattr("__fspath__")?)
}

/// An effect as a table.
fn definition(effect: Bound<'_, PyAny>) -> PyResult<Value> {
    let refused = |_| usage("an effect is a file, an acm.Effect, or a dictionary with the keys of [[effect]]");
    table(&effect.getattr("definition").unwrap_or(effect)).map(Value::Table).map_err(refused)
}

/// An effect file of definitions, each a dictionary with the keys of `[[effect]]`, once they are checked.
///
/// # Errors
/// A definition that cannot be carried out on any rig.
#[pyfunction]
pub fn effects_text(definitions: &Bound<'_, PyAny>) -> PyResult<String> {
    let file = Table::from_iter([("effect".to_string(), Value::Array(list(definitions)?))]);
    let text = toml::to_string(&file).map_err(|error| usage(error.to_string()))?;
    read(&text, PYTHON).map_err(|error| usage(error.to_string()))?;
    Ok(text)
}
