//! The synthetic campaign as a data set: one Parquet table, a manifest, floors and statistics beside it.

use std::path::Path;

use serde::Serialize;

use acm_sim::twin::campaign::{SyntheticCampaign, SyntheticTrial};
use acm_sim::twin::schedule::{HELD_OUT, Kind, TRIALS};
use acm_sim::twin::settings::TwinSettings;

use crate::error::DataError;
use crate::files::atomic::write_bytes;
use crate::files::table::{Column, write_parquet};

/// Name of the table.
pub const TABLE: &str = "campaign.parquet";
/// Name of the file of floors.
pub const FLOORS: &str = "floors.json";
/// Name of the file of statistics.
pub const STATISTICS: &str = "statistics.json";

/// Writes table and manifest into a folder; the same campaign gives the same bytes.
///
/// # Errors
/// What the file system says, with the path.
pub fn write(campaign: &SyntheticCampaign, settings: &TwinSettings, folder: &Path) -> Result<(), DataError> {
    let named = campaign.trials.iter().map(|trial| (trial.number.to_string(), trial));
    write_parquet(&folder.join(TABLE), &columns(named))?;
    write_bytes(&folder.join("manifest.toml"), manifest(settings, campaign.seed).as_bytes())
}

/// Writes floors or statistics as JSON; floats are written so that they read back exactly.
///
/// # Errors
/// A value that JSON cannot hold; what the file system says, with the path.
pub fn write_json(value: &impl Serialize, path: &Path) -> Result<(), DataError> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|e| DataError::Usage(format!("{}: cannot be written: {e}", path.display())))?;
    write_bytes(path, format!("{text}\n").as_bytes())
}

/// Columns of the table: trials below each other, each under its name.
pub fn columns<'a>(trials: impl Iterator<Item = (String, &'a SyntheticTrial)>) -> Vec<(String, Column)> {
    let trials: Vec<(String, &SyntheticTrial)> = trials.collect();
    let numbers = |of: &dyn Fn(&SyntheticTrial) -> Vec<f64>| {
        Column::Number(trials.iter().flat_map(|(_, trial)| of(trial)).collect())
    };
    let names = trials.iter().flat_map(|(name, trial)| std::iter::repeat_n(name.clone(), trial.time.len()));
    let axis = |axis: usize| numbers(&move |trial| trial.tip.iter().map(|tip| tip[axis]).collect());
    let columns = [
        ("trial", Column::Text(names.collect())),
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

/// The manifest of one campaign in one table.
fn manifest(settings: &TwinSettings, seed: u64) -> String {
    let title = "Synthetic flight campaign of an aerial continuum manipulator (simulated, not measured)";
    let set = Described { name: "acm-twin", title, files: &[TABLE.into()], seed };
    described(settings, &set, &|number| vec![number.to_string()])
}

/// Entries of a manifest about the set as a whole.
pub(super) struct Described<'a> {
    pub name: &'a str,
    pub title: &'a str,
    /// Names of the tables.
    pub files: &'a [String],
    pub seed: u64,
}

/// A manifest; `names` gives the trials that were made of each number of the schedule.
pub(super) fn described(settings: &TwinSettings, set: &Described, names: &dyn Fn(usize) -> Vec<String>) -> String {
    let list = |wanted: &dyn Fn(usize) -> bool| quoted((1..=TRIALS).filter(|n| wanted(*n)).flat_map(names));
    let held_out = |number: usize| HELD_OUT.contains(&number);
    let grams = 1e3 * settings.arm.payload;
    let payload: String = (1..=TRIALS)
        .filter(|number| Kind::of(*number) == Kind::Payload)
        .flat_map(names)
        .map(|name| format!("\n[conditions.{name:?}]\npayload = {{ value = {grams:.1}, unit = \"g\" }}\n"))
        .collect();
    let Described { name, title, seed, .. } = set;
    let files = quoted(set.files.iter().cloned());
    format!(
        "# Written by `acm-data generate`; see README.md for what is simulated.\n\
         name      = {name:?}\n\
         title     = {title:?}\n\
         licence   = \"CC0-1.0\"\n\
         synthetic = true\n\
         source    = \"the simulator of this project (crate acm-sim, module twin), seed {seed}\"\n\
         \n\
         [table]\n\
         files  = [{files}]\n\
         {TABLES}\
         length       = {{ value = {length:?}, unit = \"m\" }}\n\
         {ARM}\n\
         [roles]\n\
         calibration = [{calibration}]\n\
         development = [{development}]\n\
         held_out    = [{held}]   # an altitude that is not in development\n\
         excluded    = [{excluded}]   # with payload\n\
         {payload}",
        length = settings.arm.length,
        calibration = list(&|number| Kind::of(number) == Kind::RotorsOff),
        development = list(&|number| Kind::of(number) == Kind::Hover && !held_out(number)),
        held = list(&|number| Kind::of(number) == Kind::Hover && held_out(number)),
        excluded = list(&|number| Kind::of(number) == Kind::Payload),
    )
}

/// Names as TOML has them, with a new line after every twelfth.
fn quoted(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.map(|name| format!("{name:?}")).collect();
    names.chunks(12).map(|line| line.join(", ")).collect::<Vec<_>>().join(",\n  ")
}

const TABLES: &str = r#"ignore = ["README.md", "floors.json", "statistics.json"]
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
