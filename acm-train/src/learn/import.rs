//! Import of a network that was trained elsewhere: from named tensors to a row of weights.
//!
//! ```text
//! elsewhere   r = S' f((x − m')/s') + M'          here   r = S g((x − m)/s) + M
//! W_in ← W_in diag(s/s')     b_in ← b_in + W_in (m − m')/s'     W_out ← diag(S'/S) W_out     b_out ← (S' b_out + M' − M)/S
//! ```
//!
//! | symbol          | meaning                                               | shape | unit             |
//! | --------------- | ----------------------------------------------------- | ----- | ---------------- |
//! | `x`, `r`        | channels; residual of the nominal model               | C, O  | SI               |
//! | `m`, `s`        | mean and spread of the channels in training           | C     | of the channel   |
//! | `M`, `S`        | mean and spread of the residual in training           | O     | of the output    |
//! | `f`, `g`        | the network elsewhere, and the same one here          | –     | –                |
//! | `W_in`, `b_in`  | what reads the channels: of a GRU `weight_ih_l0`      | –     | –                |
//! | `W_out`, `b_out` | the linear layer over the features                   | –     | –                |
//!
//! Scalers that are the same here and there leave every bit as it was; others cost the rounding to single precision.
//! Names are those of [`Shape::parameters`], with any prefix, and any name of the output layer.

use acm_datasets::Standardizer;
use acm_models::{Body, ParameterShape, Shape};
use thiserror::Error;

use super::examples::windows::Scalers;

/// A tensor of a file, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Tensor {
    /// Name in the file.
    pub name: String,
    /// Length of each axis.
    pub axes: Vec<usize>,
    /// Values in single precision.
    pub values: Vec<f32>,
}

/// Reasons why a file is not a network.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ImportError {
    /// A parameter that the network has and the file lacks.
    #[error("it has no tensor {name} {axes:?}; it has {}", .found.join(", "))]
    Missing {
        /// Name in torch or ncps.
        name: String,
        /// Length of each axis.
        axes: Vec<usize>,
        /// Tensors of the file.
        found: Vec<String>,
    },
    /// The file has two tensors for one parameter.
    #[error("{first} and {second} could both be {name}; leave one of them out")]
    Twice {
        /// Name in torch or ncps.
        name: String,
        /// Name in the file.
        first: String,
        /// Name in the file.
        second: String,
    },
    /// A tensor of another size.
    #[error("{name} is {found:?}, and the network needs {needed:?}; check units, layers and channels")]
    Axes {
        /// Name in the file.
        name: String,
        /// Shape in the file.
        found: Vec<usize>,
        /// Shape in the network.
        needed: Vec<usize>,
    },
    /// The file has tensors that the network has no place for.
    #[error("it has {} beside what this network has; choose the network that it was trained as", .names.join(", "))]
    UnknownTensors {
        /// Names in the file.
        names: Vec<String>,
    },
    /// A value is NaN or infinite.
    #[error("{name} holds {value}; train the network again")]
    NotFinite {
        /// Name in the file.
        name: String,
        /// First such value.
        value: f32,
    },
    /// A scaler with other columns, or a spread that cannot be.
    #[error("the scaler of the {what} needs {needed} finite means and positive spreads")]
    Scaler {
        /// Name of the scaler: `inputs` or `targets`.
        what: &'static str,
        /// Number of columns.
        needed: usize,
    },
}

/// Returns the tensors in the order of the network's weights.
///
/// # Errors
/// A tensor is missing, there twice, of another size, not finite, or one too many.
pub fn row(shape: &Shape, tensors: &[Tensor]) -> Result<Vec<f32>, ImportError> {
    let parameters = shape.parameters();
    let (body, head) = parameters.split_at(parameters.len() - 2);
    let mut rest: Vec<&Tensor> = tensors.iter().collect();
    let mut all = vec![];
    for parameter in body {
        let place = place_of(parameter, &rest)?;
        all.extend(checked(rest.remove(place), &parameter.axes)?);
    }
    for parameter in head {
        let place = head_of(parameter, &rest)?;
        all.extend(checked(rest.remove(place), &parameter.axes)?);
    }
    match rest.is_empty() {
        true => Ok(all),
        false => Err(ImportError::UnknownTensors { names: rest.iter().map(|tensor| tensor.name.clone()).collect() }),
    }
}

/// Finds a parameter of the body among tensors: its own name, behind any prefix.
fn place_of(parameter: &ParameterShape, tensors: &[&Tensor]) -> Result<usize, ImportError> {
    let own = parameter.name.split_once('.').map_or(parameter.name.as_str(), |(_, own)| own);
    let fits = |tensor: &&Tensor| tensor.name.strip_suffix(own).is_some_and(|p| p.is_empty() || p.ends_with('.'));
    only(parameter, tensors, fits)
}

/// Finds a parameter of the output layer among the tensors that the body has left over.
fn head_of(parameter: &ParameterShape, tensors: &[&Tensor]) -> Result<usize, ImportError> {
    let own = parameter.name.rsplit('.').next().unwrap_or_default();
    only(parameter, tensors, |tensor| tensor.name.rsplit('.').next() == Some(own))
}

fn only(
    parameter: &ParameterShape,
    tensors: &[&Tensor],
    fits: impl Fn(&&Tensor) -> bool,
) -> Result<usize, ImportError> {
    let name = || parameter.name.clone();
    let places: Vec<usize> = (0..tensors.len()).filter(|&place| fits(&tensors[place])).collect();
    match places[..] {
        [place] => Ok(place),
        [] => {
            let found = tensors.iter().map(|tensor| tensor.name.clone()).collect();
            Err(ImportError::Missing { name: name(), axes: parameter.axes.clone(), found })
        }
        [first, second, ..] => {
            let of = |place: usize| tensors[place].name.clone();
            Err(ImportError::Twice { name: name(), first: of(first), second: of(second) })
        }
    }
}

fn checked<'t>(tensor: &'t Tensor, needed: &[usize]) -> Result<&'t [f32], ImportError> {
    let name = || tensor.name.clone();
    if tensor.axes != needed || tensor.values.len() != needed.iter().product::<usize>() {
        return Err(ImportError::Axes { name: name(), found: tensor.axes.clone(), needed: needed.to_vec() });
    }
    match tensor.values.iter().find(|value| !value.is_finite()) {
        Some(&value) => Err(ImportError::NotFinite { name: name(), value }),
        None => Ok(&tensor.values),
    }
}

/// Rescales the first and last layer from the scalers `from`, with which the network was trained, to the scalers `to`.
///
/// # Errors
/// A scaler of `from` does not fit.
pub fn rescale(shape: &Shape, weights: &mut [f32], from: &Scalers, to: &Scalers) -> Result<(), ImportError> {
    fits("inputs", &from.inputs, shape.inputs, |spread| spread > 0.0)?;
    // A network of which nothing is added has left with a spread of 0.
    fits("targets", &from.targets, shape.outputs, |spread| spread >= 0.0)?;
    let parameters = shape.parameters();
    let mut starts = vec![0];
    starts.extend(parameters.iter().scan(0, |at, p| {
        *at += p.axes.iter().product::<usize>();
        Some(*at)
    }));
    for (k, _) in parameters.iter().enumerate().filter(|(_, p)| reads_channels(p, shape)) {
        let (columns, bias) = (parameters[k].axes[1], starts[bias_of(&parameters, k)]);
        for o in 0..parameters[k].axes[0] {
            let row = starts[k] + o * columns;
            let mut shift = 0.0;
            for c in 0..shape.inputs {
                let (weight, spread) = (f64::from(weights[row + c]), from.inputs.spread[c]);
                shift += weight * ((to.inputs.mean[c] - from.inputs.mean[c]) / spread);
                weights[row + c] = (weight * (to.inputs.spread[c] / spread)) as f32;
            }
            weights[bias + o] = (f64::from(weights[bias + o]) + shift) as f32;
        }
    }
    let (head, features) = (starts[parameters.len() - 2], shape.features());
    for o in 0..shape.outputs {
        let ratio = from.targets.spread[o] / to.targets.spread[o];
        let row = &mut weights[head + o * features..head + (o + 1) * features];
        row.iter_mut().for_each(|weight| *weight = (f64::from(*weight) * ratio) as f32);
        let bias = &mut weights[starts[parameters.len() - 1] + o];
        let shift = (from.targets.mean[o] - to.targets.mean[o]) / to.targets.spread[o];
        *bias = (f64::from(*bias) * ratio + shift) as f32;
    }
    Ok(())
}

fn fits(
    what: &'static str,
    scaler: &Standardizer,
    needed: usize,
    positive: impl Fn(f64) -> bool,
) -> Result<(), ImportError> {
    let usable = |(mean, spread): (&f64, &f64)| mean.is_finite() && spread.is_finite() && positive(*spread);
    let counts = scaler.mean.len() == needed && scaler.spread.len() == needed;
    match counts && scaler.mean.iter().zip(&scaler.spread).all(usable) {
        true => Ok(()),
        false => Err(ImportError::Scaler { what, needed }),
    }
}

/// Returns whether a weight's first columns are the channels: of the first layer of a body, and of the output layer
/// where there is no other.
fn reads_channels(parameter: &ParameterShape, shape: &Shape) -> bool {
    let first: &[&str] = match &shape.body {
        Body::Gru(_) => &["rnn.weight_ih_l0"],
        Body::Mlp(mlp) if mlp.hidden.is_empty() => &["fc.weight"],
        Body::Mlp(_) => &["layers.0.weight"],
        Body::Cfc(cfc) if cfc.backbone_layers > 0 => &["rnn_cell.backbone.0.weight"],
        Body::Cfc(_) => {
            &["rnn_cell.ff1.weight", "rnn_cell.ff2.weight", "rnn_cell.time_a.weight", "rnn_cell.time_b.weight"]
        }
    };
    first.contains(&parameter.name.as_str())
}

/// Returns the index of the bias that belongs to the weight at index `k`.
fn bias_of(parameters: &[ParameterShape], k: usize) -> usize {
    let bias = parameters[k].name.replace("weight", "bias");
    parameters.iter().position(|parameter| parameter.name == bias).unwrap_or(k)
}

#[cfg(test)]
mod tests {
    use acm_models::{Activation, CfcMode, CfcShape, GruShape, Kernel, MlpShape};

    use super::*;

    fn shapes() -> Vec<Shape> {
        let cfc = |mode, backbone_layers| {
            Body::Cfc(CfcShape { units: 3, mode, backbone_units: 4, backbone_layers, activation: Activation::Tanh })
        };
        let mlp = |hidden: &[usize]| Body::Mlp(MlpShape { hidden: hidden.to_vec(), activation: Activation::Relu });
        let bodies = [
            cfc(CfcMode::Default, 0),
            cfc(CfcMode::NoGate, 2),
            cfc(CfcMode::Pure, 0),
            Body::Gru(GruShape { units: 3, layers: 2 }),
            mlp(&[]),
            mlp(&[4, 3]),
        ];
        bodies.map(|body| Shape { body, inputs: 2, outputs: 2 }).to_vec()
    }

    fn scalers(sign: f64) -> Scalers {
        let of = |mean: [f64; 2], spread: [f64; 2]| Standardizer { mean: mean.to_vec(), spread: spread.to_vec() };
        Scalers {
            inputs: of([0.3 * sign, -1.0], [0.5, 2.0 + sign]),
            targets: of([0.01 * sign, 0.02], [0.1, 0.3 + 0.1 * sign]),
            actuators: vec![],
            straight: None,
        }
    }

    fn weights(shape: &Shape) -> Vec<f32> {
        let count: usize = shape.parameters().iter().map(|p| p.axes.iter().product::<usize>()).sum();
        (0..count).map(|k| (1.7 * k as f32).sin()).collect()
    }

    /// Returns the residuals, SI, of three steps of one sequence.
    fn residuals(shape: &Shape, weights: &[f32], scalers: &Scalers) -> Vec<f64> {
        let kernel = Kernel::new(shape).unwrap();
        let mut stepper = kernel.stepper(weights);
        let mut out = [0.0f32; 2];
        let mut all = vec![];
        for k in 0..3 {
            let x = [0.4 * f64::from(k), 1.0 - f64::from(k)];
            let z = [0, 1].map(|c| ((x[c] - scalers.inputs.mean[c]) / scalers.inputs.spread[c]) as f32);
            stepper.step(&z, 0.1, &mut out);
            all.extend((0..2).map(|o| f64::from(out[o]) * scalers.targets.spread[o] + scalers.targets.mean[o]));
        }
        all
    }

    fn tensors(shape: &Shape, weights: &[f32], name: impl Fn(&str) -> String) -> Vec<Tensor> {
        let mut rest = weights;
        let mut all: Vec<Tensor> = vec![];
        for ParameterShape { name: own, axes } in shape.parameters() {
            let (values, after) = rest.split_at(axes.iter().product());
            rest = after;
            all.push(Tensor { name: name(&own), axes, values: values.to_vec() });
        }
        all.reverse();
        all
    }

    /// Oracle: the kernels on inputs that were standardised by either scaler.
    #[test]
    fn a_network_for_other_scalers_answers_alike() {
        for shape in shapes() {
            let (there, here, before) = (scalers(-1.0), scalers(1.0), weights(&shape));
            let right = residuals(&shape, &before, &there);
            let mut after = before.clone();
            rescale(&shape, &mut after, &there, &here).unwrap();
            let found = residuals(&shape, &after, &here);
            for (right, found) in right.iter().zip(&found) {
                assert!((right - found).abs() < 1e-6, "{shape:?}: {right} {found}");
            }
            assert!(right.iter().zip(residuals(&shape, &before, &here)).any(|(a, b)| (a - b).abs() > 1e-3));
            let mut same = before.clone();
            rescale(&shape, &mut same, &here, &here).unwrap();
            assert_eq!(same, before, "{shape:?}: the same scalers leave every bit");
        }
    }

    #[test]
    fn tensors_come_in_any_order_and_behind_any_prefix() {
        for shape in shapes() {
            let right = weights(&shape);
            for prefix in ["", "model.", "a.b."] {
                let named = |own: &str| format!("{prefix}{}", own.replace("fc.", "readout.").replace("rnn.", "core."));
                assert_eq!(row(&shape, &tensors(&shape, &right, named)).unwrap(), right, "{shape:?}");
            }
        }
    }

    #[test]
    fn what_does_not_fit_is_refused_by_name() {
        let shape = &shapes()[3];
        let whole = tensors(shape, &weights(shape), str::to_owned);
        let refused = |change: &dyn Fn(&mut Vec<Tensor>)| {
            let mut tensors = whole.clone();
            change(&mut tensors);
            row(shape, &tensors).unwrap_err().to_string()
        };
        let at = |name: &str| whole.iter().position(|tensor| tensor.name == name).unwrap();
        assert!(refused(&|t| drop(t.remove(at("rnn.weight_hh_l1")))).contains("no tensor rnn.weight_hh_l1 [9, 3]"));
        assert!(refused(&|t| drop(t.remove(at("fc.bias")))).contains("no tensor fc.bias [2]"));
        assert!(
            refused(&|t| t[at("fc.weight")].axes = vec![3, 2])
                .contains("fc.weight is [3, 2], and the network needs [2, 3]")
        );
        assert!(refused(&|t| t[at("rnn.bias_hh_l0")].values[1] = f32::NAN).contains("rnn.bias_hh_l0 holds NaN"));
        let more = |name: &str| Tensor { name: name.into(), axes: vec![1], values: vec![0.0] };
        assert!(refused(&|t| t.push(more("rnn.weight_ih_l0_reverse"))).contains("rnn.weight_ih_l0_reverse beside"));
        assert!(refused(&|t| t.push(more("other.weight_ih_l1"))).contains("could both be rnn.weight_ih_l1"));
    }
}
