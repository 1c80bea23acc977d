//! Closed-form continuous-time network. Hasani et al. (2022), Nature Machine Intelligence 4.
//!
//! ```text
//! η = (u, 1, h),   ψ = (1, backbone(η)), or η without a backbone,   y = M ψ = (N_1, N_2, N_a, N_b)
//!
//! default   h' = (1 − α) a + α b,   a = tanh N_1,   b = tanh N_2,   α = σ(N_a Δt + N_b)
//! no_gate   h' = a + α b
//! pure      h' = A − A exp(−Δt (|w_τ| + |N_1|)) N_1
//! ```
//!
//! | symbol   | meaning                           | rows  | unit |
//! | -------- | --------------------------------- | ----- | ---- |
//! | `u`      | inputs                            | C     | –    |
//! | `h, h'`  | state before and after            | H     | –    |
//! | `Δt`     | time since the previous step        | 1     | s    |
//! | `w_τ, A` | decay rate, level (mode pure)     | H     | 1/s, – |

mod passes;

use crate::bodies::layer::{Layer, linear};
use crate::matrix::Matrix;
use crate::plan::{Place, Plan};
use crate::shape::{CfcMode, CfcShape};

/// A network whose weights have their places.
#[derive(Clone, Debug)]
pub(crate) struct Cfc {
    pub shape: CfcShape,
    pub inputs: usize,
    pub backbone: Vec<Layer>,
    pub maps: Layer,
    /// The first layer's matrix by u.
    by_input: Place,
    /// Rows of y that are sums.
    sums: usize,
    pub pure: Option<Pure>,
}

/// Parameters of mode pure that no input multiplies.
#[derive(Clone, Debug)]
pub(crate) struct Pure {
    /// Index of the first parameter of w_τ.
    pub rate: usize,
    /// Index of the first parameter of A.
    pub level: usize,
    /// Place of both as columns under the feature that is one: rows A, then w_τ.
    gradient: Place,
}

impl Cfc {
    /// Takes its parameters from the plan in torch's order.
    pub fn new(shape: CfcShape, inputs: usize, plan: &mut Plan) -> Self {
        let (units, width) = (shape.units, shape.backbone_units);
        let pure = (shape.mode == CfcMode::Pure).then(|| {
            let (rate, level) = (plan.parameters(units), plan.parameters(units));
            let matrix = Matrix::new(2 * units, 1).with(0..units, 0..1, level, 1).with(units..2 * units, 0..1, rate, 1);
            Pure { rate, level, gradient: plan.gradient(matrix) }
        });
        let state = inputs + 1..inputs + 1 + units;
        let mut first = None;
        let backbone = (0..shape.backbone_layers).map(|l| {
            if l == 0 {
                let matrix = over_inputs_and_state(plan, inputs, units, &[width]);
                first = Some(matrix.clone());
                return Layer::new(plan, matrix, state.clone());
            }
            let matrix = linear(plan, width, &[width]);
            Layer::new(plan, matrix, 1..1 + width)
        });
        let backbone: Vec<_> = backbone.collect();
        let maps = if pure.is_some() { vec![units] } else { vec![units; 4] };
        let sums = maps.iter().sum();
        let maps = if backbone.is_empty() {
            let matrix = over_inputs_and_state(plan, inputs, units, &maps);
            first = Some(matrix.clone());
            Layer::new(plan, matrix, state)
        } else {
            let matrix = linear(plan, width, &maps);
            Layer::new(plan, matrix, 1..1 + width)
        };
        let first = first.unwrap_or_default();
        let by_input = plan.backward(&first.part(0..first.rows, 0..inputs));
        Self { shape, inputs, backbone, maps, by_input, sums, pure }
    }

    /// Returns the index of the feature of ψ that is one.
    fn one(&self) -> usize {
        if self.backbone.is_empty() { self.inputs } else { 0 }
    }
}

/// Returns the linear layers over torch's (u, h), one below the other, on features (u, 1, h).
fn over_inputs_and_state(plan: &mut Plan, inputs: usize, units: usize, outputs: &[usize]) -> Matrix {
    let mut matrix = Matrix::new(outputs.iter().sum(), inputs + 1 + units);
    let mut row = 0;
    for &outputs in outputs {
        let (weight, rows) = (plan.parameters(outputs * (inputs + units)), row..row + outputs);
        let bias = plan.parameters(outputs);
        matrix = matrix
            .with(rows.clone(), 0..inputs, weight, inputs + units)
            .with(rows.clone(), inputs..inputs + 1, bias, 1)
            .with(rows, inputs + 1..inputs + 1 + units, weight + inputs, inputs + units);
        row += outputs;
    }
    matrix
}
