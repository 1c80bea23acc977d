//! A campaign as a folder: table, manifest, and a sealed truth file.

use super::UndeclaredCampaign;
use crate::error::DataError;
use crate::files::atomic::write_bytes;
use crate::files::table::{Column, write_parquet};
use crate::manifest::Manifest;
use crate::trial::Trial;
use std::path::Path;

/// Name of the table.
pub const TABLE: &str = "campaign.parquet";
/// Place of the truth.
pub const TRUTH: &str = "sealed/truth.json";

/// Writes the data set; the same campaign gives the same bytes.
///
/// # Errors
/// The file system.
pub fn write(made: &UndeclaredCampaign, folder: &Path) -> Result<(), DataError> {
    let sealed = folder.join(TRUTH);
    if let Some(parent) = sealed.parent() {
        std::fs::create_dir_all(parent).map_err(|e| DataError::file_system("create", parent, &e))?;
    }
    write_parquet(&folder.join(TABLE), &columns(&made.campaign.trials))?;
    let note = "x, y, z: tip relative to the attachment, world axes, z up.";
    write_manifest(&made.campaign.manifest, note, folder)?;
    crate::generate::store::write_json(&made.truth, &sealed)
}

/// Columns of the table, trials below each other.
fn columns(trials: &[Trial]) -> Vec<(String, Column)> {
    let numbers = |of: &dyn Fn(&Trial) -> Vec<f64>| Column::Number(trials.iter().flat_map(of).collect());
    let name = |trial: &Trial| vec![trial.name.clone(); trial.samples()];
    let mut all = vec![
        ("trial".to_string(), Column::Text(trials.iter().flat_map(name).collect())),
        ("t".to_string(), numbers(&|trial| trial.time.clone())),
    ];
    for (column, name) in ["q1", "q2"].into_iter().enumerate() {
        all.push((name.into(), numbers(&|trial| trial.actuators.column(column).iter().copied().collect())));
    }
    for (column, name) in ["altitude", "throttle"].into_iter().enumerate() {
        all.push((name.into(), numbers(&|trial| trial.context.column(column).iter().copied().collect())));
    }
    for (column, name) in ["px", "py", "pz"].into_iter().enumerate() {
        let of = |trial: &Trial| {
            trial.vehicle.as_ref().map_or(vec![], |vehicle| vehicle.column(column).iter().copied().collect())
        };
        all.push((name.into(), numbers(&of)));
    }
    for (column, name) in ["x", "y", "z"].into_iter().enumerate() {
        all.push((name.into(), numbers(&|trial| trial.measured.column(column).iter().copied().collect())));
    }
    all
}

/// Writes a manifest that was made here, with a note at its head.
///
/// # Errors
/// The file system.
pub fn write_manifest(manifest: &Manifest, note: &str, folder: &Path) -> Result<(), DataError> {
    write_bytes(&folder.join("manifest.toml"), text(manifest, note, folder)?.as_bytes())
}

/// The manifest as TOML, without what it leaves open.
fn text(manifest: &Manifest, note: &str, folder: &Path) -> Result<String, DataError> {
    let refused = |e: toml::ser::Error| DataError::Usage(format!("{}: cannot be written: {e}", folder.display()));
    let mut table = toml::Table::try_from(manifest).map_err(refused)?;
    prune(&mut table);
    let head = format!("# Written by `acm-data generate`. {note}\n\n");
    Ok(format!("{head}{}", toml::to_string(&table).map_err(refused)?))
}

/// Takes out empty text, lists and tables: every key has a default.
fn prune(table: &mut toml::Table) {
    for (_, value) in table.iter_mut() {
        if let toml::Value::Table(inner) = value {
            prune(inner);
        }
        if let toml::Value::Array(list) = value {
            list.iter_mut().filter_map(|item| item.as_table_mut()).for_each(prune);
        }
    }
    let empty = |value: &toml::Value| match value {
        toml::Value::String(text) => text.is_empty(),
        toml::Value::Array(list) => list.is_empty(),
        toml::Value::Table(inner) => inner.is_empty(),
        _ => false,
    };
    table.retain(|_, value| !empty(value));
}
