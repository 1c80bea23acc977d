//! The synthetic campaign repeated many times with other seeds, written as a stream.
//!
//! ```text
//! repetition r = 0, 1, …, scale − 1   seeds of its own      trial `7-013` is trial 7 of repetition 13
//! trial-07.parquet                    trial 7 of every repetition, a group of rows for each few
//! ```
//!
//! Every trial is simulated: excitation, flight, air and noise are drawn again, and no row is a copy. Repetition 0 is the
//! campaign of the seed itself. A table that is there already, beside the very manifest that would be written, is kept,
//! so that a generation that was interrupted goes on where it was. One process at a time writes in a folder.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use acm_sim::twin::campaign::{SyntheticTrial, TwinError, run_trial};
use acm_sim::twin::random::Seeds;
use acm_sim::twin::schedule::{TRIALS, plan};
use acm_sim::twin::settings::TwinSettings;

use super::store::{Described, columns, described};
use crate::error::DataError;
use crate::files::atomic::{make_folder, sweep, write_bytes};
use crate::files::lock::{self, Lock, Refused};
use crate::files::regular;
use crate::files::table::write_parquet_groups;

/// Most repetitions: the manifest names every trial, and is to stay a file that can be read.
pub const MOST: usize = 1000;

/// Trials of one group of rows: about 16,000 samples.
const GROUP: usize = 12;

/// Groups that are simulated before they are written, so that many threads have work.
const AHEAD: usize = 4;

/// Writes `scale` repetitions of the campaign into `folder`; `progress` is called with (trials done, trials in all).
///
/// The same seed and scale give the same bytes, on any number of threads.
///
/// # Errors
/// The settings have no meaning, the simulator finds no equilibrium, another process writes there, or the file system
/// refuses.
pub fn write_repeated(
    settings: &TwinSettings,
    seed: u64,
    scale: usize,
    folder: &Path,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<(), DataError> {
    settings.validate().map_err(|e| refused(e.into()))?;
    let _lock = claim(folder)?;
    let manifest = manifest(settings, seed, scale);
    let path = folder.join("manifest.toml");
    let interrupted = regular::read(&path).is_ok_and(|found| found == manifest.as_bytes());
    write_bytes(&path, manifest.as_bytes())?;
    let done = AtomicUsize::new(0);
    let count = |trials: usize| progress(done.fetch_add(trials, Ordering::Relaxed) + trials, TRIALS * scale);
    for number in 1..=TRIALS {
        let path = folder.join(table(number));
        if interrupted && path.is_file() {
            count(scale);
            continue;
        }
        let run = |repetition: usize| {
            let seeds = Seeds::of_repetition(seed, repetition);
            let trial = run_trial(settings, &plan(settings, number, &seeds), &seeds);
            count(1);
            trial.map(|trial| (repetition, trial))
        };
        write_parquet_groups(&path, groups(number, scale, &run))?;
    }
    Ok(())
}

/// Makes the folder if need be, claims it, and removes what a killed process was writing.
fn claim(folder: &Path) -> Result<Lock, DataError> {
    make_folder(folder).map_err(|error| DataError::file_system("create", folder, &error))?;
    let path = folder.join(".lock");
    let lock = lock::take(&path).map_err(|refused| match refused {
        Refused::Held(holder) => DataError::InUse { folder: folder.into(), holder },
        Refused::Io(error) => DataError::file_system("lock", path, &error),
    })?;
    sweep(folder)?;
    Ok(lock)
}

/// The groups of rows of one table, a few of them at a time.
fn groups<'a>(
    number: usize,
    scale: usize,
    run: &'a (dyn Fn(usize) -> Result<(usize, SyntheticTrial), TwinError> + Sync),
) -> impl Iterator<Item = Result<Vec<(String, crate::files::table::Column)>, DataError>> + 'a {
    let ahead = AHEAD * GROUP;
    (0..scale).step_by(ahead).flat_map(move |first| {
        let made: Result<Vec<_>, TwinError> =
            (first..scale.min(first + ahead)).into_par_iter().map(run).collect::<Result<_, _>>();
        let made = match made {
            Ok(made) => made,
            Err(error) => return vec![Err(refused(error))],
        };
        made.chunks(GROUP).map(|group| Ok(rows(number, scale, group))).collect()
    })
}

fn rows(number: usize, scale: usize, group: &[(usize, SyntheticTrial)]) -> Vec<(String, crate::files::table::Column)> {
    let named = group.iter().map(|(repetition, trial)| (name(number, *repetition, scale), trial));
    columns(named)
}

/// Trial `number` of a repetition, with as many digits as the last one has.
fn name(number: usize, repetition: usize, scale: usize) -> String {
    let digits = (scale - 1).to_string().len();
    format!("{number}-{repetition:0digits$}")
}

fn table(number: usize) -> String {
    format!("trial-{number:02}.parquet")
}

fn manifest(settings: &TwinSettings, seed: u64, scale: usize) -> String {
    let title = format!("Synthetic flight campaign, {scale} times with other seeds (simulated, not measured)");
    let files: Vec<String> = (1..=TRIALS).map(table).collect();
    let set = Described { name: &format!("acm-twin-{scale}"), title: &title, files: &files, seed };
    described(settings, &set, &|number| (0..scale).map(|repetition| name(number, repetition, scale)).collect())
}

fn refused(error: TwinError) -> DataError {
    DataError::Usage(error.to_string())
}
