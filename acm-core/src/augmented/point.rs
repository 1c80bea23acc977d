//! A nominal model with its static map, sample by sample. All memory is allocated at the start.

use crate::nominal::NominalModel;
use crate::static_map::{MapScratch, StaticMap};
use crate::tip_model::Scratch;

/// p(q) + m(q), see [`crate::response`], which takes many samples at once.
#[derive(Debug, Clone)]
pub struct Point {
    model: NominalModel,
    map: Option<(StaticMap, MapScratch)>,
    strain: Option<Scratch>,
    monomials: Vec<f64>,
}

impl Point {
    /// Takes memory for one sample.
    pub fn new(model: NominalModel, map: Option<StaticMap>) -> Self {
        let (strain, monomials) = match &model {
            NominalModel::Strain(strain) => (Some(strain.scratch()), 0),
            NominalModel::Polynomial(polynomial) => (None, polynomial.monomials().len()),
            NominalModel::None { .. } => (None, 0),
        };
        let map = map.map(|map| (map.clone(), map.scratch()));
        Self { model, map, strain, monomials: vec![0.0; monomials] }
    }

    /// Number of outputs M.
    pub fn outputs(&self) -> usize {
        self.model.outputs()
    }

    /// Outputs `[M]` at the actuator coordinates `q` `[A]`.
    pub fn evaluate(&mut self, q: &[f64], out: &mut [f64]) {
        match (&self.model, &mut self.strain) {
            (NominalModel::Strain(model), Some(scratch)) => model.predict(q, scratch, out),
            (NominalModel::Polynomial(polynomial), _) => {
                polynomial.monomials().evaluate(q, &mut self.monomials);
                for (out, c) in out.iter_mut().zip(polynomial.coefficients().column_iter()) {
                    *out = c[0] + c.iter().skip(1).zip(&self.monomials).map(|(c, m)| c * m).sum::<f64>();
                }
            }
            _ => out.fill(0.0),
        }
        if let Some((map, scratch)) = &mut self.map {
            map.add_with(q, scratch, out);
        }
    }
}
