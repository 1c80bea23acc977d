//! A continuum arm as C: tables of its integration grids, and what folds them.
//!
//! Where `arm.tolerance` lets the number of steps depend on the strain, so many grids are written as the recorded samples need, and
//! one more; strains beyond are computed on the finest.

use acm_core::StrainModel;
use acm_core::fields::FieldModel;
use acm_core::grid::{Grid, Variation};
use acm_core::strain::StrainBasis;
use nalgebra::Vector3;

use super::Written;
use super::text::{double, doubles, integers, rows};

const GRID: &str = include_str!("runtime/grid.c");
const FOLD: &str = include_str!("runtime/fold.c");
const ARM: &str = include_str!("runtime/arm.c");
const REFINED: &str = include_str!("runtime/arm_refined.c");
const LOADS: &str = include_str!("runtime/loads.c");

/// Writes the tables and functions of a strain model: `strain` and `arm`, and `add_loads` where `down` is given. `met`
/// are actuators that the arm meets, which determine the number of grids.
pub fn write(model: &StrainModel, down: Option<Vector3<f64>>, met: &[Vec<f64>]) -> Written {
    let grids = &model.shape().grids()[..levels(model, met)];
    let grid = &grids[0];
    let twist = match grid.variation {
        Variation::Constant => include_str!("runtime/magnus_constant.c"),
        Variation::Linear => include_str!("runtime/magnus_linear.c"),
        Variation::Any => include_str!("runtime/magnus_any.c"),
    };
    let base = model.base_pose();
    let turn: Vec<Vec<String>> = (0..3).map(|i| (0..3).map(|j| double(base.rotation[(i, j)])).collect()).collect();
    let mut source = format!(
        "\n#define FUNCTIONS {} /* strain functions about each axis */\n#define ACTIVE {} /* of them in one step */\n\
         #define MARKERS {}\n",
        grid.functions,
        grid.active,
        model.at().len(),
    );
    source += &format!("\n{GRID}\n{twist}\n{FOLD}\n");
    source += &match model.arm().tolerance.filter(|_| model.shape().grids().len() > 1) {
        None => alone(grid, model.at().len()),
        Some(tolerance) => refined(grids, model.at().len(), tolerance),
    };
    source += &format!(
        "/* From the arm's own frame to the measurement frame; where the base is, m. */\n{}",
        rows("double", "TURN", &turn)
    );
    source += &doubles("BASE", base.position.as_slice());
    source += &format!("\n{}\n{}", strain(model), if grids.len() > 1 { REFINED } else { ARM });
    let mut needs = vec!["vector", "coefficients"];
    needs.extend((grids.len() > 1).then_some("dot"));
    if let Some(down) = down {
        source += &loads(model, &FieldModel::new(model, down));
        needs.extend(["dot", "sqrt_d", "rotate"]);
    }
    Written { source, needs, ..Written::default() }
}

/// Returns the number of grids that the actuators `met` need, and one more; 1 without a tolerance.
fn levels(model: &StrainModel, met: &[Vec<f64>]) -> usize {
    let shape = model.shape();
    let need = |q: &Vec<f64>| {
        let c = model.strain_coordinates(q);
        shape.grid_for(&c, &mut shape.scratch(c.len()))
    };
    let needed = met.iter().map(need).max().unwrap_or(0);
    shape.grids().len().min(needed + 2)
}

/// Returns the grid of an arm with one.
fn alone(grid: &Grid, markers: usize) -> String {
    let after = integers("MARKER_AFTER", &passed(grid, markers));
    format!("#define STEPS {}\n\n{}{after}", grid.steps.len(), tables("ARM", grid))
}

/// Returns the grids of an arm that chooses among them.
fn refined(grids: &[Grid], markers: usize, tolerance: f64) -> String {
    let one = |(level, grid): (usize, &Grid)| tables(&format!("ARM_{level}"), grid);
    let names: Vec<String> = (0..grids.len()).map(|level| format!("&ARM_{level}_GRID")).collect();
    let after = |grid: &Grid| -> Vec<String> { passed(grid, markers).iter().map(ToString::to_string).collect() };
    format!(
        "#define LEVELS {} /* grids, each with twice the steps of the one before */\n#define TOLERANCE {} /* m */\n\n{}\
         static const grid *const ARM[LEVELS] = {{ {} }};\n{}",
        grids.len(),
        double(tolerance),
        grids.iter().enumerate().map(one).collect::<String>(),
        names.join(", "),
        rows("int", "MARKER_AFTER", &grids.iter().map(after).collect::<Vec<_>>()),
    )
}

/// Returns a grid as constant tables.
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

/// Returns the steps before each marker.
fn passed(grid: &Grid, count: usize) -> Vec<usize> {
    let mut after = vec![0; count];
    grid.stops.iter().for_each(|stop| after[stop.marker] = stop.after);
    after
}

/// Returns the function `strain`: actuators to strain coordinates.
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

/// Writes `double m[…]` and a line for each monomial of the actuators `q`: an earlier one times an actuator.
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

/// Writes the tables of the nodes that loads act at, and the function `add_loads`.
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
