//! The network as C: weights in constant tables, one function for a step.

use acm_kernels::{Activation, Body, CfcMode, CfcShape, GruShape, MlpShape};
use acm_stream::Parts;

use super::Written;
use super::text::{float, items};
use crate::{Parameter, parameters};

/// Columns of a table come in groups of so many.
const LANES: usize = 8;

/// A count of columns with what fills the last group.
pub fn padded(columns: usize) -> usize {
    columns.next_multiple_of(LANES)
}

/// Affine maps side by side over the same inputs: weight row by row `[outputs][inputs]`, and bias.
struct Map {
    weight: Vec<Vec<f32>>,
    bias: Vec<f32>,
}

/// Parameters by name.
struct Named(Vec<Parameter>);

impl Named {
    fn values(&self, name: &str) -> &[f32] {
        self.0.iter().find(|parameter| parameter.name == name).map_or(&[], |parameter| &parameter.values)
    }

    fn map(&self, name: &str) -> Map {
        let bias = self.values(&format!("{name}.bias")).to_vec();
        let weight = self.values(&format!("{name}.weight"));
        Map { weight: weight.chunks(weight.len() / bias.len()).map(<[f32]>::to_vec).collect(), bias }
    }
}

/// Tables and the function `network`.
pub fn write(parts: &Parts) -> Written {
    let shape = &parts.network;
    let named = Named(parameters(shape, &parts.weights));
    let (tables, body, mut needs) = match &shape.body {
        Body::Cfc(cfc) => of_cfc(cfc, shape.inputs, &named),
        Body::Gru(gru) => of_gru(gru, shape.inputs, &named),
        Body::Mlp(mlp) => of_mlp(mlp, shape.inputs, &named),
    };
    let head = table("HEAD", "y = W h + b", &[named.map("fc")]);
    let state = if has_state(parts) { "float *h, " } else { "" };
    let elapsed = if body.contains("elapsed") { "" } else { "    (void)elapsed;\n" };
    let source = format!(
        "{tables}{head}\n/* One step: standardised channels x and the time since the sample before, s, to standardised predictions y. */\n\
         static void network(const float *x, float elapsed, {state}float *y)\n{{\n{body}{elapsed}    \
         affine(HEAD, {}, {}, {}, y);\n}}\n",
        shape.features(),
        padded(shape.outputs),
        features(&shape.body),
    );
    needs.push("affine");
    Written { source, needs, ..Written::default() }
}

/// Whether the network remembers.
pub fn has_state(parts: &Parts) -> bool {
    parts.network.layers_with_state() > 0
}

/// What the head reads.
fn features(body: &Body) -> String {
    match body {
        Body::Cfc(_) => "h".into(),
        Body::Gru(gru) => format!("h + {}", (gru.layers - 1) * gru.units),
        Body::Mlp(mlp) if mlp.hidden.is_empty() => "x".into(),
        Body::Mlp(mlp) => format!("a{}", mlp.hidden.len()),
    }
}

/// Bias, then one row for each input; each map's columns fill groups of their own.
fn table(name: &str, equation: &str, maps: &[Map]) -> String {
    let inputs = maps.first().and_then(|map| map.weight.first()).map_or(0, Vec::len);
    let width: usize = maps.iter().map(|map| padded(map.bias.len())).sum();
    let mut values = vec![0.0; (1 + inputs) * width];
    let mut first = 0;
    for map in maps {
        for (o, (row, bias)) in map.weight.iter().zip(&map.bias).enumerate() {
            values[first + o] = *bias;
            row.iter().enumerate().for_each(|(i, weight)| values[(1 + i) * width + first + o] = *weight);
        }
        first += padded(map.bias.len());
    }
    let items = items(values.iter().map(|value| float(*value)));
    format!(
        "\n/* {equation}: b, then a row for each of {inputs} inputs. */\nstatic const float {name}[{}] = {{\n{items}}};\n",
        values.len()
    )
}

/// Name of the function, and what it does.
fn activation(activation: Activation) -> &'static str {
    match activation {
        Activation::LecunTanh => "lecun_tanh",
        Activation::Tanh => "tanh_activation",
        Activation::Relu => "relu",
        Activation::Silu => "silu",
        Activation::Gelu => "gelu",
    }
}

/// `a = φ(W x + b)`.
fn layer(to: &str, from: &str, map: &str, inputs: usize, outputs: usize, function: &str) -> String {
    let width = padded(outputs);
    format!(
        "    affine({map}, {inputs}, {width}, {from}, {to});\n    for (int j = 0; j < {width}; ++j) {{\n        \
         {to}[j] = {function}({to}[j]);\n    }}\n"
    )
}

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
        h[j] = LEVEL[j] - LEVEL[j] * exp_f(-elapsed * (RATE[j] + size)) * m[j];
    }
";

fn of_cfc(cfc: &CfcShape, inputs: usize, named: &Named) -> (String, String, Vec<&'static str>) {
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
        let map = named.map(&format!("rnn_cell.backbone.{}", 2 * l));
        tables += &table(
            &name,
            &format!(
                "layer {} of the backbone over {}, W x + b",
                l + 1,
                if l == 0 { "(x, h)" } else { "the one below" }
            ),
            &[map],
        );
        let to = format!("a{}", l + 1);
        body += &layer(&to, &from, &name, before, width, activation(cfc.activation));
        (from, before) = (to, width);
    }
    let names: &[&str] = if pure { &["ff1"] } else { &["ff1", "ff2", "time_a", "time_b"] };
    let maps: Vec<Map> = names.iter().map(|name| named.map(&format!("rnn_cell.{name}"))).collect();
    let equation = match cfc.mode {
        CfcMode::Default => "h' = (1 - g) tanh N1 + g tanh N2, g = sigmoid(Na dt + Nb): N1, N2, Na, Nb side by side",
        CfcMode::NoGate => "h' = tanh N1 + g tanh N2, g = sigmoid(Na dt + Nb): N1, N2, Na, Nb side by side",
        CfcMode::Pure => "h' = A - A exp(-dt (|w_tau| + |N1|)) N1: N1",
    };
    tables += &table("MAPS", equation, &maps);
    let columns = if pure { padded(units) } else { 4 * padded(units) };
    body += &format!("    affine(MAPS, {before}, {columns}, {from}, m);\n");
    let mut needs = if cfc.backbone_layers > 0 { vec![activation(cfc.activation)] } else { vec![] };
    if pure {
        let row = |name: &str, values: Vec<f32>| {
            format!("static const float {name}[{units}] = {{\n{}}};\n", items(values.into_iter().map(float)))
        };
        let rate = named.values("rnn_cell.w_tau").iter().map(|rate| rate.abs()).collect();
        tables += &format!("\n/* |w_tau|, 1/s, and A. */\n{}", row("RATE", rate));
        tables += &row("LEVEL", named.values("rnn_cell.A").to_vec());
        body += &PURE.replace("@U", &units.to_string());
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

const GRU: &str = "\
    memcpy(u, @X, @I * sizeof *u);
    memcpy(u + @I, h + @H, @U * sizeof *u);
    affine(GATES_@L, @A, @2P, u, gates);
    affine(STATE_@L, @U, @P, h + @H, c);
    affine(INPUT_@L, @I, @P, u, a);
    for (int j = 0; j < @U; ++j) {
        const float reset = sigmoid_f(gates[j]), keep = sigmoid_f(gates[@P + j]);
        const float new_state = tanh_f(a[j] + reset * c[j]);
        h[@H + j] = new_state + keep * (h[@H + j] - new_state);
    }
";

fn of_gru(gru: &GruShape, inputs: usize, named: &Named) -> (String, String, Vec<&'static str>) {
    let (units, p) = (gru.units, padded(gru.units));
    let widest = inputs.max(units) + units;
    let mut tables = String::new();
    let mut body = format!("    float u[{widest}], gates[{}], c[{p}], a[{p}];\n", 2 * p);
    for l in 0..gru.layers {
        let own = if l == 0 { inputs } else { units };
        let [w_i, w_h] = [("ih", own), ("hh", units)].map(|(name, width)| {
            named.values(&format!("rnn.weight_{name}_l{l}")).chunks(width).map(<[f32]>::to_vec).collect::<Vec<_>>()
        });
        let [b_i, b_h] = ["ih", "hh"].map(|name| named.values(&format!("rnn.bias_{name}_l{l}")));
        let both = |first: usize| Map {
            weight: (first..first + units).map(|o| [w_i[o].clone(), w_h[o].clone()].concat()).collect(),
            bias: (first..first + units).map(|o| b_i[o] + b_h[o]).collect(),
        };
        let part = |w: &[Vec<f32>], b: &[f32]| Map { weight: w[2 * units..].to_vec(), bias: b[2 * units..].to_vec() };
        let n = l + 1;
        tables += &table(
            &format!("GATES_{n}"),
            "r = sigmoid(Wr (x, h) + br), z = sigmoid(Wz (x, h) + bz): r, z side by side",
            &[both(0), both(units)],
        );
        tables += &table(&format!("STATE_{n}"), "c = W h + b", &[part(&w_h, b_h)]);
        tables += &table(&format!("INPUT_{n}"), "n = tanh(W x + b + r c), h' = (1 - z) n + z h", &[part(&w_i, b_i)]);
        let from = if l == 0 { "x".to_owned() } else { format!("h + {}", (l - 1) * units) };
        let places = [
            ("@X", from),
            ("@2P", (2 * p).to_string()),
            ("@I", own.to_string()),
            ("@H", (l * units).to_string()),
            ("@U", units.to_string()),
            ("@A", (own + units).to_string()),
            ("@P", p.to_string()),
            ("@L", n.to_string()),
        ];
        body += &places
            .iter()
            .fold(GRU.to_owned(), |text, (key, value)| text.replace(key, value))
            .replace("h + 0", "h")
            .replace("h[0 + j]", "h[j]");
    }
    (tables, body, vec!["tanh_f", "sigmoid_f"])
}

fn of_mlp(mlp: &MlpShape, inputs: usize, named: &Named) -> (String, String, Vec<&'static str>) {
    let (mut tables, mut body) = (String::new(), String::new());
    for (l, width) in mlp.hidden.iter().enumerate() {
        body += &format!("    float a{}[{}];\n", l + 1, padded(*width));
    }
    let (mut from, mut before) = (String::from("x"), inputs);
    for (l, width) in mlp.hidden.iter().enumerate() {
        let (name, to) = (format!("LAYER_{}", l + 1), format!("a{}", l + 1));
        tables += &table(&name, "W x + b", &[named.map(&format!("layers.{}", 2 * l))]);
        body += &layer(&to, &from, &name, before, *width, activation(mlp.activation));
        (from, before) = (to, *width);
    }
    let needs = if mlp.hidden.is_empty() { vec![] } else { vec![activation(mlp.activation)] };
    (tables, body, needs)
}
