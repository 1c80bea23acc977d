//! Description of a network's step beside its weights, as JSON: the signals of its channels, scalers, and when a
//! stretch begins.

use acm_kernels::{Activation, Body};
use acm_stream::{Parts, Source, StateRule};
use serde_json::{Value, json};

use crate::rehearsal::Vectors;
use crate::{ExportError, Origin};

/// Words at the head of every description; the second are those of earlier versions.
pub const MARKS: &[&str] = &["{\n  \"acm_export\": ", "{\n  \"channels\": [\n    {\n      \"rate\": "];

/// Returns the description without the recorded vectors.
pub fn of(parts: &Parts, origin: &Origin, hash: &str) -> Value {
    let name = |source: &Source| match source {
        Source::Actuator(a) => parts.signals.actuators[*a].clone(),
        Source::Context(e) => parts.signals.contexts[*e].clone(),
    };
    let channels: Vec<Value> =
        parts.channels.iter().map(|c| json!({ "signal": name(&c.source), "rate": c.rate })).collect();
    let window = match parts.state {
        StateRule::Running => Value::Null,
        StateRule::Window(length) => json!(length),
    };
    json!({
        "acm_export": env!("CARGO_PKG_VERSION"),
        "source": origin.source,
        "sha256": hash,
        "channels": channels,
        "inputs": { "mean": parts.inputs.mean, "spread": parts.inputs.spread },
        "targets": { "mean": parts.targets.mean, "spread": parts.targets.spread },
        "straight": parts.straight,
        "max_gap": parts.max_gap,
        "first_elapsed": parts.first_elapsed,
        "window": window,
        "members": 1 + parts.members.len(),
        "network": network(parts),
    })
}

fn network(parts: &Parts) -> Value {
    let (inputs, outputs) = (parts.network.inputs, parts.network.outputs);
    match &parts.network.body {
        Body::Cfc(cfc) => json!({
            "kind": "cfc", "inputs": inputs, "outputs": outputs, "units": cfc.units, "mode": cfc.mode,
            "backbone_units": cfc.backbone_units, "backbone_layers": cfc.backbone_layers,
            "activation": activation(cfc.activation),
        }),
        Body::Gru(gru) => {
            json!({ "kind": "gru", "inputs": inputs, "outputs": outputs, "units": gru.units, "layers": gru.layers })
        }
        Body::Mlp(mlp) => json!({
            "kind": "mlp", "inputs": inputs, "outputs": outputs, "hidden": mlp.hidden,
            "activation": activation(mlp.activation),
        }),
    }
}

/// Returns the name in ncps.
fn activation(activation: Activation) -> Value {
    json!(activation)
}

/// Returns the description with recorded steps, as the bytes of a file.
///
/// # Errors
/// A number is not finite.
pub fn with_vectors(mut about: Value, vectors: &Vectors) -> Result<Vec<u8>, ExportError> {
    let steps: Vec<Value> = vectors
        .steps
        .iter()
        .map(|step| {
            json!({
                "channels": step.channels, "elapsed": step.elapsed, "begins": step.begins, "residual": step.residual,
            })
        })
        .collect();
    about["self_test"] = json!({ "output_rms": vectors.rms, "steps": steps });
    let mut bytes = serde_json::to_vec_pretty(&about)?;
    bytes.push(b'\n');
    Ok(bytes)
}
