//! A perceptron.

use acm_kernels::MlpShape;

use super::layer::{activation, layer};
use super::tables::{Networks, padded};

/// Writes the tables, the body and the required fragments.
pub fn write(mlp: &MlpShape, inputs: usize, networks: &Networks) -> (String, String, Vec<&'static str>) {
    let (mut tables, mut body) = (String::new(), String::new());
    for (l, width) in mlp.hidden.iter().enumerate() {
        body += &format!("    float a{}[{}];\n", l + 1, padded(*width));
    }
    let (mut from, mut before) = (String::from("x"), inputs);
    for (l, width) in mlp.hidden.iter().enumerate() {
        let (name, to) = (format!("LAYER_{}", l + 1), format!("a{}", l + 1));
        tables += &networks.table(&name, "W x + b", |named| vec![named.map(&format!("layers.{}", 2 * l))]);
        body += &layer(&to, &from, &networks.place(&name), before, *width, activation(mlp.activation));
        (from, before) = (to, *width);
    }
    let needs = if mlp.hidden.is_empty() { vec![] } else { vec![activation(mlp.activation)] };
    (tables, body, needs)
}
