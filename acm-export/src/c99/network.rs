//! The network as C: weights in constant tables, one function for a step, and the mean over an ensemble.

mod cfc;
mod gru;
mod layer;
mod mlp;
mod tables;

use acm_kernels::Body;
use acm_stream::Parts;

pub use tables::padded;

use self::tables::Networks;
use super::Written;
use crate::weights_of_each;

/// Writes the tables and the function `network`.
pub fn write(parts: &Parts) -> Written {
    let shape = &parts.network;
    let networks = Networks::of(parts);
    let (tables, body, mut needs) = match &shape.body {
        Body::Cfc(cfc) => cfc::write(cfc, shape.inputs, &networks),
        Body::Gru(gru) => gru::write(gru, shape.inputs, &networks),
        Body::Mlp(mlp) => mlp::write(mlp, shape.inputs, &networks),
    };
    let head = networks.table("HEAD", "y = W h + b", |named| vec![named.map("fc")]);
    let elapsed = if body.contains("elapsed") { "" } else { "    (void)elapsed;\n" };
    let answer = format!(
        "    affine({}, {}, {}, {}, y);\n",
        networks.place("HEAD"),
        shape.features(),
        padded(shape.outputs),
        features(&shape.body),
    );
    let one = networks.count() == 1;
    let function = if one { "network(" } else { "member(int n, " };
    let source = format!(
        "{tables}{head}\n/* One step: standardised channels x and the time since the sample before, s, to standardised predictions y. */\n\
         static void {function}const float *x, float elapsed, {}float *y)\n{{\n{body}{elapsed}{answer}}}\n{}",
        if has_state(parts) { "float *h, " } else { "" },
        if one { String::new() } else { mean(parts, networks.count()) },
    );
    needs.push("affine");
    Written { source, needs, ..Written::default() }
}

const MEAN: &str = "
/* The mean over the networks, each of which has a state of its own. */
static void network(const float *x, float elapsed, @STATEfloat *y)
{
    memset(y, 0, @P * sizeof *y);
    for (int n = 0; n < @N; ++n) {
        float own[@P];
        member(n, x, elapsed, @OWNown);
        for (int o = 0; o < @P; ++o) {
            y[o] += own[o];
        }
    }
    for (int o = 0; o < @P; ++o) {
        y[o] /= @N.0f;
    }
}
";

/// Returns the function `network` of an ensemble.
fn mean(parts: &Parts, count: usize) -> String {
    let state = parts.network.layers_with_state() * parts.network.features();
    let (given, own) = match state {
        0 => (String::new(), String::new()),
        state => ("float *h, ".into(), format!("h + n * {state}, ")),
    };
    let places = [
        ("@STATE", given),
        ("@OWN", own),
        ("@P", padded(parts.network.outputs).to_string()),
        ("@N", count.to_string()),
    ];
    places.iter().fold(MEAN.to_owned(), |text, (key, value)| text.replace(key, value))
}

/// Returns whether the network has a state.
pub fn has_state(parts: &Parts) -> bool {
    parts.network.layers_with_state() > 0
}

/// Returns the length of the state; for an ensemble, of all states together.
pub fn state_size(parts: &Parts) -> usize {
    weights_of_each(parts).count() * parts.network.layers_with_state() * parts.network.features()
}

/// Returns the name of the features that the head reads.
fn features(body: &Body) -> String {
    match body {
        Body::Cfc(_) => "h".into(),
        Body::Gru(gru) => format!("h + {}", (gru.layers - 1) * gru.units),
        Body::Mlp(mlp) if mlp.hidden.is_empty() => "x".into(),
        Body::Mlp(mlp) => format!("a{}", mlp.hidden.len()),
    }
}
