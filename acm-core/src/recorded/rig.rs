//! A rig: its signals with their ranges, and its mechanics.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// One recorded signal and the range that it covers in the trials that a model is fitted to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Signal {
    /// Name, as in results.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
}

/// A rig: A actuators, E context signals (with the conditions of a trial), M outputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rig {
    /// Actuators, A of them: commands or their read-back.
    pub actuators: Vec<Signal>,
    /// Other signals known at each sample, E of them: context signals, then conditions that are constant in a trial.
    pub contexts: Vec<Signal>,
    /// The outputs, M of them.
    pub outputs: Vec<Signal>,
    /// Which context is the rotors' throttle.
    pub throttle: Option<usize>,
    /// Which context is the altitude over the ground, m.
    pub altitude: Option<usize>,
    /// Which context is the mass at the tip, kg.
    pub payload: Option<usize>,
    /// Whether records hold the acceleration of the carrier.
    pub carried: bool,
    /// A continuum arm: outputs are x, y, z of markers, and loads can bend it.
    pub arm: Option<Mounting>,
    /// Median time between samples, s.
    pub step: f64,
    /// Length of the longest trial, s.
    pub duration: f64,
}

/// How a continuum arm is mounted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mounting {
    /// Arc length, m.
    pub length: f64,
    /// Unit vector that points down in the measurement frame.
    pub down: Vector3<f64>,
}

impl Signal {
    /// Width of the range.
    pub fn span(&self) -> f64 {
        self.high - self.low
    }

    /// Whether the signal varies.
    pub fn varies(&self) -> bool {
        self.span() > 1e-9 * self.high.abs().max(self.low.abs())
    }

    /// Largest magnitude.
    pub fn magnitude(&self) -> f64 {
        self.high.abs().max(self.low.abs())
    }
}
