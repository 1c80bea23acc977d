//! The examples of a part: windows, or the spans through which a network carries its state.
//!
//! `each` shows the series of the part to a function, one after the other.

use acm_datasets::{Series, windows_of};

use crate::config::Experiment;
use crate::learn::{Examples, Scalers, Spans, WindowSet};

/// Returns the examples that a network learns from.
///
/// # Errors
/// What `each` says.
pub fn training<E>(
    experiment: &Experiment,
    scalers: &Scalers,
    each: impl FnOnce(&mut dyn FnMut(&Series)) -> Result<(), E>,
) -> Result<Box<dyn Examples>, E> {
    let memory = &experiment.memory;
    if !memory.is_trial() {
        return windows(experiment, experiment.windows.stride, scalers, each);
    }
    let mut spans = Spans::empty(scalers);
    each(&mut |series| spans.push_pieces(series, memory.length(), memory.burn_in()))?;
    Ok(Box::new(spans))
}

/// Returns the examples that a network predicts: its answers at all targets, in the order of series and time.
///
/// # Errors
/// What `each` says.
pub fn scored<E>(
    experiment: &Experiment,
    scalers: &Scalers,
    each: impl FnOnce(&mut dyn FnMut(&Series)) -> Result<(), E>,
) -> Result<Box<dyn Examples>, E> {
    let stride = experiment.windows.evaluation_stride;
    if !experiment.memory.is_trial() {
        return windows(experiment, stride, scalers, each);
    }
    let (spec, mut spans) = (experiment.targets(stride), Spans::empty(scalers));
    each(&mut |series| spans.push_segments(series, windows_of(0, series, &spec)))?;
    Ok(Box::new(spans))
}

fn windows<E>(
    experiment: &Experiment,
    stride: usize,
    scalers: &Scalers,
    each: impl FnOnce(&mut dyn FnMut(&Series)) -> Result<(), E>,
) -> Result<Box<dyn Examples>, E> {
    let (spec, mut set, mut found, mut index) =
        (experiment.targets(stride), WindowSet::empty(experiment.windows.length, scalers), vec![], 0);
    each(&mut |series| {
        set.push(series);
        found.extend(windows_of(index, series, &spec));
        index += 1;
    })?;
    set.lay(found);
    Ok(Box::new(set))
}
