//! Names and shapes of a network's parameters, as torch and ncps have them in a file.
//!
//! | network | names                                                                                              |
//! | ------- | -------------------------------------------------------------------------------------------------- |
//! | CfC     | `rnn_cell.backbone.0.weight`, …, `rnn_cell.ff1.weight`, `ff2`, `time_a`, `time_b`, or `rnn_cell.w_tau`, `rnn_cell.A` |
//! | GRU     | `rnn.weight_ih_l0`, `rnn.weight_hh_l0`, `rnn.bias_ih_l0`, `rnn.bias_hh_l0`, … as `torch.nn.GRU`     |
//! | MLP     | `layers.0.weight`, `layers.2.weight`, … as `torch.nn.Sequential` with activations between          |
//! | all     | `fc.weight`, `fc.bias`: the linear layer over the features                                         |
//!
//! A weight is `[outputs, inputs]`, row by row, as torch keeps it. Names of the CfC are those of ncps 1.0.

use crate::shape::{Body, CfcMode, CfcShape, Shape};

/// A trainable tensor: its name, and the length of each axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParameterShape {
    /// Name in torch or ncps.
    pub name: String,
    /// Length of each axis: one or two.
    pub axes: Vec<usize>,
}

impl Shape {
    /// Returns all parameters in the order in which a row of weights has them, the output layer last.
    pub fn parameters(&self) -> Vec<ParameterShape> {
        let mut all = match &self.body {
            Body::Cfc(cfc) => of_cfc(cfc, self.inputs),
            Body::Gru(gru) => (0..gru.layers).flat_map(|l| of_gru_layer(l, self.inputs, gru.units)).collect(),
            Body::Mlp(mlp) => {
                let widths: Vec<usize> = std::iter::once(self.inputs).chain(mlp.hidden.iter().copied()).collect();
                let pairs = widths.windows(2).enumerate();
                pairs.flat_map(|(l, pair)| linear(&format!("layers.{}", 2 * l), pair[0], pair[1])).collect()
            }
        };
        all.extend(linear("fc", self.features(), self.outputs));
        all
    }
}

fn parameter(name: impl Into<String>, axes: &[usize]) -> ParameterShape {
    ParameterShape { name: name.into(), axes: axes.to_vec() }
}

fn linear(name: &str, inputs: usize, outputs: usize) -> [ParameterShape; 2] {
    [parameter(format!("{name}.weight"), &[outputs, inputs]), parameter(format!("{name}.bias"), &[outputs])]
}

fn of_cfc(cfc: &CfcShape, inputs: usize) -> Vec<ParameterShape> {
    let (units, width) = (cfc.units, cfc.backbone_units);
    let mut all = vec![];
    if cfc.mode == CfcMode::Pure {
        all.extend(["w_tau", "A"].map(|name| parameter(format!("rnn_cell.{name}"), &[1, units])));
    }
    let mut before = inputs + units;
    for l in 0..cfc.backbone_layers {
        all.extend(linear(&format!("rnn_cell.backbone.{}", 2 * l), before, width));
        before = width;
    }
    let maps: &[&str] = if cfc.mode == CfcMode::Pure { &["ff1"] } else { &["ff1", "ff2", "time_a", "time_b"] };
    all.extend(maps.iter().flat_map(|map| linear(&format!("rnn_cell.{map}"), before, units)));
    all
}

fn of_gru_layer(l: usize, inputs: usize, units: usize) -> [ParameterShape; 4] {
    let inputs = if l == 0 { inputs } else { units };
    [
        parameter(format!("rnn.weight_ih_l{l}"), &[3 * units, inputs]),
        parameter(format!("rnn.weight_hh_l{l}"), &[3 * units, units]),
        parameter(format!("rnn.bias_ih_l{l}"), &[3 * units]),
        parameter(format!("rnn.bias_hh_l{l}"), &[3 * units]),
    ]
}
