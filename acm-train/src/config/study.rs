//! Kinds of studies, by the key `study`.

use acm_datasets::text::spelling::meant;
use serde::{Deserialize, Serialize};
use toml::Value;

use super::error::ConfigError;
use super::parse::fault::Fault;
use super::parse::source::Source;

/// Kinds of studies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Search for the best setting.
    Sweep,
    /// Ablation: cost of each change.
    Ablation,
    /// Comparison of models.
    Comparison,
    /// Choice of the inputs.
    Inputs,
    /// Choice of the model to be used.
    Best,
    /// Study of the nominal model: strain orders, strain against polynomial, trials left out.
    Nominal,
    /// The residual by component, altitude and slice.
    Residual,
    /// Study of sequences with and without elapsed time.
    Sequences,
}

/// Names of the kinds, as a file writes them.
const KINDS: &[(&str, Kind)] = &[
    ("sweep", Kind::Sweep),
    ("ablation", Kind::Ablation),
    ("comparison", Kind::Comparison),
    ("inputs", Kind::Inputs),
    ("best", Kind::Best),
    ("nominal", Kind::Nominal),
    ("residual", Kind::Residual),
    ("sequences", Kind::Sequences),
];

/// Returns the kind of study that a file asks for; `None` for a single experiment.
///
/// # Errors
/// There is no such kind.
pub fn kind(source: &Source) -> Result<Option<Kind>, ConfigError> {
    let Some(asked) = source.tree.get("study") else {
        let written = meant("study", source.tree.keys().map(String::as_str));
        let help = "did you mean `study`? If not, remove the key: an experiment has none of that name";
        source.refuse_first(written.map(|written| Fault::new(written, "is no key of any file", help)))?;
        return Ok(None);
    };
    let named = |(name, kind): &(&str, Kind)| (asked == &Value::String(name.to_string())).then_some(*kind);
    let found = KINDS.iter().find_map(named);
    let names: Vec<&str> = KINDS.iter().map(|(name, _)| *name).collect();
    let help = || format!("write one of {}, or leave the key out for a single experiment", names.join(", "));
    let refusal =
        found.is_none().then(|| Fault::new("study", format!("is {asked}, and there is no such study"), help()));
    source.refuse_first(refusal)?;
    Ok(found)
}
