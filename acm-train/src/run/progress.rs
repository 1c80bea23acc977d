//! Display of progress: bars on a terminal, plain lines elsewhere, nothing with `--quiet`.
//!
//! All of it goes to stderr, so that stdout holds the table alone; or to whoever asked for the lines.

use std::{
    fmt,
    io::{IsTerminal, Write, stderr},
    sync::Arc,
};

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};

use crate::learn::Epoch;

/// Display of progress.
#[derive(Debug, Clone)]
pub enum Progress {
    /// One bar per active run.
    Bars(MultiProgress),
    /// One line per tenth of a run, or one at its end where there are many.
    Lines {
        /// Whether unfinished runs have lines.
        on_the_way: bool,
    },
    /// Lines to a listener instead of stderr.
    Told {
        /// Whether unfinished runs have lines.
        on_the_way: bool,
        /// Receiver of the lines.
        listener: Listener,
    },
    /// No display.
    Quiet,
}

/// Receiver of lines from any thread.
#[derive(Clone)]
pub struct Listener(Arc<dyn Fn(&str) + Send + Sync>);

impl fmt::Debug for Listener {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Listener")
    }
}

/// The progress of one run.
#[derive(Debug)]
pub struct RunProgress {
    whole: Progress,
    id: String,
    epochs: usize,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Returns bars where stderr is a terminal, else lines; nothing if `quiet`.
    pub fn new(quiet: bool) -> Self {
        match (quiet, stderr().is_terminal()) {
            (true, _) => Self::Quiet,
            (false, true) => Self::Bars(MultiProgress::new()),
            (false, false) => Self::Lines { on_the_way: true },
        }
    }

    /// Returns a display of lines that `listener` receives.
    pub fn told(listener: impl Fn(&str) + Send + Sync + 'static) -> Self {
        Self::Told { on_the_way: true, listener: Listener(Arc::new(listener)) }
    }

    /// Returns the display for many runs: lines at their ends alone.
    pub fn of_many(&self) -> Self {
        match self {
            Self::Lines { .. } => Self::Lines { on_the_way: false },
            Self::Told { listener, .. } => Self::Told { on_the_way: false, listener: listener.clone() },
            other => other.clone(),
        }
    }

    /// Returns a bar over all runs, where there are many and bars are shown.
    pub fn whole(&self, runs: usize) -> Option<ProgressBar> {
        match self {
            Self::Bars(bars) if runs > 1 => {
                let style = ProgressStyle::with_template("all runs       {bar:30} {pos}/{len} runs, {eta} left")
                    .unwrap_or_else(|_| ProgressStyle::default_bar());
                Some(bars.add(ProgressBar::new(runs as u64).with_style(style)))
            }
            _ => None,
        }
    }

    /// Shows one line.
    pub fn note(&self, line: &str) {
        match self {
            Self::Bars(bars) => drop(bars.println(line)),
            // A closed stderr is no reason to stop a training.
            Self::Lines { .. } => drop(writeln!(stderr(), "{line}")),
            Self::Told { listener, .. } => (listener.0)(line),
            Self::Quiet => {}
        }
    }

    /// Starts the display of one run.
    pub fn begin(&self, id: &str, epochs: usize) -> RunProgress {
        let bar = match self {
            Self::Bars(bars) => {
                Some(bars.add(ProgressBar::new(epochs as u64).with_style(style()).with_prefix(id.to_string())))
            }
            Self::Lines { .. } | Self::Told { .. } | Self::Quiet => None,
        };
        RunProgress { whole: self.clone(), id: id.to_string(), epochs, bar }
    }
}

impl RunProgress {
    /// Shows a finished epoch.
    pub fn epoch(&self, epoch: &Epoch) {
        let losses = format!("training {:.4}, validation {:.4}", epoch.train_loss, epoch.validation_loss);
        if let Some(bar) = &self.bar {
            bar.set_message(losses);
            bar.set_position(epoch.epoch as u64);
        } else if matches!(self.whole, Progress::Lines { on_the_way: true } | Progress::Told { on_the_way: true, .. })
            && tenth(epoch.epoch, self.epochs) != tenth(epoch.epoch.saturating_sub(1), self.epochs)
        {
            self.whole.note(&format!("{}: epoch {}/{}, {losses}", self.id, epoch.epoch, self.epochs));
        }
    }

    /// Ends the display of the run with its `outcome`.
    pub fn end(self, outcome: &str) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
        self.whole.note(&format!("{}: {outcome}", self.id));
    }
}

fn tenth(epoch: usize, epochs: usize) -> usize {
    10 * epoch / epochs.max(1)
}

fn style() -> ProgressStyle {
    ProgressStyle::with_template("{prefix:14} {bar:30} {pos}/{len} epochs, {eta} left  {wide_msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
}
