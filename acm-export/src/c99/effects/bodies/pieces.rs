//! Pieces that bodies are made of.

use acm_core::effects::Carrier;

use super::{Asked, Body};
use crate::c99::effects::place;

pub fn carrier(asked: &Asked) -> Option<usize> {
    place(asked.instance.carrier(), asked.inputs)
}

pub fn array(kind: &str, count: usize) -> String {
    format!("    {kind} state[{count}];\n")
}

pub fn plain_body(equation: &'static str, code: String) -> Body {
    Body { equation, code, ..Body::default() }
}

/// Returns a line for every column j; `@N` is their number.
pub fn each(asked: &Asked, equation: &'static str, line: &str) -> Body {
    with(asked, equation, "", line)
}

pub fn with(asked: &Asked, equation: &'static str, before: &str, line: &str) -> Body {
    let text = format!("{before}    for (int j = 0; j < @N; ++j) {{\n        {line}\n    }}\n");
    plain_body(equation, text.replace("@N", &asked.columns.to_string()))
}

/// Returns a line for the column of the actuator that carries the effect, or for every column where none does.
pub fn some(asked: &Asked, equation: &'static str, line: &str) -> Body {
    match asked.instance.carrier() {
        Carrier::Actuator(j) => {
            plain_body(equation, format!("    {{\n        const int j = {j};\n        {line}\n    }}\n"))
        }
        _ => each(asked, equation, line),
    }
}

/// Returns a body that starts with the time of the first sample in `m->start`.
pub fn since_start(asked: &Asked, equation: &'static str, line: &str) -> Body {
    let before = "    if (!m->started) {\n        m->started = 1;\n        m->start = time;\n    }\n";
    Body { memory: "    int started;\n    double start;\n".into(), ..with(asked, equation, before, line) }
}
