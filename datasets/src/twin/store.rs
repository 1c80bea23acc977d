//! The synthetic campaign as a data set: one Parquet table, a manifest, floors and statistics beside it.

use std::path::Path;

use serde::Serialize;

use super::campaign::{SyntheticCampaign, SyntheticTrial};
use super::schedule::{HELD_OUT, Kind};
use super::settings::TwinSettings;
use crate::atomic::write_bytes;
use crate::error::DataError;
use crate::table::{Column, write_parquet};

/// Name of the table.
pub const TABLE: &str = "campaign.parquet";
/// Name of the file of floors.
pub const FLOORS: &str = "floors.json";
/// Name of the file of statistics.
pub const STATISTICS: &str = "statistics.json";

/// Writes table and manifest into a folder; the same campaign gives the same bytes.
pub fn write(campaign: &SyntheticCampaign, settings: &TwinSettings, folder: &Path) -> Result<(), DataError> {
    write_parquet(&folder.join(TABLE), &columns(campaign))?;
    write_bytes(&folder.join("manifest.toml"), manifest(campaign, settings).as_bytes())
}

/// Writes floors or statistics as JSON; floats are written so that they read back exactly.
pub fn write_json(value: &impl Serialize, path: &Path) -> Result<(), DataError> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|e| DataError::Usage(format!("{}: cannot be written: {e}", path.display())))?;
    write_bytes(path, format!("{text}\n").as_bytes())
}

/// Columns of the table, trials below each other.
pub fn columns(campaign: &SyntheticCampaign) -> Vec<(String, Column)> {
    let numbers =
        |of: &dyn Fn(&SyntheticTrial) -> Vec<f64>| Column::Number(campaign.trials.iter().flat_map(of).collect());
    let name = |trial: &SyntheticTrial| vec![trial.number.to_string(); trial.time.len()];
    let axis = |axis: usize| numbers(&move |trial| trial.tip.iter().map(|tip| tip[axis]).collect());
    let columns = [
        ("trial", Column::Text(campaign.trials.iter().flat_map(name).collect())),
        ("t", numbers(&|trial| trial.time.clone())),
        ("q1", numbers(&|trial| trial.q1.clone())),
        ("q2", numbers(&|trial| trial.q2.clone())),
        ("altitude", numbers(&|trial| trial.altitude.clone())),
        ("throttle", numbers(&|trial| trial.throttle.clone())),
        ("x", axis(0)),
        ("y", axis(1)),
        ("z", axis(2)),
    ];
    columns.map(|(name, column)| (name.to_string(), column)).to_vec()
}

fn manifest(campaign: &SyntheticCampaign, settings: &TwinSettings) -> String {
    let names = |wanted: &dyn Fn(&SyntheticTrial) -> bool| {
        let names = campaign.trials.iter().filter(|trial| wanted(trial));
        names.map(|trial| format!("{:?}", trial.number.to_string())).collect::<Vec<_>>().join(", ")
    };
    let payload: String = campaign
        .trials
        .iter()
        .filter(|trial| trial.kind == Kind::Payload)
        .map(|trial| {
            let grams = 1e3 * settings.arm.payload;
            format!("\n[conditions.{:?}]\npayload = {{ value = {grams:.1}, unit = \"g\" }}\n", trial.number.to_string())
        })
        .collect();
    let held_out = |trial: &SyntheticTrial| HELD_OUT.contains(&trial.number);
    format!(
        "# Written by `acm-data generate`; see README.md for what is simulated.\n\
         {HEAD}\
         source    = \"the simulator of this project (acm-datasets {version}, module twin), seed {seed}\"\n\
         {TABLES}\
         length       = {{ value = {length:?}, unit = \"m\" }}\n\
         {ARM}\n\
         [roles]\n\
         calibration = [{calibration}]\n\
         development = [{development}]\n\
         held_out    = [{held}]   # an altitude that is not in development\n\
         excluded    = [{excluded}]   # with payload\n\
         {FOLDS}{payload}",
        version = env!("CARGO_PKG_VERSION"),
        seed = campaign.seed,
        length = settings.arm.length,
        calibration = names(&|trial| trial.kind == Kind::RotorsOff),
        development = names(&|trial| trial.kind == Kind::Hover && !held_out(trial)),
        held = names(&|trial| trial.kind == Kind::Hover && held_out(trial)),
        excluded = names(&|trial| trial.kind == Kind::Payload),
    )
}

const HEAD: &str = r#"name      = "acm-twin"
title     = "Synthetic flight campaign of an aerial continuum manipulator (simulated, not measured)"
licence   = "CC0-1.0"
synthetic = true
"#;

const TABLES: &str = r#"
[table]
files  = ["campaign.parquet"]
ignore = ["README.md", "floors.json", "statistics.json"]
trial  = { column = "trial" }
time   = { column = "t", unit = "s" }

[[actuator]]   # reciprocates
column = "q1"
unit   = "rad"

[[actuator]]   # held in each trial
column = "q2"
unit   = "rad"

[[context]]    # of the arm's attachment over the ground
column = "altitude"
unit   = "m"

[[context]]
column = "throttle"
unit   = "1"

[[measured]]   # tip relative to the attachment, world axes, z up
column = "x"
unit   = "m"

[[measured]]
column = "y"
unit   = "m"

[[measured]]
column = "z"
unit   = "m"

[arm]
"#;

const ARM: &str = r#"axis         = "-z"
strain       = { basis = "legendre", order = 1 }
actuation    = { degree = 3 }
registration = { kind = "fixed" }   # the mount is built so; 20 parameters remain, as in the paper
"#;

const FOLDS: &str = r#"
[folds]        # one trial of each development altitude
validation = [["1", "4", "7"], ["2", "5", "8"], ["3", "6", "9"]]
"#;
