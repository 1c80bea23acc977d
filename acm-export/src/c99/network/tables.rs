//! Constant tables of weights. The networks of an ensemble share a function of a step; their tables have the network as first index, `n`.

use acm_stream::Parts;

use crate::c99::text::{float, items};
use crate::{Parameter, parameters, weights_of_each};

/// Number of columns in a group of a table.
const LANES: usize = 8;

/// Returns the number of columns including those that fill the last group.
pub fn padded(columns: usize) -> usize {
    columns.next_multiple_of(LANES)
}

/// Affine maps side by side over the same inputs: weight row by row `[outputs][inputs]`, and bias.
pub struct Map {
    pub weight: Vec<Vec<f32>>,
    pub bias: Vec<f32>,
}

/// Parameters by name.
pub struct Named(Vec<Parameter>);

impl Named {
    pub fn values(&self, name: &str) -> &[f32] {
        self.0.iter().find(|parameter| parameter.name == name).map_or(&[], |parameter| &parameter.values)
    }

    pub fn map(&self, name: &str) -> Map {
        let bias = self.values(&format!("{name}.bias")).to_vec();
        let weight = self.values(&format!("{name}.weight"));
        Map { weight: weight.chunks(weight.len() / bias.len()).map(<[f32]>::to_vec).collect(), bias }
    }
}

/// The networks of an estimator: one, or those of an ensemble.
pub struct Networks(Vec<Named>);

impl Networks {
    pub fn of(parts: &Parts) -> Self {
        Self(weights_of_each(parts).map(|weights| Named(parameters(&parts.network, weights))).collect())
    }

    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// Returns the expression by which the function of a step reads a table.
    pub fn place(&self, table: &str) -> String {
        if self.0.len() == 1 { table.to_owned() } else { format!("{table}[n]") }
    }

    /// Returns a table of affine maps, in which each map's columns fill groups of their own: bias, then one row for
    /// each input.
    pub fn table(&self, name: &str, equation: &str, maps: impl Fn(&Named) -> Vec<Map>) -> String {
        let inputs = maps(&self.0[0]).first().and_then(|map| map.weight.first()).map_or(0, Vec::len);
        let tables = self.0.iter().map(|named| columns(&maps(named), inputs)).collect();
        format!("\n/* {equation}: b, then a row for each of {inputs} inputs. */\n{}", declared(name, tables))
    }

    /// Returns a table of numbers.
    pub fn row(&self, name: &str, values: impl Fn(&Named) -> Vec<f32>) -> String {
        declared(name, self.0.iter().map(values).collect())
    }
}

/// Returns the definition of a constant table; with several networks, of one for each.
fn declared(name: &str, tables: Vec<Vec<f32>>) -> String {
    let numbers = |values: &Vec<f32>| format!("{{\n{}}}", items(values.iter().map(|value| float(*value))));
    let length = tables[0].len();
    match &tables[..] {
        [one] => format!("static const float {name}[{length}] = {};\n", numbers(one)),
        all => {
            let each: Vec<String> = all.iter().map(numbers).collect();
            format!("static const float {name}[{}][{length}] = {{{}}};\n", all.len(), each.join(", "))
        }
    }
}

/// Returns the bias, then one row for each input.
fn columns(maps: &[Map], inputs: usize) -> Vec<f32> {
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
    values
}
