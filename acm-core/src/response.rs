//! A nominal model as a smooth function: outputs and Jacobian at given actuator coordinates.
//!
//! | symbol | meaning                                        | shape          |
//! | `q`    | actuator coordinates, as the effects left them | A columns      |
//! | `θ`    | parameters that a recalibration may move       | P              |
//! | `y`    | outputs of the model with its static map       | N × M          |
//! | `u`    | displacement per unit of each field            | N × K × 15 × 3 |
//!
//! All results are row by row: sample, then output, then what the slope is taken with.

use nalgebra::{DMatrix, Vector3};
use rayon::prelude::*;

use crate::fields::{Field, FieldModel};
use crate::fitting::calibration::identified;
use crate::nominal::NominalModel;
use crate::polynomial::Polynomial;
use crate::static_map::StaticMap;
use crate::tip_model::{Block, STRIDE, StrainModel};

/// A nominal model with its static map.
#[derive(Debug, Clone)]
pub struct Response {
    model: NominalModel,
    map: Option<StaticMap>,
    fields: Option<FieldModel>,
    /// Indices of the parameters that may move.
    free: Vec<usize>,
}

/// Outputs and slopes at N samples.
#[derive(Debug, Clone, Default)]
pub struct Linearised {
    /// N × M.
    pub outputs: Vec<f64>,
    /// ∂y/∂q, N × M × A.
    pub by_actuator: Vec<f64>,
    /// ∂y/∂θ, N × M × P.
    pub by_parameter: Vec<f64>,
}

impl Response {
    /// `down` points down in the measurement frame; loads need it, and a strain model.
    pub fn new(model: NominalModel, map: Option<StaticMap>, down: Option<Vector3<f64>>) -> Self {
        let (free, fields) = match &model {
            NominalModel::Strain(strain) => (identified(strain), down.map(|down| FieldModel::new(strain, down))),
            NominalModel::Polynomial(polynomial) => ((0..polynomial.coefficients().len()).collect(), None),
            NominalModel::None { .. } => (vec![], None),
        };
        Self { model, map, fields, free }
    }

    /// The nominal model.
    pub fn model(&self) -> &NominalModel {
        &self.model
    }

    /// The static map.
    pub fn map(&self) -> Option<&StaticMap> {
        self.map.as_ref()
    }

    /// Number of outputs M.
    pub fn outputs(&self) -> usize {
        self.model.outputs()
    }

    /// Values of the P parameters that may move.
    pub fn parameters(&self) -> Vec<f64> {
        match &self.model {
            NominalModel::Strain(strain) => self.free.iter().map(|&j| strain.parameters()[j]).collect(),
            NominalModel::Polynomial(polynomial) => polynomial.coefficients().as_slice().to_vec(),
            NominalModel::None { .. } => vec![],
        }
    }

    /// Copy with other values of these parameters.
    pub fn with_parameters(&self, values: &[f64]) -> Self {
        let model = match &self.model {
            NominalModel::Strain(strain) => {
                let mut theta = strain.parameters().to_vec();
                self.free.iter().zip(values).for_each(|(&j, value)| theta[j] = *value);
                NominalModel::Strain(strain.clone().with_parameters(&theta))
            }
            NominalModel::Polynomial(polynomial) => {
                let (rows, columns) = polynomial.coefficients().shape();
                let coefficients = DMatrix::from_column_slice(rows, columns, values);
                NominalModel::Polynomial(polynomial.clone().with_coefficients(coefficients))
            }
            none => none.clone(),
        };
        Self { model, ..self.clone() }
    }

    /// Copy with another static map.
    pub fn with_map(&self, map: Option<StaticMap>) -> Self {
        Self { map, ..self.clone() }
    }

    /// Outputs at the samples `rows` of the columns `q`.
    pub fn outputs_at(&self, q: &[Vec<f64>], rows: &[usize]) -> Vec<f64> {
        let width = self.outputs();
        let mut outputs = vec![0.0; rows.len() * width];
        match &self.model {
            NominalModel::Strain(strain) => strain_outputs(strain, q, rows, &mut outputs),
            NominalModel::Polynomial(polynomial) => polynomial_outputs(polynomial, q, rows, &mut outputs),
            NominalModel::None { .. } => (),
        }
        if let Some(map) = &self.map {
            let mut here = vec![0.0; q.len()];
            for (&row, out) in rows.iter().zip(outputs.chunks_exact_mut(width)) {
                gather(q, row, &mut here);
                map.add(&here, out);
            }
        }
        outputs
    }

    /// Outputs and slopes at the samples `rows` of the columns `q`.
    pub fn linearised_at(&self, q: &[Vec<f64>], rows: &[usize]) -> Linearised {
        let (width, actuators, free) = (self.outputs(), q.len(), self.free.len());
        let mut all = Linearised {
            outputs: vec![0.0; rows.len() * width],
            by_actuator: vec![0.0; rows.len() * width * actuators],
            by_parameter: vec![0.0; rows.len() * width * free],
        };
        match &self.model {
            NominalModel::Strain(strain) => strain_slopes(strain, &self.free, q, rows, &mut all),
            NominalModel::Polynomial(polynomial) => polynomial_slopes(polynomial, q, rows, &mut all),
            NominalModel::None { .. } => (),
        }
        if let Some(map) = &self.map {
            let mut here = vec![0.0; actuators];
            let slopes = all.by_actuator.chunks_exact_mut(width * actuators);
            for ((&row, out), slopes) in rows.iter().zip(all.outputs.chunks_exact_mut(width)).zip(slopes) {
                gather(q, row, &mut here);
                map.add(&here, out);
                map.add_slopes(&here, slopes);
            }
        }
        all
    }

    /// Displacement of each marker per unit of each field, N × K × 15 × 3; empty without a strain model.
    pub fn fields_at(&self, q: &[Vec<f64>], rows: &[usize]) -> Vec<f64> {
        let (Some(fields), NominalModel::Strain(strain)) = (&self.fields, &self.model) else { return vec![] };
        let width = self.outputs() * Field::ALL.len();
        let mut out = vec![0.0; rows.len() * width];
        out.par_chunks_mut(STRIDE * width).zip(rows.par_chunks(STRIDE)).for_each_init(
            || (fields.scratch(), vec![0.0; q.len()]),
            |(scratch, here), (out, rows)| {
                for (&row, out) in rows.iter().zip(out.chunks_exact_mut(width)) {
                    gather(q, row, here);
                    fields.evaluate(strain.parameters(), here, scratch, out);
                }
            },
        );
        out
    }

    /// Adds Σ_f w_f u_f at every sample of the columns `q` to `y` [T×M]; `loads` has a column for each field. Nothing without
    /// a strain model.
    pub fn add_loads(&self, q: &[Vec<f64>], loads: &[Vec<f64>], y: &mut [f64]) {
        let (Some(fields), NominalModel::Strain(strain)) = (&self.fields, &self.model) else { return };
        let width = self.outputs();
        y.par_chunks_mut(STRIDE * width).enumerate().for_each_init(
            || (fields.scratch(), vec![0.0; q.len()], vec![0.0; loads.len()]),
            |(scratch, here, weights), (chunk, y)| {
                for (k, y) in y.chunks_exact_mut(width).enumerate() {
                    gather(q, chunk * STRIDE + k, here);
                    gather(loads, chunk * STRIDE + k, weights);
                    fields.add(strain.parameters(), here, weights, scratch, y);
                }
            },
        );
    }
}

/// Fills a block with samples `rows` of the columns `q`.
fn fill(strain: &StrainModel, q: &[Vec<f64>], rows: &[usize], block: &mut Block) {
    for (a, q) in q.iter().enumerate() {
        block.actuator_mut(a).iter_mut().zip(rows).for_each(|(to, &row)| *to = q[row]);
    }
    strain.fill(strain.parameters(), rows.len(), block);
}

fn strain_outputs(strain: &StrainModel, q: &[Vec<f64>], rows: &[usize], outputs: &mut [f64]) {
    let width = strain.outputs();
    outputs.par_chunks_mut(STRIDE * width).zip(rows.par_chunks(STRIDE)).for_each_init(
        || strain.block(),
        |block, (out, rows)| {
            fill(strain, q, rows, block);
            (0..width).for_each(|o| scatter(block.output(o), o, width, out));
        },
    );
}

fn strain_slopes(strain: &StrainModel, free: &[usize], q: &[Vec<f64>], rows: &[usize], all: &mut Linearised) {
    let (width, actuators) = (strain.outputs(), q.len());
    let outputs = all.outputs.par_chunks_mut(STRIDE * width);
    let by_actuator = all.by_actuator.par_chunks_mut(STRIDE * width * actuators);
    let by_parameter = all.by_parameter.par_chunks_mut(STRIDE * width * free.len());
    let tables = outputs.zip(by_actuator).zip(by_parameter).zip(rows.par_chunks(STRIDE));
    tables.for_each_init(
        || strain.block_with_all_slopes(free),
        |block, (((out, by_actuator), by_parameter), rows)| {
            fill(strain, q, rows, block);
            for o in 0..width {
                scatter(block.output(o), o, width, out);
                for a in 0..actuators {
                    scatter(block.by_actuator(o, a), o * actuators + a, width * actuators, by_actuator);
                }
                for j in 0..free.len() {
                    scatter(block.by_parameter(o, j), o * free.len() + j, width * free.len(), by_parameter);
                }
            }
        },
    );
}

/// Values of one column into a table that lies row by row.
fn scatter(values: &[f64], column: usize, width: usize, table: &mut [f64]) {
    table.iter_mut().skip(column).step_by(width).zip(values).for_each(|(to, from)| *to = *from);
}

fn polynomial_outputs(polynomial: &Polynomial, q: &[Vec<f64>], rows: &[usize], outputs: &mut [f64]) {
    let (mut values, mut here) = (vec![0.0; polynomial.monomials().len()], vec![0.0; q.len()]);
    for (&row, out) in rows.iter().zip(outputs.chunks_exact_mut(polynomial.outputs())) {
        gather(q, row, &mut here);
        polynomial.monomials().evaluate(&here, &mut values);
        sum_monomials(polynomial, &values, out);
    }
}

fn polynomial_slopes(polynomial: &Polynomial, q: &[Vec<f64>], rows: &[usize], all: &mut Linearised) {
    let monomials = polynomial.monomials();
    let (width, actuators, count) = (polynomial.outputs(), q.len(), 1 + monomials.len());
    let (mut values, mut here) = (vec![0.0; monomials.len()], vec![0.0; actuators]);
    let mut gradient = vec![0.0; monomials.len() * actuators];
    for (k, &row) in rows.iter().enumerate() {
        gather(q, row, &mut here);
        monomials.evaluate(&here, &mut values);
        monomials.gradient(&values, &mut gradient);
        sum_monomials(polynomial, &values, &mut all.outputs[k * width..(k + 1) * width]);
        for o in 0..width {
            let coefficients = polynomial.coefficients().column(o);
            for a in 0..actuators {
                let terms = coefficients.iter().skip(1).zip(gradient.iter().skip(a).step_by(actuators));
                all.by_actuator[(k * width + o) * actuators + a] = terms.map(|(c, slope)| c * slope).sum();
            }
            let row = &mut all.by_parameter[((k * width + o) * width + o) * count..][..count];
            row[0] = 1.0;
            row[1..].copy_from_slice(&values);
        }
    }
}

fn sum_monomials(polynomial: &Polynomial, values: &[f64], out: &mut [f64]) {
    for (o, out) in out.iter_mut().enumerate() {
        let c = polynomial.coefficients().column(o);
        *out = c[0] + c.iter().skip(1).zip(values).map(|(c, m)| c * m).sum::<f64>();
    }
}

fn gather(q: &[Vec<f64>], row: usize, here: &mut [f64]) {
    here.iter_mut().zip(q).for_each(|(here, q)| *here = q[row]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::ArmSpec;

    fn strain() -> NominalModel {
        let model = StrainModel::new(&ArmSpec { degree: 2, ..ArmSpec::default() }, 2, &[1.0]).unwrap();
        let theta: Vec<f64> = (0..model.parameters().len()).map(|j| 0.3 * (2.0 + j as f64).sin()).collect();
        NominalModel::Strain(model.with_parameters(&theta))
    }

    fn polynomial() -> NominalModel {
        let q = DMatrix::from_fn(40, 2, |t, a| ((t * (a + 1)) as f64 * 0.7).sin());
        NominalModel::Polynomial(Polynomial::fit(&q, &q.map(|v| v.exp() * v.cos()), 2).polynomial)
    }

    /// Oracle: central differences in every parameter.
    #[test]
    fn parameter_slopes_are_the_derivative() {
        for model in [strain(), polynomial()] {
            let response = Response::new(model, None, None);
            let (q, rows) = (vec![vec![0.4, -0.7], vec![0.1, 0.5]], [0, 1]);
            let linear = response.linearised_at(&q, &rows);
            let theta = response.parameters();
            let (width, free) = (response.outputs(), theta.len());
            assert_eq!(linear.outputs, response.outputs_at(&q, &rows));
            for j in 0..free {
                let at = |shift: f64| {
                    let mut moved = theta.clone();
                    moved[j] += shift;
                    response.with_parameters(&moved).outputs_at(&q, &rows)
                };
                let (after, before) = (at(1e-5), at(-1e-5));
                for k in 0..2 * width {
                    let slope = (after[k] - before[k]) / 2e-5;
                    assert!((linear.by_parameter[k * free + j] - slope).abs() < 1e-8);
                }
            }
        }
    }
}
