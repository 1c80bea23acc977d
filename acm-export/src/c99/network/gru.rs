//! Layers of gated recurrent units.

use acm_kernels::GruShape;

use super::tables::{Map, Named, Networks, padded};

const GRU: &str = "\
    memcpy(u, @X, @I * sizeof *u);
    memcpy(u + @I, h + @H, @U * sizeof *u);
    affine(@GATES, @A, @2P, u, gates);
    affine(@STATE, @U, @P, h + @H, c);
    affine(@INPUT, @I, @P, u, a);
    for (int j = 0; j < @U; ++j) {
        const float reset = sigmoid_f(gates[j]), keep = sigmoid_f(gates[@P + j]);
        const float new_state = tanh_f(a[j] + reset * c[j]);
        h[@H + j] = new_state + keep * (h[@H + j] - new_state);
    }
";

/// Parameters of one layer, the three parts r, z, n below one another.
struct GruLayer<'n> {
    by_input: Vec<Vec<f32>>,
    by_state: Vec<Vec<f32>>,
    bias_input: &'n [f32],
    bias_state: &'n [f32],
}

impl<'n> GruLayer<'n> {
    fn of(named: &'n Named, l: usize, inputs: usize, units: usize) -> Self {
        let rows = |name: &str, width| named.values(&format!("rnn.{name}_l{l}")).chunks(width).map(<[f32]>::to_vec);
        Self {
            by_input: rows("weight_ih", inputs).collect(),
            by_state: rows("weight_hh", units).collect(),
            bias_input: named.values(&format!("rnn.bias_ih_l{l}")),
            bias_state: named.values(&format!("rnn.bias_hh_l{l}")),
        }
    }

    /// Returns the maps of r and z, from input and state together.
    fn gates(&self, units: usize) -> Vec<Map> {
        let gate = |first: usize| Map {
            weight: (first..first + units).map(|o| [&self.by_input[o][..], &self.by_state[o]].concat()).collect(),
            bias: (first..first + units).map(|o| self.bias_input[o] + self.bias_state[o]).collect(),
        };
        vec![gate(0), gate(units)]
    }

    /// Returns the map of n from the state.
    fn of_state(&self, units: usize) -> Vec<Map> {
        vec![Map { weight: self.by_state[2 * units..].to_vec(), bias: self.bias_state[2 * units..].to_vec() }]
    }

    /// Returns the map of n from the input.
    fn of_input(&self, units: usize) -> Vec<Map> {
        vec![Map { weight: self.by_input[2 * units..].to_vec(), bias: self.bias_input[2 * units..].to_vec() }]
    }
}

/// Writes the tables, the body and the required fragments.
pub fn write(gru: &GruShape, inputs: usize, networks: &Networks) -> (String, String, Vec<&'static str>) {
    let (units, p) = (gru.units, padded(gru.units));
    let widest = inputs.max(units) + units;
    let mut tables = String::new();
    let mut body = format!("    float u[{widest}], gates[{}], c[{p}], a[{p}];\n", 2 * p);
    for l in 0..gru.layers {
        let own = if l == 0 { inputs } else { units };
        let [gates, state, input] = ["GATES", "STATE", "INPUT"].map(|name| format!("{name}_{}", l + 1));
        tables += &networks.table(
            &gates,
            "r = sigmoid(Wr (x, h) + br), z = sigmoid(Wz (x, h) + bz): r, z side by side",
            |named| GruLayer::of(named, l, own, units).gates(units),
        );
        tables += &networks.table(&state, "c = W h + b", |named| GruLayer::of(named, l, own, units).of_state(units));
        tables += &networks.table(&input, "n = tanh(W x + b + r c), h' = (1 - z) n + z h", |named| {
            GruLayer::of(named, l, own, units).of_input(units)
        });
        let from = if l == 0 { "x".to_owned() } else { format!("h + {}", (l - 1) * units) };
        let places = [
            ("@GATES", networks.place(&gates)),
            ("@STATE", networks.place(&state)),
            ("@INPUT", networks.place(&input)),
            ("@X", from),
            ("@2P", (2 * p).to_string()),
            ("@I", own.to_string()),
            ("@H", (l * units).to_string()),
            ("@U", units.to_string()),
            ("@A", (own + units).to_string()),
            ("@P", p.to_string()),
        ];
        body += &places
            .iter()
            .fold(GRU.to_owned(), |text, (key, value)| text.replace(key, value))
            .replace("h + 0", "h")
            .replace("h[0 + j]", "h[j]");
    }
    (tables, body, vec!["tanh_f", "sigmoid_f"])
}
