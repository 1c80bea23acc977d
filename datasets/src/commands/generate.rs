//! `acm-data generate`: the synthetic flight campaign, and campaigns with an undeclared effect.

use std::fmt::Write;
use std::path::Path;

use acm_datasets::twin::undeclared::{self, Design};
use acm_datasets::{Campaign, DataError, twin};
use indicatif::{ProgressBar, ProgressStyle};

pub fn run(out: &Path, seed: u64, floors: bool, text: &mut String) -> Result<(), DataError> {
    // before the work, not after it
    std::fs::create_dir_all(out).map_err(|e| DataError::file_system("create", out, &e))?;
    let settings = twin::TwinSettings::default();
    let bar = ProgressBar::new(0);
    let progress = |done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    };
    let campaign = twin::generate(&settings, seed, &progress).map_err(|e| DataError::Usage(e.to_string()))?;
    bar.finish_and_clear();
    twin::write(&campaign, &settings, out)?;
    let read = Campaign::read(out, None)?;
    let rows = twin::statistics(&read).map_err(super::statistics::refused)?;
    twin::write_json(&rows, &out.join(twin::store::STATISTICS))?;
    if floors {
        let found = twin::floors(&settings, seed, twin::FloorEffort::default());
        twin::write_json(&found.map_err(|e| DataError::Usage(e.to_string()))?, &out.join(twin::store::FLOORS))?;
    }
    let samples: usize = read.trials.iter().map(|t| t.samples()).sum();
    let (folder, trials) = (out.display(), read.trials.len());
    let _ = writeln!(text, "{folder}: {trials} synthetic trials, {samples} samples, seed {seed}, sha256 {}", read.hash);
    let _ = writeln!(text, "next: acm-data statistics {folder}");
    Ok(())
}

/// The campaign many times over, in a stream.
pub fn repeated(out: &Path, seed: u64, scale: usize, text: &mut String) -> Result<(), DataError> {
    std::fs::create_dir_all(out).map_err(|e| DataError::file_system("create", out, &e))?;
    let bar = ProgressBar::new(0).with_style(
        ProgressStyle::with_template("{bar:40} {pos}/{len} trials, {eta} left")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    let progress = |done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    };
    twin::write_repeated(&twin::TwinSettings::default(), seed, scale, out, &progress)?;
    bar.finish_and_clear();
    let (folder, trials) = (out.display(), scale * twin::schedule::TRIALS);
    let _ = writeln!(text, "{folder}: {trials} synthetic trials, {scale} times the campaign, seed {seed}");
    let _ = writeln!(text, "next: acm-data check {folder}");
    Ok(())
}

/// Says nothing of what acts in the campaign: that is for `sealed/truth.json`.
pub fn undeclared(out: &Path, seed: u64, design: Design, text: &mut String) -> Result<(), DataError> {
    std::fs::create_dir_all(out).map_err(|e| DataError::file_system("create", out, &e))?;
    let made = undeclared::generate(seed, design, None).map_err(|e| DataError::Usage(e.to_string()))?;
    undeclared::write(&made, out)?;
    let read = Campaign::read(out, None)?;
    let samples: usize = read.trials.iter().map(|t| t.samples()).sum();
    let (folder, trials, design) = (out.display(), read.trials.len(), design.name());
    let _ = writeln!(
        text,
        "{folder}: {trials} synthetic trials, {samples} samples, {design} excitation, seed {seed}, sha256 {}",
        read.hash
    );
    let _ = writeln!(text, "under seal: {folder}/{}", undeclared::store::TRUTH);
    let _ = writeln!(text, "next: acm-eval close-loop {folder}");
    Ok(())
}
