//! An effect as its author writes it: the tables of a TOML file, and what `model.json` keeps of them.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// `[[effect]]`: one effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Definition {
    /// Lower-case letters, digits and `_`; none that the library has.
    pub name: String,
    /// What it does, for readers.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub meaning: String,
    /// Where the equation comes from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// The file that it was read from; filled in on reading.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub file: String,
    /// What it acts on.
    pub place: Place,
    /// Names of the actuators or outputs that it acts on; all where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub columns: Vec<String>,
    /// Unit of `q` or `y`; where it is left out, each column has its own, named `q` or `y`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// Signals that may carry it, one at a time: names, `actuators`, `contexts`. None carries it where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub carriers: Vec<String>,
    /// Signals that it reads beside the columns.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub inputs: BTreeMap<String, Input>,
    /// Known values.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub constants: BTreeMap<String, Constant>,
    /// Values that are fitted.
    #[serde(default)]
    pub parameters: BTreeMap<String, Parameter>,
    /// The column as it leaves the effect, without memory; of a frame, of each coordinate.
    #[serde(rename = "static", default, skip_serializing_if = "Option::is_none")]
    pub static_form: Option<Outputs>,
    /// Each state from those before and from the input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub update: Option<BTreeMap<String, String>>,
    /// The time derivative of each state.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<BTreeMap<String, String>>,
    /// Each state at the first sample of a trial; 0 where none is given.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub start: BTreeMap<String, String>,
    /// The column as it leaves the effect, from the states.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output: Option<Outputs>,
    /// Runge–Kutta steps between two samples, where a rate is not linear; 4 where none is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steps: Option<usize>,
}

/// What an effect acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// Each actuator, `q`, before it reaches the model.
    Actuators,
    /// Each output, `y`.
    Outputs,
    /// Each marker's place in the frame of measurement: `x`, `y`, `z`, m.
    Frame,
}

/// One expression, or one for each coordinate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "an expression in quotes, or a table of expressions { x = …, y = …, z = … }")]
pub enum Outputs {
    /// Of a column.
    One(String),
    /// Of x, y, z; what is not named stays as it is.
    Each(BTreeMap<String, String>),
}

/// A signal that an effect reads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// Name of an actuator or context, or `carrier`.
    pub signal: String,
    /// Its unit; of a carrier it may be left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// Its derivative instead of itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derivative: Option<Derived>,
    /// Parameter that is half the window of the derivative, s; the nearest five samples where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window: Option<String>,
}

/// Which derivative of a signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Derived {
    /// Per second.
    Rate,
    /// Per second².
    Acceleration,
}

/// A value that is known.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Constant {
    /// In its unit.
    pub value: f64,
    /// `1` where it is left out.
    #[serde(default = "one")]
    pub unit: String,
}

/// A value that is fitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// `1` where it is left out. In the unit of a signal (`q`, `y`, `carrier`) numbers are shares of the signal's range.
    #[serde(default = "one")]
    pub unit: String,
    /// Smallest and largest value.
    pub bounds: [f64; 2],
    /// Values to start a fit from.
    pub guesses: Vec<f64>,
    /// The value at which the effect does nothing, of a size; a shape has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub silent: Option<f64>,
    /// Whether each column has its own.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub each: bool,
}

fn one() -> String {
    "1".into()
}

impl Place {
    /// Names of what it acts on, in expressions.
    pub fn columns(self) -> &'static [&'static str] {
        match self {
            Place::Actuators => &["q"],
            Place::Outputs => &["y"],
            Place::Frame => &["x", "y", "z"],
        }
    }
}
