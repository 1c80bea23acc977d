//! Result of a simulation: signals, trials, truth.

use crate::role::Role;
use crate::small_rigs::plants::plant::Plant;

/// A recorded signal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signal {
    /// Column name.
    pub name: String,
    /// SI unit.
    pub unit: String,
}

impl Signal {
    /// Returns a signal of a name and a unit.
    pub fn new(name: &str, unit: &str) -> Self {
        Self { name: name.into(), unit: unit.into() }
    }
}

/// One trial as recorded. It begins at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct SimTrial {
    /// Name, a number from 1.
    pub name: String,
    /// Role; no trial is for calibration only.
    pub role: Role,
    /// Time stamps, s; increasing.
    pub time: Vec<f64>,
    /// Actuator readings, signal by signal.
    pub actuators: Vec<Vec<f64>>,
    /// Context readings, signal by signal.
    pub contexts: Vec<Vec<f64>>,
    /// Measured outputs, signal by signal.
    pub outputs: Vec<Vec<f64>>,
}

/// A true value.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// Name in the effect library, where it has a counterpart.
    pub name: String,
    /// Value, SI.
    pub value: f64,
    /// Unit.
    pub unit: String,
}

/// The effect that a finder should name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counterpart {
    /// Name in the effect library.
    pub effect: String,
    /// Signal that it acts on; none for causes that act on the outputs.
    pub signal: Option<String>,
}

/// One cause of error.
#[derive(Clone, Debug, PartialEq)]
pub struct Cause {
    /// The simulated mechanism.
    pub mechanism: String,
    /// The effect that should be named; none outside of the library.
    pub counterpart: Option<Counterpart>,
    /// True values.
    pub parameters: Vec<Value>,
}

/// Truth of a rig.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Acting causes, beyond a static map.
    pub causes: Vec<Cause>,
    /// Standard deviation of noise and quantisation of each output, in its unit.
    pub noise: Vec<f64>,
    /// The structure with its true values.
    pub plant: Plant,
}

/// A rig, its recordings and its truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    /// Name, such as `axis-14001`.
    pub name: String,
    /// Title in one line, for a reader; it does not name the causes.
    pub title: String,
    /// Actuators.
    pub actuators: Vec<Signal>,
    /// Contexts.
    pub contexts: Vec<Signal>,
    /// Outputs.
    pub outputs: Vec<Signal>,
    /// Trials, development first.
    pub trials: Vec<SimTrial>,
    /// Truth of the rig.
    pub truth: Truth,
}

impl Recorded {
    /// Returns the trials of a role.
    pub fn trials(&self, role: Role) -> impl Iterator<Item = &SimTrial> {
        self.trials.iter().filter(move |trial| trial.role == role)
    }
}
