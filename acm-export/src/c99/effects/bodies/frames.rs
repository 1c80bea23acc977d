//! Bodies of rotations and translations of all markers.

use super::pieces::plain_body;
use super::{Asked, Body};

/// Writes the rotation of every marker by the rotation vector `turn`, then its shift by `shift` of each axis i.
pub fn turned(asked: &Asked, equation: &'static str, before: &str, turn: &str, shift: &str) -> Body {
    let code = format!(
        "{before}    const vector turn = {turn};\n    for (int j = 0; j + 2 < {}; j += 3) {{\n        \
         const vector p = rotate(turn, vector_of(x[j], x[j + 1], x[j + 2]));\n        \
         x[j] = p.x{};\n        x[j + 1] = p.y{};\n        x[j + 2] = p.z{};\n    }}\n",
        asked.columns,
        add(shift, 0),
        add(shift, 1),
        add(shift, 2)
    );
    plain_body(equation, code)
}

fn add(shift: &str, axis: usize) -> String {
    if shift.is_empty() { String::new() } else { format!(" + {}", shift.replace("3 + i", &(3 + axis).to_string())) }
}

pub fn base_tilt(asked: &Asked) -> Body {
    let first = asked.inputs.actuators + asked.inputs.contexts;
    let before = format!(
        "    const vector down = vector_of(v[1], v[2], v[3]);\n    \
         const vector lean = cross(down, vector_of(in[{}], in[{}], in[{}]));\n    const double k = -v[0] / 9.80665;\n",
        first,
        first + 1,
        first + 2
    );
    Body {
        needs: vec!["rotate"],
        ..turned(
            asked,
            "p' = exp(w) p,   w = -(k/g) (d x a)",
            &before,
            "vector_of(k * lean.x, k * lean.y, k * lean.z)",
            "",
        )
    }
}
