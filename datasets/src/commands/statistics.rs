//! `acm-data statistics`: the synthetic campaign beside the paper's.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use acm_datasets::files::regular;
use acm_datasets::generate::{StatisticsError, samples_in_domain, statistics, store};
use acm_datasets::{Campaign, DataError, Trial};
use acm_sim::twin::Floors;

use acm_datasets::describe::table::table;

pub fn run(folder: &Path, data: Option<&PathBuf>, text: &mut String) -> Result<(), DataError> {
    let campaign = Campaign::read(folder, data.map(PathBuf::as_path))?;
    let mut shown = table(&["error, mm", "paper (measured)", "this set", "difference"], 1);
    for row in statistics(&campaign).map_err(refused)? {
        let difference = format!("{:+.1} %", 100.0 * row.deviation());
        shown.add_row([row.name.clone(), format!("{:.2}", row.paper_mm), format!("{:.2}", row.twin_mm), difference]);
    }
    let samples: usize = campaign.trials.iter().map(Trial::samples).sum();
    let synthetic = if campaign.manifest.synthetic { " (SYNTHETIC)" } else { "" };
    let _ =
        writeln!(text, "{}{synthetic}: {} trials, {samples} samples", campaign.manifest.name, campaign.trials.len());
    let _ = writeln!(text, "{shown}");
    let kept = samples_in_domain(&campaign)?;
    let _ = writeln!(text, "hover samples in the calibrated domain: {kept} (paper 13922)");
    if let Some(floors) = floors(folder)? {
        let trials = floors.trials.join(", ");
        let _ = writeln!(
            text,
            "floors on trials {trials}, 3-D: oracle {:.2} mm, memoryless {:.2} mm",
            floors.oracle_mm, floors.memoryless_mm
        );
    }
    Ok(())
}

/// The floors that are stored with a synthetic set.
fn floors(folder: &Path) -> Result<Option<Floors>, DataError> {
    let path = folder.join(store::FLOORS);
    if !path.exists() {
        return Ok(None);
    }
    let text = regular::read_to_string(&path).map_err(|e| DataError::file_system("read", &path, &e))?;
    let damaged = |e: serde_json::Error| DataError::Damaged { path: path.clone(), reason: e.to_string() };
    serde_json::from_str(&text).map(Some).map_err(damaged)
}

/// A set without these statistics.
pub fn refused(error: StatisticsError) -> DataError {
    match error {
        StatisticsError::Data(error) => error,
        other => DataError::Usage(other.to_string()),
    }
}
