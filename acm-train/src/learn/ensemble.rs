//! Ensembles: networks that differ in their seed, and whose mean is the prediction.
//!
//! ```text
//! c = Σ_m c_m / M          seed_m = seed + 2³² m
//! ```
//!
//! | symbol | meaning                                     | shape | unit |
//! | ------ | ------------------------------------------- | ----- | ---- |
//! | `c_m`  | what member m says, from 0 to M − 1         | [N×O] | m    |
//! | `c`    | what the ensemble says                      | [N×O] | m    |
//!
//! Member 0 is the network that a run without an ensemble trains. Each member has a checkpoint of its own, so an ensemble
//! continues where it was stopped.

use std::path::{Path, PathBuf};

use acm_models::{Engine, Network};
use nalgebra::DMatrix;

use super::error::LearnError;
use super::examples::Examples;
use super::fit::epoch::Epoch;
use super::fit::task::{Control, Ended, Fitted, Task};
use super::fit::{evaluate, fit, refit};
use super::projection::Projection;

/// Returns the seed of a member; no two members of two seeds below 2³² share one.
pub fn seed(run: u64, member: usize) -> u64 {
    run.wrapping_add((member as u64) << 32)
}

/// Returns the checkpoint of a member, beside that of the run: `final-seed1.safetensors`,
/// `final-seed1-member1.safetensors`.
pub fn checkpoint(of_run: &Path, member: usize) -> PathBuf {
    let stem = of_run.file_stem().unwrap_or_default().to_string_lossy();
    match member {
        0 => of_run.to_path_buf(),
        _ => of_run.with_file_name(format!("{stem}-member{member}.safetensors")),
    }
}

/// Fits all members of a task, one after the other; fewer where the observer of the last stops the fit.
///
/// # Errors
/// As [`fit`].
pub fn fit_members(
    task: &Task,
    training: &dyn Examples,
    validation: &dyn Examples,
    of_run: &Path,
    observer: &mut dyn FnMut(&Epoch) -> Control,
) -> Result<Vec<Fitted>, LearnError> {
    each_member(task, of_run, |task, path| fit(task, training, validation, Some(path), observer))
}

/// Fits all members of a task to all trials ([`refit`]), one after the other.
///
/// # Errors
/// As [`fit`].
pub fn refit_members(
    task: &Task,
    training: &dyn Examples,
    epochs: usize,
    of_run: &Path,
    observer: &mut dyn FnMut(&Epoch) -> Control,
) -> Result<Vec<Fitted>, LearnError> {
    each_member(task, of_run, |task, path| refit(task, training, epochs, path, observer))
}

/// Calls `fit` with the task and the checkpoint of each member, up to one that was stopped.
fn each_member(
    task: &Task,
    of_run: &Path,
    mut fit: impl FnMut(&Task, &Path) -> Result<Fitted, LearnError>,
) -> Result<Vec<Fitted>, LearnError> {
    let mut all: Vec<Fitted> = vec![];
    for member in 0..task.training.members() {
        let task = Task { seed: seed(task.seed, member), ..task.clone() };
        all.push(fit(&task, &checkpoint(of_run, member))?);
        if ended(&all) == Ended::Asked {
            break;
        }
    }
    Ok(all)
}

/// Returns the reason why the last of them ended.
pub fn ended(members: &[Fitted]) -> Ended {
    members.last().map_or(Ended::Epochs, |member| member.ended)
}

/// Returns the mean of predictions.
///
/// # Panics
/// If there are none, or their shapes differ.
pub fn mean(predictions: impl IntoIterator<Item = DMatrix<f64>>) -> DMatrix<f64> {
    let mut all = predictions.into_iter();
    let first = all.next().expect("an ensemble has a member");
    let (sum, count) = all.fold((first, 1.0), |(sum, count), one| (sum + one, count + 1.0));
    sum / count
}

/// Returns the shrinkage factor of the mean: that of the projection on it, or of a single member its own.
pub fn factor(members: &[Fitted], validation: &dyn Examples) -> f64 {
    match members {
        [one] => one.factor,
        all if all.iter().any(|member| member.zero.is_none()) => 1.0,
        all if all.iter().all(|member| member.best_epoch == 0) => 0.0,
        all => projection(all.iter().map(|member| &member.network), validation).factor(),
    }
}

/// Returns the projection of the residual on the mean of the networks.
fn projection<'n>(networks: impl Iterator<Item = &'n Network>, examples: &dyn Examples) -> Projection {
    let (mut sums, mut targets, mut count) = (vec![], vec![], 0.0);
    for network in networks {
        let mut place = 0;
        targets.clear();
        evaluate::walk(&mut Engine::new(network), &network.values(), examples, |predictions, batch| {
            let [predictions, own] = batch.scored(predictions);
            targets.extend_from_slice(&own);
            sums.resize(targets.len().max(sums.len()), 0.0);
            sums[place..].iter_mut().zip(predictions.iter()).for_each(|(sum, p)| *sum += f64::from(*p));
            place += predictions.len();
        });
        count += 1.0;
    }
    let means: Vec<f32> = sums.iter().map(|sum| (sum / count) as f32).collect();
    let rows = targets.len() / examples.outputs();
    examples.residual().map_or(Projection::default(), |scaler| Projection::of(scaler, &means, &targets).over(rows))
}

/// Returns the projections of a member, as one of them has them in the mean; epochs after its last are as the last.
pub fn mean_projections(members: &[Fitted]) -> Vec<Projection> {
    if members.iter().any(|member| member.projections.is_empty()) {
        return vec![];
    }
    let last = members.iter().map(|member| member.projections.len()).max().unwrap_or(0);
    let at = |epoch: usize| {
        let mut sum = Projection::default();
        members.iter().for_each(|member| sum += member.projections[epoch.min(member.projections.len() - 1)]);
        sum.over(members.len())
    };
    (0..last).map(at).collect()
}
