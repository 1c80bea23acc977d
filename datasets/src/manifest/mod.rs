//! `manifest.toml`: description of the recordings and of the robot.
//!
//! Plain structs, one per table of the file; every field has a default and an unknown key is refused. [`read`] parses
//! and validates; nothing here looks at the recordings. The tagged tables (`trial`, `time`, `strain`) are flat structs
//! of options, and [`validate`] decides which form is meant: so each error keeps its line and column.

mod arm;
mod source;
mod validate;
pub mod written;

use std::collections::BTreeMap;
use std::path::Path;

use acm_core::nominal::NominalSpec;
use serde::{Deserialize, Serialize};

pub use arm::{Actuation, Arm, Registration, Strain};
pub use source::{ByTrial, Clock, Drift, DriftTable, Offset, OffsetTable, Source, Sources, Word};

use crate::error::{DataError, Problems};
use crate::join::Rule;
use crate::toml_file::{self, TomlSource};
use crate::units::{Dimension, Unit};

/// A data set's manifest. Units are as written; values in SI come from [`Quantity::si`] and from the reader.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Manifest {
    /// Short name; the folder's name where it is omitted.
    pub name: String,
    /// One line for reports; the name where it is omitted.
    pub title: String,
    /// Licence of the data.
    pub licence: String,
    /// Where the data come from; or, as `[[source]]`, several recordings of each trial.
    pub source: Sources,
    /// Where the data come from, beside `[[source]]`.
    pub provenance: String,
    /// Made by a simulation: reports then say so wherever numbers are shown.
    pub synthetic: bool,
    /// How to get the data, printed where they are missing.
    pub obtain: String,
    /// Which files, and how they are laid out.
    pub table: Table,
    /// Actuators: commands or their read-back, `A` of them.
    pub actuator: Vec<Signal>,
    /// Whatever else is known at each sample, `E` of them.
    pub context: Vec<Signal>,
    /// The outputs, `M` of them.
    pub measured: Vec<Measured>,
    /// The user's own nominal prediction: none, or one for each output.
    pub predicted: Vec<Signal>,
    /// Position (and attitude) of the carrier.
    pub vehicle: Option<Vehicle>,
    /// Geometry of a continuum arm.
    pub arm: Option<Arm>,
    /// The role of every trial.
    pub roles: Roles,
    /// Validation trials of each fold.
    pub folds: FoldTable,
    /// Constants per trial.
    pub conditions: BTreeMap<String, BTreeMap<String, Quantity>>,
    /// Trials that are cut by time into trials of their own.
    pub cut: BTreeMap<String, BTreeMap<String, Part>>,
}

/// `[table]`: files, trial names and time.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Table {
    /// Patterns relative to the data folder; CSV or Parquet by extension.
    pub files: Vec<String>,
    /// Patterns of tables that are known and not part of this set.
    pub ignore: Vec<String>,
    /// Folder of shared data below which the files also are looked for.
    pub folder: Option<String>,
    /// Separator of CSV cells, one character; recognised if it is omitted.
    pub separator: Option<String>,
    /// Decimal separator in CSV, `","` or `"."`; recognised if it is omitted.
    pub decimal: Option<String>,
    /// Where a trial's name stands; the file name without extension where it is omitted.
    pub trial: TrialName,
    /// Column of time.
    pub time: Time,
    /// Columns of angles that are written within one turn; they are unwrapped.
    pub angles: Vec<String>,
    /// Range of each counter, such as 65536; they are unwrapped.
    pub counters: BTreeMap<String, f64>,
    /// Four columns each of unit quaternions, whose sign is kept.
    pub quaternions: Vec<[String; 4]>,
}

/// `trial = { column = "…" }` or `trial = { file = "regular expression with one group" }`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TrialName {
    /// Column that holds the name.
    pub column: Option<String>,
    /// Pattern of the file name without extension; its first group is the name.
    pub file: Option<String>,
}

/// `{ column, unit }`, `{ rate_hz }`, or `{ column, unit = "sample", rate_hz }`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Time {
    /// Column of time stamps or sample numbers.
    pub column: Option<String>,
    /// Its unit.
    pub unit: Option<String>,
    /// Samples per second, Hz.
    pub rate_hz: Option<f64>,
}

/// One column of numbers.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Signal {
    /// Column in the files.
    pub column: String,
    /// Its unit.
    pub unit: String,
    /// Name in results; the column's name where it is omitted.
    pub name: Option<String>,
    /// Physical meaning of a context signal, where its name does not show it.
    pub quantity: Option<PhysicalQuantity>,
    /// Fills missing values from the samples around: `previous` or `linear`. Else a missing value is refused.
    pub fill: Option<Rule>,
}

/// Physical quantities that effects of flight and of loads need.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PhysicalQuantity {
    /// Throttle of the rotors, or their thrust.
    Throttle,
    /// Over the ground.
    Altitude,
    /// Mass at the tip.
    Payload,
}

/// One column of an output.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Measured {
    /// Column in the files.
    pub column: String,
    /// Its unit.
    pub unit: String,
    /// Name in results; the column's name where it is omitted.
    pub name: Option<String>,
    /// Place of the marker along the arm, s/L; 1 is the tip.
    pub at: Option<f64>,
}

/// `[vehicle]`: the carrier.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Vehicle {
    /// Three columns of position.
    pub position: Vec<String>,
    /// Unit of the position.
    pub unit: String,
    /// Three columns of angles (roll, pitch, yaw) or four of a unit quaternion (w, x, y, z).
    pub attitude: Vec<String>,
    /// Unit of the attitude.
    pub attitude_unit: Option<String>,
}

/// A value with its unit: `{ value = 45.0, unit = "g" }`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Quantity {
    /// Number, in `unit`.
    pub value: f64,
    /// Unit.
    pub unit: String,
}

/// Role of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Fits the nominal model.
    Calibration,
    /// Fits and validates the networks.
    Development,
    /// Takes no part until the final score.
    HeldOut,
    /// Is read and checked, and used for nothing.
    Excluded,
}

/// `[roles]`: every trial stands in exactly one list.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs)]
pub struct Roles {
    pub calibration: Vec<String>,
    pub development: Vec<String>,
    pub held_out: Vec<String>,
    pub excluded: Vec<String>,
}

/// `[folds]`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FoldTable {
    /// The validation trials of each fold.
    pub validation: Vec<Vec<String>>,
}

/// One part of a cut trial: the samples before `until`, or the rest.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Part {
    /// End of the part in the trial's own time, s (that sample belongs to the next part); the last part has none.
    pub until: Option<f64>,
    /// Role of the part.
    pub role: Option<Role>,
}

/// Reads and validates `folder/manifest.toml`.
///
/// # Errors
/// All problems of the file, each with line and column.
pub fn read(folder: &Path) -> Result<(Manifest, TomlSource), DataError> {
    let path = folder.join("manifest.toml");
    let (mut manifest, source) = toml_file::read::<Manifest>(&path)?;
    if manifest.name.is_empty() {
        let absolute = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
        manifest.name = absolute.file_name().map_or("data".into(), |n| n.to_string_lossy().into_owned());
    }
    if manifest.title.trim().is_empty() {
        manifest.title = manifest.name.clone();
    }
    let problems = manifest.validate(&source);
    Problems(problems.into_iter().map(DataError::from).collect()).into_result()?;
    Ok((manifest, source))
}

impl Quantity {
    /// The value in SI; NaN where the unit is unknown, which `validate` refuses.
    pub fn si(&self) -> f64 {
        Unit::parse(&self.unit).map_or(f64::NAN, |u| u.to_si(self.value))
    }
}

impl Role {
    /// All roles, in the order of the manifest.
    pub const ALL: [Role; 4] = [Role::Calibration, Role::Development, Role::HeldOut, Role::Excluded];

    /// Name in a manifest.
    pub fn name(self) -> &'static str {
        match self {
            Role::Calibration => "calibration",
            Role::Development => "development",
            Role::HeldOut => "held_out",
            Role::Excluded => "excluded",
        }
    }
}

impl Roles {
    /// The trials of a role.
    pub fn of(&self, role: Role) -> &[String] {
        match role {
            Role::Calibration => &self.calibration,
            Role::Development => &self.development,
            Role::HeldOut => &self.held_out,
            Role::Excluded => &self.excluded,
        }
    }

    /// The role of each trial that has one.
    pub fn by_trial(&self) -> BTreeMap<&str, Role> {
        let of = |role: Role| self.of(role).iter().map(move |trial| (trial.as_str(), role));
        Role::ALL.into_iter().rev().flat_map(of).collect()
    }

    /// The role of a trial.
    pub fn role(&self, trial: &str) -> Option<Role> {
        Role::ALL.into_iter().find(|r| self.of(*r).iter().any(|t| t == trial))
    }
}

impl Signal {
    /// Name in results.
    pub fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.column)
    }
}

impl PhysicalQuantity {
    /// Whether a signal of this dimension can be it.
    pub fn fits(self, dimension: Dimension) -> bool {
        match self {
            PhysicalQuantity::Throttle => matches!(dimension, Dimension::One | Dimension::Force),
            PhysicalQuantity::Altitude => dimension == Dimension::Length,
            PhysicalQuantity::Payload => dimension == Dimension::Mass,
        }
    }

    /// Name in a manifest.
    pub fn name(self) -> &'static str {
        match self {
            PhysicalQuantity::Throttle => "throttle",
            PhysicalQuantity::Altitude => "altitude",
            PhysicalQuantity::Payload => "payload",
        }
    }
}

impl Measured {
    /// Name in results.
    pub fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.column)
    }
}

/// Degree of the polynomial that is the nominal model of a robot without an arm.
const POLYNOMIAL_DEGREE: usize = 3;

impl Manifest {
    /// Name and title in one line; the name alone where it is the title.
    pub fn heading(&self) -> String {
        if self.title == self.name { self.name.clone() } else { format!("{}: {}", self.name, self.title) }
    }

    /// Where the data come from.
    pub fn provenance(&self) -> &str {
        if self.source.text.is_empty() { &self.provenance } else { &self.source.text }
    }

    /// Patterns of all data files.
    pub fn patterns(&self) -> Vec<String> {
        let sources = self.source.list.iter().flat_map(|source| &source.files);
        self.table.files.iter().chain(sources).cloned().collect()
    }

    /// List, index, column and unit of every signal.
    pub(crate) fn signal_columns(&self) -> Vec<(&'static str, usize, String, String)> {
        let signals = [("actuator", &self.actuator), ("context", &self.context), ("predicted", &self.predicted)];
        let of = |(list, signals): (&'static str, &Vec<Signal>)| {
            let all = signals.iter().enumerate();
            all.map(move |(i, signal)| (list, i, signal.column.clone(), signal.unit.clone())).collect::<Vec<_>>()
        };
        let mut all: Vec<_> = signals.into_iter().flat_map(of).collect();
        all.extend(self.measured.iter().enumerate().map(|(i, m)| ("measured", i, m.column.clone(), m.unit.clone())));
        if let Some(vehicle) = &self.vehicle {
            let unit = |text: Option<&String>| text.cloned().unwrap_or_else(|| "1".into());
            let position = vehicle.position.iter().map(|column| (column, vehicle.unit.clone()));
            let attitude = vehicle.attitude.iter().map(|column| (column, unit(vehicle.attitude_unit.as_ref())));
            let columns = position.chain(attitude).enumerate();
            all.extend(columns.map(|(i, (column, unit))| ("vehicle", i, column.clone(), unit)));
        }
        all
    }

    /// Period of each declared angle and counter, in its unit, by its name in the manifest.
    pub(crate) fn periods(&self) -> BTreeMap<String, f64> {
        let table = ("", &self.table.angles, &self.table.counters);
        let sources = self.source.list.iter().map(|s| (s.name.as_str(), &s.angles, &s.counters));
        let of = |(source, angles, counters): (&str, &Vec<String>, &BTreeMap<String, f64>)| {
            let full = |column: &String| if source.is_empty() { column.clone() } else { format!("{source}.{column}") };
            let angles = angles.iter().filter_map(|column| Some((full(column), self.turn(&full(column))?)));
            angles.chain(counters.iter().map(|(column, range)| (full(column), *range))).collect::<Vec<_>>()
        };
        sources.chain([table]).flat_map(of).collect()
    }

    /// A full turn in the unit of an angle.
    pub(crate) fn turn(&self, name: &str) -> Option<f64> {
        let (.., unit) = self.signal_columns().into_iter().find(|(_, _, column, _)| column == name)?;
        Unit::parse(&unit).ok()?.full_turn()
    }

    /// The nominal model that it describes: the strain model of its arm, or a polynomial.
    pub fn nominal_spec(&self) -> NominalSpec {
        match &self.arm {
            Some(arm) => NominalSpec::Strain(arm.spec()),
            None => NominalSpec::Polynomial { degree: POLYNOMIAL_DEGREE },
        }
    }

    /// Whether a trial, or a part of one, is to calibrate the nominal model.
    pub fn calibrates(&self) -> bool {
        let parts = self.cut.values().flat_map(BTreeMap::values);
        !self.roles.calibration.is_empty() || parts.into_iter().any(|part| part.role == Some(Role::Calibration))
    }

    /// Whether the outputs are markers with three coordinates each: an arm is described, or a place is given.
    pub fn has_markers(&self) -> bool {
        self.arm.is_some() || self.measured.iter().any(|m| m.at.is_some())
    }

    /// `s/L` of each marker, `[K]`; empty where the outputs are no markers.
    pub fn marker_places(&self) -> Vec<f64> {
        if !self.has_markers() {
            return Vec::new();
        }
        self.measured.chunks(3).map(|marker| marker[0].at.unwrap_or(1.0)).collect()
    }

    /// The measured columns that are reported: the marker at the tip, or all outputs.
    pub fn tip_columns(&self) -> std::ops::Range<usize> {
        match self.marker_places().iter().position(|at| *at == 1.0) {
            Some(k) => 3 * k..3 * k + 3,
            None => 0..self.measured.len(),
        }
    }

    /// Names of the reported outputs.
    pub fn output_names(&self) -> Vec<String> {
        self.measured[self.tip_columns()].iter().map(|m| m.name().to_string()).collect()
    }

    /// SI unit of the reported outputs (they share one where they are lengths of a marker).
    pub fn output_unit(&self) -> &'static str {
        let first = self.measured.first().and_then(|m| Unit::parse(&m.unit).ok());
        first.map_or("1", |u| u.si_name())
    }
}
