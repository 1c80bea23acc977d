//! Gated recurrent unit, with the equations of `torch.nn.GRU`.
//!
//! ```text
//! ρ = W_ir u + b_ir + W_hr h + b_hr      r = σ(ρ)
//! ζ = W_iz u + b_iz + W_hz h + b_hz      z = σ(ζ)
//! c = W_hn h + b_hn,  a = W_in u + b_in  n = tanh(a + r c)
//! h' = (1 − z) n + z h
//! ```
//!
//! A layer is one matrix on its features (u, 1, h), of which two corners are empty:
//!
//! | rows   | u    | 1           | h    |
//! | ------ | ---- | ----------- | ---- |
//! | ρ, ζ   | W_i  | b_i + b_h   | W_h  |
//! | c      | –    | b_hn        | W_hn |
//! | a      | W_in | b_in        | –    |
//!
//! The input u of a layer above the first is the new state of the one below.

mod passes;

use crate::matrix::Matrix;
use crate::plan::{Place, Plan};
use crate::shape::GruShape;

/// A network whose weights have their places.
#[derive(Clone, Debug)]
pub(crate) struct Gru {
    pub units: usize,
    inputs: usize,
    pub layers: Vec<GruLayer>,
}

/// Places of a layer's matrices, and the width of its input.
#[derive(Clone, Debug)]
pub(crate) struct GruLayer {
    pub inputs: usize,
    pub forward: Corners,
    gradient: Corners,
    /// Place of the matrix of ρ, ζ, c by h.
    by_state: Place,
    /// Places of the matrices of ρ, ζ by u, and of a by u.
    by_input: [Place; 2],
}

/// The parts of a layer's matrix that are not empty.
#[derive(Clone, Debug)]
pub(crate) struct Corners {
    /// Matrix of ρ, ζ on (u, 1, h).
    pub gates: Place,
    /// Matrix of c on (1, h).
    pub state: Place,
    /// Matrix of a on (u, 1).
    pub input: Place,
}

impl Gru {
    /// Takes its parameters from the plan in torch's order.
    pub fn new(shape: GruShape, inputs: usize, plan: &mut Plan) -> Self {
        let layers = (0..shape.layers)
            .map(|l| GruLayer::new(if l == 0 { inputs } else { shape.units }, shape.units, plan))
            .collect();
        Self { units: shape.units, inputs, layers }
    }
}

impl GruLayer {
    fn new(inputs: usize, units: usize, plan: &mut Plan) -> Self {
        let whole = whole(inputs, units, plan);
        let (u, u_and_one) = (0..inputs, 0..inputs + 1);
        let (h, one_and_h) = (inputs + 1..whole.columns, inputs..whole.columns);
        let (gates, c, a) = (0..2 * units, 2 * units..3 * units, 3 * units..4 * units);
        let corners = [
            whole.part(gates.clone(), 0..whole.columns),
            whole.part(c.clone(), one_and_h),
            whole.part(a.clone(), u_and_one),
        ];
        let [gates_forward, c_forward, a_forward] = corners.clone().map(|part| plan.forward(part));
        let [gates_gradient, c_gradient, a_gradient] = corners.map(|part| plan.gradient(part));
        Self {
            inputs,
            forward: Corners { gates: gates_forward, state: c_forward, input: a_forward },
            gradient: Corners { gates: gates_gradient, state: c_gradient, input: a_gradient },
            by_state: plan.backward(&whole.part(0..3 * units, h)),
            by_input: [plan.backward(&whole.part(gates, u.clone())), plan.backward(&whole.part(a, u))],
        }
    }
}

/// Returns the rows ρ, ζ, c, a on features (u, 1, h), from torch's rows r, z, n of four parameters.
fn whole(inputs: usize, units: usize, plan: &mut Plan) -> Matrix {
    let [weight_i, weight_h] = [inputs, units].map(|width| plan.parameters(3 * units * width));
    let [bias_i, bias_h] = [(); 2].map(|()| plan.parameters(3 * units));
    let (u, one, h) = (0..inputs, inputs..inputs + 1, inputs + 1..inputs + 1 + units);
    let (gates, c, a) = (0..2 * units, 2 * units..3 * units, 3 * units..4 * units);
    Matrix::new(4 * units, inputs + 1 + units)
        .with(gates.clone(), u.clone(), weight_i, inputs)
        .with(gates.clone(), h.clone(), weight_h, units)
        .with(gates.clone(), one.clone(), bias_i, 1)
        .with(gates, one.clone(), bias_h, 1)
        .with(c.clone(), h, weight_h + 2 * units * units, units)
        .with(c, one.clone(), bias_h + 2 * units, 1)
        .with(a.clone(), u, weight_i + 2 * units * inputs, inputs)
        .with(a, one, bias_i + 2 * units, 1)
}
