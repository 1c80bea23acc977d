//! The structure of a rig with its values: a chain of stages behind one actuator, or a sum of terms in one joint's motion.
//!
//! An oracle fits the same structure from the true values on; a structure without a cause has that cause's values at
//! their neutral ones.

use crate::small_rigs::drive::Drive;
use crate::small_rigs::plants::stage::Stage;
use crate::small_rigs::plants::term::Term;

/// A value of the structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Free {
    /// Name in the effect library, where it has a counterpart.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// True value, SI.
    pub value: f64,
    /// Value at which its cause does nothing.
    pub neutral: f64,
    /// Smallest value.
    pub lower: f64,
    /// Size of a change that shows.
    pub scale: f64,
    /// The cause that it belongs to; none for the static map and its like.
    pub cause: Option<usize>,
}

impl Free {
    /// Returns a value of any sign whose cause does nothing at zero.
    pub fn new(name: impl Into<String>, value: f64, unit: &str) -> Self {
        let scale = value.abs().max(1e-9);
        Self { name: name.into(), unit: unit.into(), value, neutral: 0.0, lower: f64::NEG_INFINITY, scale, cause: None }
    }

    /// Returns the value that never falls below zero.
    pub fn positive(name: impl Into<String>, value: f64, unit: &str) -> Self {
        Self { lower: 0.0, ..Self::new(name, value, unit) }
    }

    /// Sets the size of a change that is visible.
    pub fn of_scale(self, scale: f64) -> Self {
        Self { scale, ..self }
    }
}

/// Structure of the map from values to outputs.
#[derive(Clone, Debug, PartialEq)]
pub enum Structure {
    /// Stages one after the other, each with the place of its first value.
    Chain(Vec<(Stage, usize)>),
    /// Sum of terms, each with the index of its first value.
    Sum {
        /// The joint whose motion they use.
        joint: usize,
        /// Terms of the sum.
        terms: Vec<(Term, usize)>,
    },
}

/// A structure and its true values.
#[derive(Clone, Debug, PartialEq)]
pub struct Plant {
    /// Structure of the map from values to outputs.
    pub structure: Structure,
    /// True values.
    pub free: Vec<Free>,
}

impl Plant {
    /// Returns a chain without a stage.
    pub fn chain() -> Self {
        Self { structure: Structure::Chain(vec![]), free: vec![] }
    }

    /// Returns a sum without a term.
    pub fn sum(joint: usize) -> Self {
        Self { structure: Structure::Sum { joint, terms: vec![] }, free: vec![] }
    }

    /// Appends a stage to a chain.
    pub fn stage(&mut self, stage: Stage, free: impl IntoIterator<Item = Free>) {
        if let Structure::Chain(stages) = &mut self.structure {
            stages.push((stage, self.free.len()));
            self.free.extend(free);
        }
    }

    /// Appends a term to a sum.
    pub fn term(&mut self, term: Term, free: impl IntoIterator<Item = Free>) {
        if let Structure::Sum { terms, .. } = &mut self.structure {
            terms.push((term, self.free.len()));
            self.free.extend(free);
        }
    }

    /// Returns the true values.
    pub fn values(&self) -> Vec<f64> {
        self.free.iter().map(|free| free.value).collect()
    }

    /// Returns the joint whose motion is used, if any.
    pub fn joint(&self) -> Option<usize> {
        match self.structure {
            Structure::Chain(_) => None,
            Structure::Sum { joint, .. } => Some(joint),
        }
    }

    /// Returns the output at the sampling times.
    pub fn respond(&self, values: &[f64], drive: &Drive) -> Vec<f64> {
        match &self.structure {
            Structure::Chain(stages) => {
                let mut signal = drive.actuators[0].clone();
                stages.iter().for_each(|(stage, at)| stage.act(&values[*at..], drive, &mut signal));
                drive.ask(&signal)
            }
            Structure::Sum { terms, .. } => {
                let mut output = vec![0.0; drive.asked.len()];
                terms.iter().for_each(|(term, at)| term.add(&values[*at..], drive, &mut output));
                output
            }
        }
    }
}
