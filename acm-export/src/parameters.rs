//! The network's parameters by name.
//!
//! | network | names                                                                                              |
//! | ------- | -------------------------------------------------------------------------------------------------- |
//! | CfC     | `rnn_cell.backbone.0.weight`, …, `rnn_cell.ff1.weight`, `ff2`, `time_a`, `time_b`, or `rnn_cell.w_tau`, `rnn_cell.A` |
//! | GRU     | `rnn.weight_ih_l0`, `rnn.weight_hh_l0`, `rnn.bias_ih_l0`, `rnn.bias_hh_l0`, … as `torch.nn.GRU`     |
//! | MLP     | `layers.0.weight`, `layers.2.weight`, … as `torch.nn.Sequential` with activations between          |
//! | all     | `fc.weight`, `fc.bias`: the linear layer over the features                                         |
//!
//! A weight is `[outputs, inputs]`, row by row, as torch keeps it. Names of the CfC are those of ncps 1.0.

use acm_kernels::{Body, CfcMode, CfcShape, Shape};

/// One tensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// As torch or ncps names it.
    pub name: String,
    /// Length of each axis.
    pub shape: Vec<usize>,
    /// Row by row.
    pub values: Vec<f32>,
}

/// The parameters of a network from one row of `weights`, in the order of [`acm_stream::Parts::weights`].
///
/// # Panics
/// If there are fewer weights than the shape has.
pub fn parameters(shape: &Shape, weights: &[f32]) -> Vec<Parameter> {
    let mut names = match &shape.body {
        Body::Cfc(cfc) => of_cfc(cfc, shape.inputs),
        Body::Gru(gru) => (0..gru.layers).flat_map(|l| of_gru_layer(l, shape.inputs, gru.units)).collect(),
        Body::Mlp(mlp) => {
            let widths: Vec<usize> = std::iter::once(shape.inputs).chain(mlp.hidden.iter().copied()).collect();
            let pairs = widths.windows(2).enumerate();
            pairs.flat_map(|(l, pair)| linear(&format!("layers.{}", 2 * l), pair[0], pair[1])).collect()
        }
    };
    names.extend(linear("fc", shape.features(), shape.outputs));
    let mut rest = weights;
    let mut next = |(name, shape): (String, Vec<usize>)| {
        let (values, after) = rest.split_at(shape.iter().product());
        rest = after;
        Parameter { name, shape, values: values.to_vec() }
    };
    names.into_iter().map(&mut next).collect()
}

type Named = (String, Vec<usize>);

fn linear(name: &str, inputs: usize, outputs: usize) -> [Named; 2] {
    [(format!("{name}.weight"), vec![outputs, inputs]), (format!("{name}.bias"), vec![outputs])]
}

fn of_cfc(cfc: &CfcShape, inputs: usize) -> Vec<Named> {
    let (units, width) = (cfc.units, cfc.backbone_units);
    let mut names = vec![];
    if cfc.mode == CfcMode::Pure {
        names.extend(["w_tau", "A"].map(|name| (format!("rnn_cell.{name}"), vec![1, units])));
    }
    let mut before = inputs + units;
    for l in 0..cfc.backbone_layers {
        names.extend(linear(&format!("rnn_cell.backbone.{}", 2 * l), before, width));
        before = width;
    }
    let maps: &[&str] = if cfc.mode == CfcMode::Pure { &["ff1"] } else { &["ff1", "ff2", "time_a", "time_b"] };
    names.extend(maps.iter().flat_map(|map| linear(&format!("rnn_cell.{map}"), before, units)));
    names
}

fn of_gru_layer(l: usize, inputs: usize, units: usize) -> [Named; 4] {
    let inputs = if l == 0 { inputs } else { units };
    [
        (format!("rnn.weight_ih_l{l}"), vec![3 * units, inputs]),
        (format!("rnn.weight_hh_l{l}"), vec![3 * units, units]),
        (format!("rnn.bias_ih_l{l}"), vec![3 * units]),
        (format!("rnn.bias_hh_l{l}"), vec![3 * units]),
    ]
}
