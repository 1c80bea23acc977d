//! Constant inputs and targets of the training part.

use acm_datasets::sequences::{Sequence, SequenceSet};
use nalgebra::DMatrix;

use crate::{config::Loss, run::error::RunError};

/// Returns a warning for each input that never changes.
///
/// # Errors
/// No target ever changes.
pub fn look(set: &SequenceSet, loss: Loss) -> Result<Vec<String>, RunError> {
    let targets = constants(&set.training, &set.outputs, |one| &one.targets);
    if targets.len() == set.outputs.len() {
        let what = if loss == Loss::CrossEntropy { "label" } else { "target" };
        let values = targets.iter().map(|(name, value)| format!("{name} is {value}")).collect::<Vec<_>>().join(", ");
        return Err(RunError::Unusable {
            what: format!("the {what} is constant over all {} training sequences: {values}", set.training.len()),
            help: "check the column, and which sequences are in the training part".into(),
        });
    }
    let warn = |(name, value): (&String, f64)| {
        format!(
            "warning: input `{name}` is {value} in all training sequences: a network learns nothing from it; leave it \
             out of data.inputs"
        )
    };
    Ok(constants(&set.training, &set.channels, |one| &one.inputs).into_iter().map(warn).collect())
}

/// Returns the columns with a single value, and that value.
fn constants<'a>(
    sequences: &[Sequence],
    names: &'a [String],
    of: impl Fn(&Sequence) -> &DMatrix<f64>,
) -> Vec<(&'a String, f64)> {
    let constant = |column: usize| {
        let mut values = sequences.iter().flat_map(|one| of(one).column(column).iter().copied().collect::<Vec<_>>());
        let first = values.next()?;
        values.all(|value| value == first).then_some(first)
    };
    names.iter().enumerate().filter_map(|(column, name)| Some((name, constant(column)?))).collect()
}
