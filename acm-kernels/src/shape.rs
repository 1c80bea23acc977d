//! Network shapes: kinds, sizes and their validation.
//!
//! | symbol | meaning                         |
//! | ------ | ------------------------------- |
//! | `C`    | channels of the input           |
//! | `H`    | width of the state              |
//! | `O`    | predictions at a time step      |

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::vectors::level::Level;

/// A network: a body that makes features of sequences, and a linear layer over them.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Body of the network; it computes the features.
    pub body: Body,
    /// Number of channels C.
    pub inputs: usize,
    /// Number of predictions O.
    pub outputs: usize,
}

/// Body of a network; it computes the features.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// Closed-form continuous-time network.
    Cfc(CfcShape),
    /// Gated recurrent unit.
    Gru(GruShape),
    /// Multilayer perceptron, the same map at each time step.
    Mlp(MlpShape),
}

/// Sizes of a closed-form continuous-time network.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CfcShape {
    /// Width H of the state.
    pub units: usize,
    /// Mode, the equation of the new state.
    pub mode: CfcMode,
    /// Width of each backbone layer.
    pub backbone_units: usize,
    /// Number of backbone layers; 0 for none.
    pub backbone_layers: usize,
    /// Activation after each backbone layer.
    pub activation: Activation,
}

/// Equation of the new state of a closed-form network.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CfcMode {
    /// The gate chooses between two candidates.
    Default,
    /// The gate weighs the second candidate only.
    NoGate,
    /// The closed form itself.
    Pure,
}

/// Sizes of a gated recurrent unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GruShape {
    /// Width H of the state.
    pub units: usize,
    /// Number of layers, each reading the states of the one below.
    pub layers: usize,
}

/// Sizes of a perceptron.
#[derive(Clone, Debug, PartialEq)]
pub struct MlpShape {
    /// Width of each hidden layer; empty for a linear model.
    pub hidden: Vec<usize>,
    /// Activation after each hidden layer.
    pub activation: Activation,
}

/// An elementwise function after a layer, as torch defines it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Activation {
    /// 1.7159 tanh(0.666 x). LeCun et al. (1998), Efficient BackProp, section 4.4.
    LecunTanh,
    /// tanh x.
    Tanh,
    /// max(x, 0).
    Relu,
    /// x σ(x).
    Silu,
    /// x Φ(x), with the normal distribution Φ.
    Gelu,
}

impl Activation {
    /// All activations, for tests that walk the list.
    pub const ALL: [Self; 5] = [Self::LecunTanh, Self::Tanh, Self::Relu, Self::Silu, Self::Gelu];
}

/// Reasons why a network cannot be built.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum BuildError {
    /// A width or a count of zero.
    #[error("network with {field} = 0 cannot be built; use at least 1")]
    Size {
        /// Name of the size.
        field: &'static str,
    },
    /// The processor lacks the vector instructions.
    #[error("this processor lacks {level:?}; leave the choice to Kernel::new")]
    Level {
        /// Level that the processor lacks.
        level: Level,
    },
}

impl Shape {
    /// Refuses a width or a count of zero.
    ///
    /// # Errors
    /// Names the first size that is zero.
    pub fn validate(&self) -> Result<(), BuildError> {
        let mut sizes = vec![("inputs", self.inputs), ("outputs", self.outputs)];
        match &self.body {
            Body::Cfc(cfc) => {
                sizes.push(("units", cfc.units));
                sizes.push(("backbone_units", cfc.backbone_units + usize::from(cfc.backbone_layers == 0)));
            }
            Body::Gru(gru) => sizes.extend([("units", gru.units), ("layers", gru.layers)]),
            Body::Mlp(mlp) => sizes.extend(mlp.hidden.iter().map(|&width| ("hidden", width))),
        }
        match sizes.into_iter().find(|&(_, value)| value == 0) {
            Some((field, _)) => Err(BuildError::Size { field }),
            None => Ok(()),
        }
    }

    /// Returns the width of the features that the linear layer reads.
    pub fn features(&self) -> usize {
        match &self.body {
            Body::Cfc(cfc) => cfc.units,
            Body::Gru(gru) => gru.units,
            Body::Mlp(mlp) => mlp.hidden.last().copied().unwrap_or(self.inputs),
        }
    }

    /// Returns the number of layers that carry a state from step to step, each as wide as the features.
    pub fn layers_with_state(&self) -> usize {
        match &self.body {
            Body::Cfc(_) => 1,
            Body::Gru(gru) => gru.layers,
            Body::Mlp(_) => 0,
        }
    }
}

/// Time steps of a sequence that are predicted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// The last step alone.
    Last,
    /// Every step.
    Every,
}
