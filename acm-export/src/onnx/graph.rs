//! The graph of a step, node by node.

use acm_kernels::{Activation, Body, CfcMode, CfcShape, GruShape, MlpShape, Shape};
use acm_stream::{Parts, Scaler};
use serde_json::Value;

use super::message::{
    ATTRIBUTE_INT, AttributeProto, DOUBLE, Dimension, FLOAT, GraphProto, INT64, ModelProto, NodeProto,
    OperatorSetIdProto, StringStringEntryProto, TensorProto, TensorShapeProto, TensorType, TypeProto, ValueInfoProto,
};
use crate::{Origin, Parameter, parameters, weights_of_each};

/// Version of the operators, and the first version of the format that has it.
const OPSET: i64 = 17;
const IR: i64 = 8;

/// Returns the model; `about` becomes its metadata.
pub fn model(parts: &Parts, origin: &Origin, about: &Value) -> ModelProto {
    let entries = about.as_object().into_iter().flatten();
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let metadata = entries.map(|(key, value)| StringStringEntryProto { key: key.clone(), value: text(value) });
    ModelProto {
        ir_version: IR,
        producer_name: "acm-export".into(),
        producer_version: env!("CARGO_PKG_VERSION").into(),
        doc_string: format!("One step of a trained network, from {}", origin.source),
        graph: Some(graph(parts, &origin.name)),
        opset_import: vec![OperatorSetIdProto { domain: String::new(), version: OPSET }],
        metadata_props: metadata.collect(),
    }
}

/// Graph that grows node by node; every node's output has a descriptive name.
#[derive(Default)]
struct Graph {
    parameters: Vec<Parameter>,
    nodes: Vec<NodeProto>,
    initializers: Vec<TensorProto>,
}

fn graph(parts: &Parts, name: &str) -> GraphProto {
    let shape = &parts.network;
    let own = shape.layers_with_state() * shape.features();
    let members: Vec<Graph> = weights_of_each(parts).map(|weights| Graph::network(shape, weights)).collect();
    let state = (own * members.len()) as i64;
    let mut graph = Graph::default();
    graph.scale(&parts.inputs);
    graph.ensemble(members, own);
    graph.restore(&parts.targets, if parts.straight.is_empty() { "residual" } else { "refined" });
    graph.straight(&parts.straight);
    let mut input = vec![value("channels", DOUBLE, parts.channels.len() as i64)];
    let mut output = vec![value("residual", DOUBLE, parts.tip.len() as i64)];
    if matches!(shape.body, Body::Cfc(_)) {
        input.push(value("elapsed", FLOAT, 1));
    }
    if state > 0 {
        input.push(value("state", FLOAT, state));
        output.push(value("next_state", FLOAT, state));
    }
    let Graph { nodes, initializers, .. } = graph;
    let number = |(k, node): (usize, NodeProto)| NodeProto { name: format!("{}_{k}", node.op_type), ..node };
    let node = nodes.into_iter().enumerate().map(number).collect();
    GraphProto { node, name: name.into(), initializer: initializers, input, output }
}

fn borrowed(names: &[String]) -> Vec<&str> {
    names.iter().map(String::as_str).collect()
}

/// Returns the description of a value of shape `[N, width]`.
fn value(name: &str, elem_type: i32, width: i64) -> ValueInfoProto {
    let batch = Dimension { dim_value: None, dim_param: Some("N".into()) };
    let dim = vec![batch, Dimension { dim_value: Some(width), dim_param: None }];
    let tensor_type = Some(TensorType { elem_type, shape: Some(TensorShapeProto { dim }) });
    ValueInfoProto { name: name.into(), r#type: Some(TypeProto { tensor_type }), doc_string: String::new() }
}

fn integer(name: &str, i: i64) -> AttributeProto {
    AttributeProto { name: name.into(), i, r#type: ATTRIBUTE_INT }
}

impl Graph {
    /// Returns the graph from `z`, `elapsed` and `state` to `standardised` and `next_state`.
    fn network(shape: &Shape, weights: &[f32]) -> Self {
        let mut graph = Graph { parameters: parameters(shape, weights), ..Graph::default() };
        let features = match &shape.body {
            Body::Cfc(cfc) => graph.cfc(cfc),
            Body::Gru(gru) => graph.gru(gru),
            Body::Mlp(mlp) => graph.mlp(mlp),
        };
        graph.linear("standardised", &features, "fc");
        graph
    }

    /// Adds the mean over networks, each with `own` numbers of the state.
    fn ensemble(&mut self, mut members: Vec<Graph>, own: usize) {
        if members.len() == 1 {
            return self.absorb(members.remove(0));
        }
        let count = members.len();
        let each = |name: &str| (0..count).map(|k| format!("members.{k}.{name}")).collect::<Vec<String>>();
        let [states, next, answers] = ["state", "next_state", "standardised"].map(each);
        let along_columns = || vec![integer("axis", 1)];
        if own > 0 {
            self.constant(
                "members",
                &[count],
                INT64,
                vec![own as i64; count].into_iter().flat_map(i64::to_le_bytes).collect(),
            );
            self.node("Split", &["state", "members"], &borrowed(&states), along_columns());
        }
        members.into_iter().enumerate().for_each(|(k, member)| self.absorb(member.renamed(&format!("members.{k}."))));
        if own > 0 {
            self.node("Concat", &borrowed(&next), &["next_state"], along_columns());
        }
        let mut sum = answers[0].clone();
        for (k, answer) in answers.iter().enumerate().skip(1) {
            let next = format!("sum.{k}");
            self.op(&next, "Add", &[&sum, answer]);
            sum = next;
        }
        self.scalar("count", count as f32);
        self.op("standardised", "Div", &[&sum, "count"]);
    }

    fn absorb(&mut self, other: Graph) {
        self.nodes.extend(other.nodes);
        self.initializers.extend(other.initializers);
    }

    /// Adds a prefix to all names but those that every network reads.
    fn renamed(mut self, prefix: &str) -> Self {
        let rename = |name: &mut String| {
            if !["z", "elapsed"].contains(&name.as_str()) {
                name.insert_str(0, prefix);
            }
        };
        self.nodes.iter_mut().flat_map(|node| node.input.iter_mut().chain(&mut node.output)).for_each(rename);
        self.initializers.iter_mut().for_each(|constant| rename(&mut constant.name));
        self
    }

    fn node(&mut self, op: &str, inputs: &[&str], outputs: &[&str], attribute: Vec<AttributeProto>) {
        let named = |names: &[&str]| names.iter().map(ToString::to_string).collect();
        self.nodes.push(NodeProto {
            input: named(inputs),
            output: named(outputs),
            name: String::new(),
            op_type: op.into(),
            attribute,
        });
    }

    fn op(&mut self, output: &str, op: &str, inputs: &[&str]) {
        self.node(op, inputs, &[output], vec![]);
    }

    fn floats(&mut self, name: &str, dims: &[usize], values: &[f32]) {
        let raw_data = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.constant(name, dims, FLOAT, raw_data);
    }

    fn doubles(&mut self, name: &str, values: &[f64]) {
        let raw_data = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.constant(name, &[values.len()], DOUBLE, raw_data);
    }

    fn constant(&mut self, name: &str, dims: &[usize], data_type: i32, raw_data: Vec<u8>) {
        if self.initializers.iter().all(|known| known.name != name) {
            let dims = dims.iter().map(|&length| length as i64).collect();
            self.initializers.push(TensorProto { dims, data_type, name: name.into(), raw_data });
        }
    }

    fn parameter(&mut self, name: &str) {
        let Some(found) = self.parameters.iter().find(|parameter| parameter.name == name).cloned() else { return };
        self.floats(name, &found.shape, &found.values);
    }

    /// Adds `output = W input + b`.
    fn linear(&mut self, output: &str, input: &str, map: &str) {
        self.gemm(output, input, &format!("{map}.weight"), &format!("{map}.bias"));
    }

    fn gemm(&mut self, output: &str, input: &str, weight: &str, bias: &str) {
        self.parameter(weight);
        self.parameter(bias);
        self.node("Gemm", &[input, weight, bias], &[output], vec![integer("transB", 1)]);
    }

    /// Adds z = (x − mean)/spread, in double, then float.
    fn scale(&mut self, scaler: &Scaler) {
        self.doubles("channels.mean", &scaler.mean);
        self.doubles("channels.spread", &scaler.spread);
        self.op("centred", "Sub", &["channels", "channels.mean"]);
        self.op("scaled", "Div", &["centred", "channels.spread"]);
        self.node("Cast", &["scaled"], &["z"], vec![integer("to", i64::from(FLOAT))]);
    }

    /// Adds the straight path to `refined`, in double, where there is one.
    fn straight(&mut self, weights: &[Vec<f64>]) {
        let Some((constant, weights)) = weights.split_last() else { return };
        let bytes = weights.iter().flatten().flat_map(|weight| weight.to_le_bytes()).collect();
        self.constant("straight.weight", &[weights.len(), constant.len()], DOUBLE, bytes);
        self.doubles("straight.constant", constant);
        self.node("Cast", &["z"], &["straight.z"], vec![integer("to", i64::from(DOUBLE))]);
        self.op("straight.sum", "MatMul", &["straight.z", "straight.weight"]);
        self.op("straight", "Add", &["straight.sum", "straight.constant"]);
        self.op("residual", "Add", &["refined", "straight"]);
    }

    /// Adds the conversion to SI, in double.
    fn restore(&mut self, scaler: &Scaler, output: &str) {
        self.doubles("residual.mean", &scaler.mean);
        self.doubles("residual.spread", &scaler.spread);
        self.node("Cast", &["standardised"], &["wide"], vec![integer("to", i64::from(DOUBLE))]);
        self.op("stretched", "Mul", &["wide", "residual.spread"]);
        self.op(output, "Add", &["stretched", "residual.mean"]);
    }

    fn scalar(&mut self, name: &str, value: f32) {
        self.floats(name, &[], &[value]);
    }

    /// Adds φ of `input`, named `input.φ`.
    fn activate(&mut self, activation: Activation, input: &str) -> String {
        let [out, a, b, c, d] = ["active", "a", "b", "c", "d"].map(|end| format!("{input}.{end}"));
        match activation {
            Activation::LecunTanh => {
                self.scalar("lecun.inner", 0.666);
                self.scalar("lecun.outer", 1.7159);
                self.op(&a, "Mul", &[input, "lecun.inner"]);
                self.op(&b, "Tanh", &[&a]);
                self.op(&out, "Mul", &[&b, "lecun.outer"]);
            }
            Activation::Tanh => self.op(&out, "Tanh", &[input]),
            Activation::Relu => self.op(&out, "Relu", &[input]),
            Activation::Silu => {
                self.op(&a, "Sigmoid", &[input]);
                self.op(&out, "Mul", &[input, &a]);
            }
            // x (1 + erf(x/√2))/2: opset 17 has no Gelu.
            Activation::Gelu => {
                self.scalar("root", std::f32::consts::FRAC_1_SQRT_2);
                self.scalar("one", 1.0);
                self.scalar("half", 0.5);
                self.op(&a, "Mul", &[input, "root"]);
                self.op(&b, "Erf", &[&a]);
                self.op(&c, "Add", &[&b, "one"]);
                self.op(&d, "Mul", &[&c, "half"]);
                self.op(&out, "Mul", &[input, &d]);
            }
        }
        out
    }

    fn cfc(&mut self, cfc: &CfcShape) -> String {
        self.node("Concat", &["z", "state"], &["joined"], vec![integer("axis", 1)]);
        let mut psi = String::from("joined");
        for l in 0..cfc.backbone_layers {
            let layer = format!("backbone.{l}");
            self.linear(&layer, &psi, &format!("rnn_cell.backbone.{}", 2 * l));
            psi = self.activate(cfc.activation, &layer);
        }
        self.linear("n1", &psi, "rnn_cell.ff1");
        match cfc.mode {
            CfcMode::Pure => self.decay(),
            mode => self.gated(&psi, mode),
        }
        "next_state".into()
    }

    /// Adds h' = (1 − g) tanh N1 + g tanh N2, or tanh N1 + g tanh N2, with g = σ(Na Δt + Nb).
    fn gated(&mut self, psi: &str, mode: CfcMode) {
        self.linear("n2", psi, "rnn_cell.ff2");
        self.linear("na", psi, "rnn_cell.time_a");
        self.linear("nb", psi, "rnn_cell.time_b");
        self.op("first", "Tanh", &["n1"]);
        self.op("second", "Tanh", &["n2"]);
        self.op("over_time", "Mul", &["na", "elapsed"]);
        self.op("gate.sum", "Add", &["over_time", "nb"]);
        self.op("gate", "Sigmoid", &["gate.sum"]);
        let other = match mode {
            CfcMode::Default => {
                self.op("apart", "Sub", &["second", "first"]);
                "apart"
            }
            _ => "second",
        };
        self.op("share", "Mul", &["gate", other]);
        self.op("next_state", "Add", &["first", "share"]);
    }

    /// Adds h' = A − A exp(−Δt (|w_τ| + |N1|)) N1.
    fn decay(&mut self) {
        self.parameter("rnn_cell.w_tau");
        self.parameter("rnn_cell.A");
        self.op("rate", "Abs", &["rnn_cell.w_tau"]);
        self.op("size", "Abs", &["n1"]);
        self.op("fall", "Add", &["size", "rate"]);
        self.op("fallen", "Mul", &["fall", "elapsed"]);
        self.op("exponent", "Neg", &["fallen"]);
        self.op("left", "Exp", &["exponent"]);
        self.op("kept", "Mul", &["left", "n1"]);
        self.op("share", "Mul", &["rnn_cell.A", "kept"]);
        self.op("next_state", "Sub", &["rnn_cell.A", "share"]);
    }

    fn gru(&mut self, gru: &GruShape) -> String {
        let lengths = |count: usize| vec![gru.units as i64; count].into_iter().flat_map(i64::to_le_bytes).collect();
        self.constant("three", &[3], INT64, lengths(3));
        let layers: Vec<String> = (0..gru.layers).map(|l| format!("state.{l}")).collect();
        self.constant("layers", &[gru.layers], INT64, lengths(gru.layers));
        self.node("Split", &["state", "layers"], &borrowed(&layers), vec![integer("axis", 1)]);
        let mut below = String::from("z");
        for l in 0..gru.layers {
            below = self.gru_layer(l, &below);
        }
        let next: Vec<String> = (0..gru.layers).map(|l| format!("next.{l}")).collect();
        self.node("Concat", &borrowed(&next), &["next_state"], vec![integer("axis", 1)]);
        below
    }

    /// Adds r, z = σ(W u + b + V h + c), n = tanh(W u + b + r (V h + c)), h' = n + z (h − n).
    fn gru_layer(&mut self, l: usize, below: &str) -> String {
        let of = |name: &str| format!("{name}.{l}");
        let [by_input, by_state, state, out] = ["by_input", "by_state", "state", "next"].map(of);
        self.gemm(&by_input, below, &format!("rnn.weight_ih_l{l}"), &format!("rnn.bias_ih_l{l}"));
        self.gemm(&by_state, &state, &format!("rnn.weight_hh_l{l}"), &format!("rnn.bias_hh_l{l}"));
        let [ri, zi, ni, rh, zh, nh] = ["ri", "zi", "ni", "rh", "zh", "nh"].map(of);
        self.node("Split", &[&by_input, "three"], &[&ri, &zi, &ni], vec![integer("axis", 1)]);
        self.node("Split", &[&by_state, "three"], &[&rh, &zh, &nh], vec![integer("axis", 1)]);
        let [rs, r, zs, z, held, ns, n, apart, kept] =
            ["rs", "r", "zs", "z", "held", "ns", "n", "apart", "kept"].map(|name| of(&format!("gru_{name}")));
        self.op(&rs, "Add", &[&ri, &rh]);
        self.op(&r, "Sigmoid", &[&rs]);
        self.op(&zs, "Add", &[&zi, &zh]);
        self.op(&z, "Sigmoid", &[&zs]);
        self.op(&held, "Mul", &[&r, &nh]);
        self.op(&ns, "Add", &[&ni, &held]);
        self.op(&n, "Tanh", &[&ns]);
        self.op(&apart, "Sub", &[&state, &n]);
        self.op(&kept, "Mul", &[&z, &apart]);
        self.op(&out, "Add", &[&n, &kept]);
        out
    }

    fn mlp(&mut self, mlp: &MlpShape) -> String {
        let mut below = String::from("z");
        for l in 0..mlp.hidden.len() {
            let layer = format!("layer.{l}");
            self.linear(&layer, &below, &format!("layers.{}", 2 * l));
            below = self.activate(mlp.activation, &layer);
        }
        below
    }
}
