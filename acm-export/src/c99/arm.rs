//! A continuum arm as C: tables of its integration grids, and what folds them.

use acm_core::StrainModel;
use acm_core::fields::FieldModel;
use acm_core::grid::{Grid, Variation};
use acm_core::strain::StrainBasis;
use nalgebra::Vector3;

use super::Written;
use super::text::{double, doubles, integers, rows};
use crate::ExportError;

const GRID: &str = include_str!("runtime/grid.c");
const FOLD: &str = include_str!("runtime/fold.c");
const ARM: &str = include_str!("runtime/arm.c");
const LOADS: &str = include_str!("runtime/loads.c");

/// Tables and functions of a strain model: `strain` and `arm`, and `add_loads` where `down` is given.
pub fn write(model: &StrainModel, down: Option<Vector3<f64>>) -> Result<Written, ExportError> {
    let [grid] = model.shape().grids() else {
        return Err(ExportError::Unsupported {
            what: "an arm whose number of integration steps depends on its strain (arm.tolerance)".into(),
            format: "C99",
            remedy: "calibrate with a fixed arm.steps and without arm.tolerance",
        });
    };
    let twist = match grid.variation {
        Variation::Constant => include_str!("runtime/magnus_constant.c"),
        Variation::Linear => include_str!("runtime/magnus_linear.c"),
        Variation::Any => include_str!("runtime/magnus_any.c"),
    };
    let base = model.base_pose();
    let turn: Vec<Vec<String>> = (0..3).map(|i| (0..3).map(|j| double(base.rotation[(i, j)])).collect()).collect();
    let mut source = format!(
        "\n#define FUNCTIONS {} /* strain functions about each axis */\n#define ACTIVE {} /* of them in one step */\n\
         #define STEPS {}\n#define MARKERS {}\n",
        grid.functions,
        grid.active,
        grid.steps.len(),
        model.at().len(),
    );
    source += &format!("\n{GRID}\n{twist}\n{FOLD}\n{}", tables("ARM", grid));
    source += &integers("MARKER_AFTER", &markers(grid, model.at().len()));
    source += &format!(
        "/* From the arm's own frame to the measurement frame; where the base is, m. */\n{}",
        rows("double", "TURN", &turn)
    );
    source += &doubles("BASE", base.position.as_slice());
    source += &format!("\n{}\n{ARM}", strain(model));
    let mut needs = vec!["vector", "coefficients"];
    if let Some(down) = down {
        source += &loads(model, &FieldModel::new(model, down));
        needs.extend(["dot", "sqrt_d", "rotate"]);
    }
    Ok(Written { source, needs, ..Written::default() })
}

/// A grid as constant tables.
fn tables(name: &str, grid: &Grid) -> String {
    let lengths: Vec<f64> = grid.steps.iter().map(|step| step.length).collect();
    let first: Vec<usize> = grid.steps.iter().map(|step| step.first).collect();
    let of = |step: &acm_core::grid::Step| grid.values[step.weights..step.weights + 3 * grid.active].to_vec();
    let weights: Vec<f64> = grid.steps.iter().flat_map(of).collect();
    format!(
        "{}{}{}static const grid {name}_GRID = {{ {}, {name}_LENGTH, {name}_FIRST, {name}_WEIGHTS }};\n",
        doubles(&format!("{name}_LENGTH"), &lengths),
        integers(&format!("{name}_FIRST"), &first),
        doubles(&format!("{name}_WEIGHTS"), &weights),
        grid.steps.len(),
    )
}

/// Steps before each marker.
fn markers(grid: &Grid, count: usize) -> Vec<usize> {
    let mut after = vec![0; count];
    grid.stops.iter().for_each(|stop| after[stop.marker] = stop.after);
    after
}

/// The function `strain`: actuators to strain coordinates.
fn strain(model: &StrainModel) -> String {
    let theta = model.parameters();
    let monomials = model.monomials();
    let amplitudes: Vec<Vec<String>> = theta[model.actuation_range()]
        .chunks_exact(monomials.len())
        .map(|row| row.iter().map(|value| double(*value)).collect())
        .collect();
    let higher = &theta[model.strain_range()];
    let mut text = format!(
        "/* A_k = sum_j PHI[k][j] m_j(q), rad/m, with the monomials m of the actuators. */\n{}",
        rows("double", "PHI", &amplitudes)
    );
    let legendre = matches!(model.arm().strain, StrainBasis::Legendre { .. });
    let orders = higher.len() / 2;
    if legendre && orders > 0 {
        text += &doubles("HIGHER", higher);
    }
    text += &format!(
        "\n/* Strain coordinates c, rad/m: {}. */\nstatic void strain(const double *q, double *c)\n{{\n",
        if legendre { "kappa_i = A_i [1 + sum_n a_in P_n(2 s/L - 1)]" } else { "one bending for each segment" }
    );
    text += &monomial_lines(monomials.exponents());
    text += &format!(
        "    for (int i = 0; i < {0}; ++i) {{\n        double a = 0.0;\n        for (int j = 0; j < {1}; ++j) {{\n            \
         a += PHI[i][j] * m[j];\n        }}\n",
        model.amplitudes(),
        monomials.len()
    );
    match (legendre, orders) {
        (true, 0) | (false, _) => text += "        c[i] = a;\n",
        (true, _) => {
            text += &format!(
                "        c[i * {f}] = a;\n        for (int n = 0; n < {orders}; ++n) {{\n            \
                 c[i * {f} + n + 1] = a * HIGHER[i * {orders} + n];\n        }}\n",
                f = orders + 1
            );
        }
    }
    text + "    }\n}\n"
}

/// `double m[…]` and a line for each monomial of the actuators `q`: an earlier one times an actuator.
pub fn monomial_lines(exponents: &[Vec<usize>]) -> String {
    let mut text = format!("    double m[{}];\n", exponents.len());
    for (j, powers) in exponents.iter().enumerate() {
        let last = powers.iter().rposition(|&e| e > 0).unwrap_or(0);
        let mut fewer = powers.clone();
        fewer[last] -= 1;
        let value = match exponents.iter().position(|e| *e == fewer) {
            Some(before) => format!("m[{before}] * q[{last}]"),
            None => format!("q[{last}]"),
        };
        text += &format!("    m[{j}] = {value};\n");
    }
    text
}

/// Tables of the nodes that loads act at, and the function `add_loads`.
fn loads(model: &StrainModel, fields: &FieldModel) -> String {
    let [down, first, second] = fields.directions();
    let axis = model.arm().axis.rotation();
    let axis: Vec<Vec<String>> = (0..3).map(|i| (0..3).map(|j| double(axis[(i, j)])).collect()).collect();
    let halves = fields.half_panels();
    let mut text = format!(
        "\n#define PANELS {}\n#define NODES (2 * PANELS + 1)\n#define LENGTH {} /* m */\n",
        halves.len(),
        double(model.arm().length)
    );
    text += "/* Nodes of the arm that loads act at: a panel has three. Down and two horizontal axes in the measurement frame. */\n";
    for (name, direction) in [("DOWN", down), ("SIDE_1", first), ("SIDE_2", second)] {
        text += &doubles(name, direction.as_slice());
    }
    text += &rows("double", "AXIS", &axis);
    text += &doubles("HALF_PANEL", halves);
    text += &integers("MARKER_NODE", fields.marker_nodes());
    let [grid] = fields.nodes().grids() else { return text };
    text + &tables("NODE", grid) + "\n" + LOADS
}
