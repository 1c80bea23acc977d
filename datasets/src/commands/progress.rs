//! How many trials are made: a bar on a terminal, a line now and then elsewhere.

use std::io::{Write, stderr};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

/// Time between two lines; short work says nothing.
const PAUSE: Duration = Duration::from_secs(10);

/// Progress of one generation.
pub struct Progress {
    bar: ProgressBar,
    last_line: Mutex<Instant>,
}

impl Progress {
    /// Nothing is made yet.
    pub fn new() -> Self {
        let style = ProgressStyle::with_template("{bar:40} {pos}/{len} trials, {eta} left");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        Self { bar: ProgressBar::new(0).with_style(style), last_line: Mutex::new(Instant::now()) }
    }

    /// `done` trials of `all` are made.
    pub fn show(&self, done: usize, all: usize) {
        self.bar.set_length(all as u64);
        self.bar.set_position(done as u64);
        let Ok(mut last_line) = self.last_line.lock() else { return };
        if self.bar.is_hidden() && last_line.elapsed() >= PAUSE {
            *last_line = Instant::now();
            // A closed stderr is no reason to stop.
            let _ = writeln!(stderr(), "{done} of {all} trials, {} left", HumanDuration(self.bar.eta()));
        }
    }

    /// All is made.
    pub fn end(self) {
        self.bar.finish_and_clear();
    }
}
