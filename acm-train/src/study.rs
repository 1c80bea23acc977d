//! Studies: files that ask for more than one experiment. Their key `study` says which kind they are.
//!
//! | `study`      | asks                                                                 | answered by             |
//! | ------------ | -------------------------------------------------------------------- | ----------------------- |
//! | `sweep`      | which of many settings has the smallest validation error             | [`conduct`]             |
//! | `ablation`   | by how much errors grow, change by change                            | [`conduct`]             |
//! | `comparison` | which of several models errs least, under one protocol or several    | [`conduct`]             |
//! | `nominal`    | how many strain orders, and how well the nominal model is calibrated | [`nominal`]             |
//! | `residual`   | what the nominal model misses in flight                              | [`residual`]            |
//! | `sequences`  | what elapsed time tells of sequences that are no trials              | [`sequences`]           |
//!
//! Each of the first three is a list of edits to experiments ([`list`]); the next two train nothing.

mod conduct;
pub mod list;
pub mod paired;
pub mod record;
pub mod sweep;
pub mod table;

use acm_datasets::spelling::meant;
use serde::{Deserialize, Serialize};
use toml::Value;

use crate::{
    descriptive::{nominal, residual},
    engine::Engine,
    error::TrainError,
    experiment::{Fault, Source},
    job::Request,
    sequences,
};

/// What a study asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Which setting is best.
    Sweep,
    /// What each change costs.
    Ablation,
    /// Which model is best.
    Comparison,
    /// Strain orders, strain against polynomial, trials left out.
    Nominal,
    /// The residual by component, altitude and slice.
    Residual,
    /// What elapsed time tells.
    Sequences,
}

/// Names of the kinds, as a file writes them.
const KINDS: &[(&str, Kind)] = &[
    ("sweep", Kind::Sweep),
    ("ablation", Kind::Ablation),
    ("comparison", Kind::Comparison),
    ("nominal", Kind::Nominal),
    ("residual", Kind::Residual),
    ("sequences", Kind::Sequences),
];

/// The kind of study that a file asks for; `None` for a single experiment.
///
/// # Errors
/// There is no such kind.
pub fn kind(source: &Source) -> Result<Option<Kind>, TrainError> {
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

/// Conducts a study, and returns what is to be printed.
///
/// # Errors
/// Anything in [`TrainError`]; what is finished is kept.
pub fn conduct(kind: Kind, source: Source, request: &Request) -> Result<String, TrainError> {
    if let (Kind::Nominal | Kind::Residual, Engine::Slurm(_)) = (kind, request.engine) {
        return Err(TrainError::Usage {
            what: "this study trains nothing, so there is nothing to submit".into(),
            help: "leave --engine slurm out: it takes seconds".into(),
        });
    }
    match kind {
        Kind::Sweep | Kind::Ablation | Kind::Comparison => conduct::conduct(kind, &source, request),
        Kind::Nominal => nominal::conduct(&source, request),
        Kind::Residual => residual::conduct(&source, request),
        Kind::Sequences => sequences::conduct(source, request),
    }
}
