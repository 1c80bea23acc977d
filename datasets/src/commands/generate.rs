//! `acm-data generate`: the synthetic flight campaign, campaigns with undeclared effects, small rigs.

use std::fmt::Write;
use std::path::Path;

use acm_datasets::generate::{self, undeclared};
use acm_datasets::{Campaign, DataError, Trial, manifest::written};
use acm_sim::small_rigs::{Kind as Rig, oracle, simulate};
use acm_sim::twin::undeclared::{Design, Kind};
use acm_sim::twin::{self, TwinSettings};

use super::progress::Progress;

/// How the manifests of all sets begin that are made here.
const MARK: &str = "# Written by `acm-data generate`";

pub fn run(out: &Path, seed: u64, floors: bool, text: &mut String) -> Result<(), DataError> {
    make_place(out)?;
    let settings = TwinSettings::default();
    let progress = Progress::new();
    let campaign = twin::generate(&settings, seed, &|done, all| progress.show(done, all));
    let campaign = campaign.map_err(|e| DataError::Usage(e.to_string()))?;
    progress.end();
    generate::write(&campaign, &settings, out)?;
    let read = Campaign::read(out, None)?;
    let rows = generate::statistics(&read).map_err(super::statistics::refused)?;
    generate::write_json(&rows, &out.join(generate::store::STATISTICS))?;
    if floors {
        let found = twin::floors(&settings, seed, twin::FloorEffort::default());
        generate::write_json(&found.map_err(|e| DataError::Usage(e.to_string()))?, &out.join(generate::store::FLOORS))?;
    }
    let samples: usize = read.trials.iter().map(Trial::samples).sum();
    let (folder, trials) = (out.display(), read.trials.len());
    let _ = writeln!(text, "{folder}: {trials} synthetic trials, {samples} samples, seed {seed}, sha256 {}", read.hash);
    super::next(text, "acm-data", "statistics", out, "");
    Ok(())
}

/// The campaign many times over, in a stream.
pub fn repeated(out: &Path, seed: u64, scale: usize, text: &mut String) -> Result<(), DataError> {
    make_place(out)?;
    let progress = Progress::new();
    generate::write_repeated(&TwinSettings::default(), seed, scale, out, &|done, all| progress.show(done, all))?;
    progress.end();
    let (folder, trials) = (out.display(), scale * twin::schedule::TRIALS);
    let _ = writeln!(text, "{folder}: {trials} synthetic trials, {scale} times the campaign, seed {seed}");
    super::next(text, "acm-data", "check", out, "");
    Ok(())
}

/// Says nothing of what acts in the campaign: that is for `sealed/truth.json`.
pub fn undeclared(
    out: &Path,
    seed: u64,
    design: Design,
    kind: Option<Kind>,
    text: &mut String,
) -> Result<(), DataError> {
    make_place(out)?;
    let made = undeclared::generate(seed, design, kind).map_err(|e| DataError::Usage(e.to_string()))?;
    undeclared::write(&made, out)?;
    told(out, seed, &format!("{} excitation, ", design.name()), text)
}

/// A small rig; what acts in it, and what whoever knows that is left with, stands under seal.
pub fn small_rig(out: &Path, seed: u64, kind: Rig, text: &mut String) -> Result<(), DataError> {
    make_place(out)?;
    let made = simulate(kind, seed);
    generate::small_rig::write(&made, &oracle(&made), out)?;
    told(out, seed, "", text)
}

/// What was written, as it reads again.
fn told(out: &Path, seed: u64, how: &str, text: &mut String) -> Result<(), DataError> {
    let read = Campaign::read(out, None)?;
    let samples: usize = read.trials.iter().map(Trial::samples).sum();
    let (folder, trials) = (out.display(), read.trials.len());
    let count = format!("{trials} synthetic trials, {samples} samples");
    let _ = writeln!(text, "{folder}: {count}, {how}seed {seed}, sha256 {}", read.hash);
    let _ = writeln!(text, "under seal: {folder}/{}", undeclared::store::TRUTH);
    super::next(text, "acm-eval", "close-loop", out, "");
    Ok(())
}

/// Makes the folder of a new set, before the work and not after it. A set that was not made here is left alone.
fn make_place(out: &Path) -> Result<(), DataError> {
    written::claim(out, MARK)?;
    std::fs::create_dir_all(out).map_err(|e| DataError::file_system("create", out, &e))
}
