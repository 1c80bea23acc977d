//! The problem at the inputs after effects.

use nalgebra::DMatrix;

use super::inputs::inputs;
use crate::fit::columns::Columns;
use crate::fit::problem::{Base, Problem, targets};
use crate::fit::state::{Part, State};

impl Problem<'_> {
    /// Returns the problem with loads and strain model evaluated at the inputs after the effects of a state; the polynomial that
    /// approximates the strain model becomes exact there. None without a strain model, or where no effect acts on the inputs.
    pub fn about(&self, state: &State) -> Option<Self> {
        let Base { stands_for, strain: Some(strain) } = self.base? else { return None };
        let acts = state.clock != 0.0 || state.effects.iter().any(|placed| placed.part() == Part::Input);
        acts.then(|| {
            let (mut fields, mut offset) = (vec![], vec![]);
            for (s, series) in self.series.iter().enumerate() {
                let q = inputs(self, state, s);
                let at_rows = DMatrix::from_fn(series.samples(), q.len(), |k, a| q[a][series.rows[k]]);
                let (given, standing) = (strain.outputs_at(&q, &series.rows), stands_for.predict(&at_rows).transpose());
                offset.push(given.iter().zip(standing.iter()).map(|(s, g)| s - g).collect());
                fields.push(strain.fields_at(&q, &series.rows));
            }
            let targets = targets(&self.series, &self.kept, &offset, self.weight);
            Self { fields, offset, targets, columns: Columns::default(), ..self.clone() }
        })
    }
}

#[cfg(test)]
mod tests {
    use acm_core::arm::ArmSpec;
    use acm_core::effects::Carrier;
    use acm_core::nominal::NominalModel;
    use acm_core::record::Record;
    use acm_core::strain::StrainBasis;
    use acm_core::tip_model::StrainModel;

    use acm_core::polynomial::Polynomial;
    use acm_core::response::Response;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;

    /// Oracle: with a gain of 1.2 the arm is where its strain model has it at 1.2 q, whatever straight line approximates it.
    #[test]
    fn the_base_is_exact_at_the_inputs_of_a_state() {
        let rig = bench::rig(&["q"], &[], &["x", "y", "z"]);
        let spec = ArmSpec { degree: 1, strain: StrainBasis::Legendre { order: 0 }, ..ArmSpec::default() };
        let model = StrainModel::new(&spec, 1, &[1.0]).unwrap();
        let bent: Vec<f64> =
            model.parameters().iter().enumerate().map(|(j, value)| value + 0.3 + 0.1 * j as f64).collect();
        let strain = Response::new(NominalModel::Strain(model.with_parameters(&bent)), None, None);
        let q: Vec<f64> = bench::time().iter().map(|t| (1.3 * t).cos()).collect();
        let at = |factor: f64, q: &[f64]| {
            let rows: Vec<usize> = (0..q.len()).collect();
            strain.outputs_at(&[q.iter().map(|q| factor * q).collect()], &rows)
        };
        let y = at(1.2, &q);
        let angle = DMatrix::from_column_slice(q.len(), 1, &q);
        let line = Polynomial::fit(&angle, &DMatrix::from_row_slice(q.len(), 3, &at(1.0, &q)), 1).polynomial;
        let mut series = [bench::series(Record::new(bench::time(), vec![q.clone()], vec![], vec![]), y.clone())];
        let beyond = |factor: f64| -> Vec<f64> {
            let straight = line.predict(&(factor * &angle)).transpose();
            at(factor, &q).iter().zip(straight.iter()).map(|(s, g)| s - g).collect()
        };
        series[0].offset = beyond(1.0);
        let problem = Problem::new(&rig, &series, &[1.0; 3], Some(Base { stands_for: &line, strain: Some(&strain) }));
        let gain = bench::placed("static_gain", Carrier::Rig, &rig, &[0.2]);
        let theta = gain.theta.iter().enumerate().map(|(j, _)| if j == 0 { 0.2 } else { 0.0 }).collect();
        let state = State::bare(Form::GIVEN).with(crate::fit::state::Placed { theta, ..gain });
        let about = problem.about(&state).unwrap();
        let largest = |offset: &[f64]| {
            offset.iter().zip(beyond(1.2)).map(|(found, truth)| (found - truth).abs()).fold(0.0, f64::max)
        };
        assert!(largest(&problem.offset[0]) > 1e-3);
        assert!(largest(&about.offset[0]) < 1e-12);
        assert!(problem.about(&State::bare(Form::GIVEN)).is_none());
    }
}
