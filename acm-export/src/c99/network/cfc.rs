//! A closed-form continuous-time cell.

use acm_kernels::{CfcMode, CfcShape};

use super::layer::{activation, layer};
use super::tables::{Named, Networks, padded};

const GATED: &str = "\
    for (int j = 0; j < @U; ++j) {
        const float first = tanh_f(m[j]), second = tanh_f(m[@P + j]);
        const float gate = sigmoid_f(m[@T + j] * elapsed + m[@B + j]);
        h[j] = @RULE;
    }
";

const PURE: &str = "\
    for (int j = 0; j < @U; ++j) {
        const float size = m[j] < 0.0f ? -m[j] : m[j];
        h[j] = @LEVEL[j] - @LEVEL[j] * exp_f(-elapsed * (@RATE[j] + size)) * m[j];
    }
";

/// Writes the tables, the body and the required fragments.
pub fn write(cfc: &CfcShape, inputs: usize, networks: &Networks) -> (String, String, Vec<&'static str>) {
    let (units, width) = (cfc.units, cfc.backbone_units);
    let pure = cfc.mode == CfcMode::Pure;
    let mut tables = String::new();
    let all = inputs + units;
    let mut body = format!("    float u[{all}], m[{}];\n", if pure { padded(units) } else { 4 * padded(units) });
    for l in 0..cfc.backbone_layers {
        body += &format!("    float a{}[{}];\n", l + 1, padded(width));
    }
    body += &format!("    memcpy(u, x, {inputs} * sizeof *u);\n    memcpy(u + {inputs}, h, {units} * sizeof *u);\n");
    let (mut from, mut before) = (String::from("u"), all);
    for l in 0..cfc.backbone_layers {
        let name = format!("BACKBONE_{}", l + 1);
        let over = if l == 0 { "(x, h)" } else { "the one below" };
        tables += &networks.table(&name, &format!("layer {} of the backbone over {over}, W x + b", l + 1), |named| {
            vec![named.map(&format!("rnn_cell.backbone.{}", 2 * l))]
        });
        let to = format!("a{}", l + 1);
        body += &layer(&to, &from, &networks.place(&name), before, width, activation(cfc.activation));
        (from, before) = (to, width);
    }
    let names: &[&str] = if pure { &["ff1"] } else { &["ff1", "ff2", "time_a", "time_b"] };
    let equation = match cfc.mode {
        CfcMode::Default => "h' = (1 - g) tanh N1 + g tanh N2, g = sigmoid(Na dt + Nb): N1, N2, Na, Nb side by side",
        CfcMode::NoGate => "h' = tanh N1 + g tanh N2, g = sigmoid(Na dt + Nb): N1, N2, Na, Nb side by side",
        CfcMode::Pure => "h' = A - A exp(-dt (|w_tau| + |N1|)) N1: N1",
    };
    tables += &networks
        .table("MAPS", equation, |named| names.iter().map(|name| named.map(&format!("rnn_cell.{name}"))).collect());
    let columns = if pure { padded(units) } else { 4 * padded(units) };
    body += &format!("    affine({}, {before}, {columns}, {from}, m);\n", networks.place("MAPS"));
    let mut needs = if cfc.backbone_layers > 0 { vec![activation(cfc.activation)] } else { vec![] };
    if pure {
        let rate = |named: &Named| named.values("rnn_cell.w_tau").iter().map(|rate| rate.abs()).collect();
        tables += &format!("\n/* |w_tau|, 1/s, and A. */\n{}", networks.row("RATE", rate));
        tables += &networks.row("LEVEL", |named| named.values("rnn_cell.A").to_vec());
        let places =
            [("@U", units.to_string()), ("@RATE", networks.place("RATE")), ("@LEVEL", networks.place("LEVEL"))];
        body += &places.iter().fold(PURE.to_owned(), |text, (key, value)| text.replace(key, value));
        needs.push("exp_f");
    } else {
        let rule = match cfc.mode {
            CfcMode::NoGate => "first + gate * second",
            _ => "first + gate * (second - first)",
        };
        let p = padded(units);
        let places = [("@U", units), ("@P", p), ("@T", 2 * p), ("@B", 3 * p)];
        let text = places.iter().fold(GATED.to_owned(), |text, (key, value)| text.replace(key, &value.to_string()));
        body += &text.replace("@RULE", rule);
        needs.extend(["tanh_f", "sigmoid_f"]);
    }
    (tables, body, needs)
}
