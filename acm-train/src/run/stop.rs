//! Ctrl-C: the first makes each run finish its epoch and write its checkpoint, the second ends the process.
//!
//! Neither loses a finished epoch, since checkpoints and records are written whole or not at all.

use std::{
    io::{Write, stderr},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

use super::error::RunError;

/// Request to stop the runs. Clones share it.
#[derive(Debug, Clone, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Listens to SIGINT, SIGTERM and SIGHUP.
    ///
    /// # Errors
    /// The operating system refuses, or another part of the process listens already.
    pub fn on_signals() -> Result<Self, RunError> {
        let stop = Self::default();
        let asked = stop.clone();
        let listen = move || {
            if asked.0.swap(true, Ordering::SeqCst) {
                std::process::exit(130);
            }
            // Nobody may be listening any more.
            drop(writeln!(stderr(), "stopping after this epoch; press Ctrl-C again to stop at once"));
        };
        ctrlc::set_handler(listen).map_err(RunError::Signals)?;
        Ok(stop)
    }

    /// Requests the runs to stop after their epoch.
    pub fn ask(&self) {
        self.0.store(true, Ordering::SeqCst);
    }

    /// Returns whether a stop was requested.
    pub fn asked(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }
}
