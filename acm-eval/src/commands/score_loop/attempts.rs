//! Rows of all that is tried, several at a time, kept on the disk where a folder is named.

use std::io::Write;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use acm_eval::error::EvalError;
use acm_eval::scoring::Tried;
use acm_eval::scoring::kept::Kept;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Returns the rows in the order of the tasks, whichever was done first. Kept rows are not computed again; their lines
/// are printed like any other.
pub fn attempts<K: Tried + Sync, T: Serialize + DeserializeOwned + Clone + Send + Sync>(
    tasks: &[K],
    jobs: NonZeroUsize,
    kept: Option<&Kept<T>>,
    attempt: impl Fn(&K) -> Result<T, EvalError> + Sync,
    line: impl Fn(&T) -> String + Sync,
) -> Result<Vec<T>, EvalError> {
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, Result<T, EvalError>)>> = Mutex::new(Vec::new());
    let one = |task: &K| -> Result<T, EvalError> {
        let Some(kept) = kept else { return attempt(task) };
        let key = task.key();
        if let Some(row) = kept.row(&key) {
            return Ok(row);
        }
        let row = attempt(task)?;
        kept.add(key, &row)?;
        Ok(row)
    };
    let work = || {
        while let Some((k, task)) = {
            let k = next.fetch_add(1, Ordering::SeqCst);
            tasks.get(k).map(|task| (k, task))
        } {
            let row = one(task);
            let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
            match &row {
                // A reader that went away is no reason to stop.
                Ok(row) => drop(writeln!(std::io::stdout(), "{}", line(row))),
                Err(_) => next.store(tasks.len(), Ordering::SeqCst),
            }
            done.push((k, row));
        }
    };
    thread::scope(|scope| (0..jobs.get()).for_each(|_| drop(scope.spawn(work))));
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|(k, _)| *k);
    done.into_iter().map(|(_, row)| row).collect()
}
