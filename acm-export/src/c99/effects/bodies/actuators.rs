//! Bodies of effects on one actuator, or of one actuator on another.

use acm_core::effects::Carrier;

use super::pieces::{array, carrier, plain_body};
use super::{Asked, Body};
use crate::c99::text::double;

/// Returns the actuators that move, by z = (x − m)/h with the middle m and the half width h of each one's range.
pub fn ranged(
    asked: &Asked,
    own: usize,
    equation: &'static str,
    change: &str,
    state: Option<(&'static str, &'static str)>,
) -> Body {
    let mut code = String::new();
    for j in 0..asked.columns {
        let (high, low) = (asked.theta[own + j], asked.theta[own + asked.columns + j]);
        let (middle, half) = (0.5 * (high + low), 0.5 * (high - low));
        // An actuator at rest has no range, and no memory of it is needed.
        if 2.0 * half <= 1e-9 * (middle.abs() + half) {
            continue;
        }
        let clamp = if change.contains('e') && state.is_none() {
            "        const double e = z < -1.0 ? -1.0 : (z > 1.0 ? 1.0 : z);\n"
        } else {
            ""
        };
        code += &format!(
            "    {{\n        const double z = (x[{j}] - {}) / {};\n{clamp}        x[{j}] += {} * ({});\n    }}\n",
            literal(middle),
            double(half),
            double(half),
            change.replace("@J", &j.to_string()).replace("@N", &asked.columns.to_string())
        );
    }
    let memory = state.map_or(String::new(), |(kind, _)| array(kind, asked.columns));
    Body { memory, needs: state.into_iter().map(|(_, need)| need).collect(), ..plain_body(equation, code) }
}

/// Returns a number that may be negative, where an operator stands before it.
fn literal(value: f64) -> String {
    if value < 0.0 { format!("({})", double(value)) } else { double(value) }
}

/// Returns the factor of a length that all actuators share, for actuator `j`.
fn unit(asked: &Asked, own: usize, j: usize) -> f64 {
    if asked.instance.own_parameters() > own { asked.theta[own + j] } else { 1.0 }
}

pub fn slipping(asked: &Asked, shapes: usize, equation: &'static str, size: &str) -> Body {
    let n = asked.columns;
    let line = |j: usize| {
        let width = format!("{} * v[{n}]", double(unit(asked, n + shapes, j)));
        let size = size.replace("@J", &j.to_string()).replace("@W", &width).replace("@N + 1", &(n + 1).to_string());
        format!("    x[{j}] -= {size};\n")
    };
    let code = (0..n).map(line).collect();
    Body { memory: array("$whole_slip", n), needs: vec!["bouc_wen"], ..plain_body(equation, code) }
}

/// Widths of plays as shares of the largest.
pub const SHARES: [f64; 8] = [0.06, 0.14, 0.24, 0.36, 0.5, 0.65, 0.82, 1.0];

/// Strains of elements over a signal that yield at these shares of a travel, which follows their stiffnesses; then the strain at the first
/// sample over each travel.
pub fn stops(carrier: usize) -> String {
    let count = SHARES.len();
    let shares = SHARES.map(double).join(", ");
    format!(
        "    static const double shares[{count}] = {{{shares}}};
    double strain[{count}];
    for (int i = 0; i < {count}; ++i) {{
        const double travel = shares[i] * v[{count} * @N];
        if (!m->state[i].started) {{
            m->state[i].rest = in[{carrier}] - v[{count} * @N + 1] * travel;
            m->state[i].started = 1;
        }}
        strain[i] = in[{carrier}] - play_step(in[{carrier}], travel, &m->state[i]);
    }}
"
    )
}

pub fn prandtl_ishlinskii(asked: &Asked) -> Body {
    let plays = SHARES.len();
    let mut code = String::from("    double before;\n");
    for j in 0..asked.columns {
        code += &format!("    before = x[{j}];\n");
        for (i, share) in SHARES.iter().enumerate() {
            let radius = format!("v[{plays}] * {} * {}", double(unit(asked, plays + 1, j)), double(*share));
            code += &format!(
                "    x[{j}] += v[{i}] * (play_step(before, {radius}, &m->state[{}]) - before);\n",
                plays * j + i
            );
        }
    }
    let memory = array("$whole_play", plays * asked.columns);
    Body {
        memory,
        needs: vec!["play"],
        ..plain_body("q' = q + sum_i w_i (P_(r_i)[q] - q),   P_r the play of half-width r", code)
    }
}

pub fn coupling(asked: &Asked) -> Body {
    let n = asked.columns;
    let takes = |i: &usize| {
        matches!(asked.instance.carrier(), Carrier::Rig) || asked.instance.carrier() == Carrier::Actuator(*i)
    };
    let pairs = (0..n).filter(takes).flat_map(|i| (0..n).filter(move |&j| j != i).map(move |j| (i, j)));
    let mut code = format!("    double before[{n}];\n    memcpy(before, x, sizeof before);\n");
    code.extend(pairs.enumerate().map(|(k, (i, j))| format!("    x[{i}] += v[{k}] * before[{j}];\n")));
    plain_body("q'_i = q_i + sum_(j != i) c_ij q_j", code)
}

pub fn periodic(asked: &Asked) -> Option<Body> {
    let j = carrier(asked)?;
    let code = format!(
        "    double sine, cosine;\n    sin_cos_d(6.283185307179586 * v[2] * x[{j}], &sine, &cosine);\n    \
         x[{j}] += v[0] * sine + v[1] * cosine;\n"
    );
    Some(Body { needs: vec!["sin_cos_d"], ..plain_body("q'_j = q_j + a sin(2 pi N q_j) + b cos(2 pi N q_j)", code) })
}
