//! One campaign: made, traced as a user's recordings would be, and only then compared with the truth.

use acm_datasets::twin::undeclared::generate;
use acm_trace::close::{About, close};
use acm_trace::finding::Data;
use acm_trace::trace::Options;

use super::{plan::Task, row::Row};
use crate::{error::EvalError, recordings::recordings};

/// Tries one campaign.
///
/// # Errors
/// An arm without equilibrium, or a nominal model that cannot be calibrated: both would be faults of the program.
pub fn attempt(task: &Task, options: &Options) -> Result<Row, EvalError> {
    let refuse =
        |error: &dyn std::fmt::Display| EvalError::Data(format!("seed {}, {}: {error}", task.seed, task.design.name()));
    let made = generate(task.seed, task.design, Some(task.kind)).map_err(|error| refuse(&error))?;
    let (campaign, truth) = (made.campaign, made.truth);
    let own = task.without_own.then(|| truth.names().into_iter().map(String::from)).into_iter().flatten();
    let options = Options { without: options.without.iter().cloned().chain(own).collect(), ..options.clone() };
    let given = recordings(&campaign, campaign.nominal_spec(), false)?;
    let about = About {
        data: Data {
            name: campaign.manifest.name.clone(),
            title: campaign.manifest.title.clone(),
            hash: campaign.hash.clone(),
            synthetic: true,
            calibration: vec![],
            development: vec![],
            untouched: vec![],
        },
        configuration: serde_json::Value::Null,
        version: env!("CARGO_PKG_VERSION").into(),
        cautions: given.cautions,
    };
    let closed = close(given.case, about, &options, |_| {}).map_err(|error| refuse(&error))?;
    Ok(Row::new(task, &truth, &closed.finding))
}
