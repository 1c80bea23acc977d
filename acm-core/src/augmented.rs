//! A nominal model with its static map and effects.
//!
//! ```text
//! y = O( F( p(Q(q_c)) + m(Q(q_c)) + Σ_f w_f u_f(Q(q_c)) + (s − g(q)) ) ),   q_c(t) = q(t + c)
//! ```
//!
//! | symbol | meaning                                                                            |
//! | `p, m` | nominal model and its static map ([`crate::response`])                             |
//! | `Q, w, F, O` | effects ([`crate::effects`])                                                 |
//! | `c`    | clock correction, s, 0 where there is none ([`crate::clock_corrected`])            |
//! | `s`    | a prediction that came with the data; then p starts as g, a polynomial fitted to s |
//!
//! It predicts a whole trial, since effects have memory, or sample by sample ([`OnlineModel`]).

mod between;
mod online;
mod origin;
mod point;

pub use online::{NeedsFuture, OnlineModel, Sample, Snapshot};
pub use origin::{ArmShape, ManifestUnits, Origin};
pub use point::Point;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::effects::instance::{Instance, Term};
use crate::effects::{Record, Site};
use crate::fields::Field;
use crate::nominal::NominalModel;
use crate::polynomial::Polynomial;
use crate::response::Response;
use crate::rig::Rig;
use crate::static_map::StaticMap;
use crate::{InterSample, clock_corrected};

/// A model that can be saved, loaded and trained upon.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "Stored", into = "Stored")]
pub struct AugmentedModel {
    stored: Stored,
    response: Response,
    instances: Vec<Instance>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    rig: Rig,
    nominal: NominalModel,
    stands_for: Option<Polynomial>,
    static_map: Option<StaticMap>,
    effects: Vec<Term>,
    /// None in files of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    origin: Option<Origin>,
    /// c, s; none where clocks agree.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    clock_correction: Option<f64>,
    /// Names of the actuators that are held between samples.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    zero_order_hold: Vec<String>,
    /// Names of the actuators that follow a quartic between samples.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    quartic_interpolation: Vec<String>,
}

impl Stored {
    fn new(
        rig: Rig,
        nominal: NominalModel,
        stands_for: Option<Polynomial>,
        static_map: Option<StaticMap>,
        effects: Vec<Term>,
    ) -> Self {
        let (zero_order_hold, quartic_interpolation) = (vec![], vec![]);
        let (origin, clock_correction) = (None, None);
        Self {
            rig,
            nominal,
            stands_for,
            static_map,
            effects,
            origin,
            clock_correction,
            zero_order_hold,
            quartic_interpolation,
        }
    }
}

impl AugmentedModel {
    /// Model from its parts; `stands_for` is g where the prediction comes with the data.
    ///
    /// # Errors
    /// An effect that cannot act on the rig, in words.
    pub fn new(
        rig: Rig,
        nominal: NominalModel,
        stands_for: Option<Polynomial>,
        static_map: Option<StaticMap>,
        effects: Vec<Term>,
    ) -> Result<Self, String> {
        Stored::new(rig, nominal, stands_for, static_map, effects).try_into()
    }

    /// Model from parts that are already checked: effects with their values, in the order of action.
    pub fn assembled(
        rig: Rig,
        response: Response,
        stands_for: Option<Polynomial>,
        effects: Vec<(Instance, Vec<f64>)>,
    ) -> Self {
        let terms = effects.iter().map(|(instance, theta)| instance.term(theta)).collect();
        let (nominal, static_map) = (response.model().clone(), response.map().cloned());
        let stored = Stored::new(rig, nominal, stands_for, static_map, terms);
        Self { stored, response, instances: effects.into_iter().map(|(instance, _)| instance).collect() }
    }

    /// Signals of the rig that the model was fitted to.
    pub fn rig(&self) -> &Rig {
        &self.stored.rig
    }

    /// Origin of the data that the model was fitted to.
    pub fn origin(&self) -> Option<&Origin> {
        self.stored.origin.as_ref()
    }

    /// Adds a note of the data that the model was made from.
    #[must_use]
    pub fn with_origin(mut self, origin: Origin) -> Self {
        self.stored.origin = Some(origin);
        self
    }

    /// Clock correction c, s: the model reads actuators at t + c. 0 where there is none.
    pub fn clock_correction(&self) -> f64 {
        self.stored.clock_correction.unwrap_or(0.0)
    }

    /// Sets a clock correction, s, positive where the actuators' clock is late; 0 and non-finite values mean none.
    /// Such a model predicts only whole trials ([`OnlineModel::new`]).
    #[must_use]
    pub fn with_clock_correction(mut self, c: f64) -> Self {
        self.stored.clock_correction = Some(c).filter(|c| c.is_finite() && *c != 0.0);
        self
    }

    /// Inter-sample behaviour of actuators.
    pub fn inter_sample(&self) -> InterSample {
        let of = |names: &[String]| -> Vec<usize> {
            let actuators = self.stored.rig.actuators.iter().enumerate();
            actuators.filter(|(_, q)| names.contains(&q.name)).map(|(a, _)| a).collect()
        };
        match (of(&self.stored.zero_order_hold), of(&self.stored.quartic_interpolation)) {
            (held, _) if !held.is_empty() => InterSample::Held(held),
            (_, quartic) if !quartic.is_empty() => InterSample::Quartic(quartic),
            _ => InterSample::Straight,
        }
    }

    /// Sets the inter-sample behaviour of actuators.
    #[must_use]
    pub fn with_inter_sample(mut self, inter_sample: &InterSample) -> Self {
        let names: Vec<String> =
            inter_sample.actuators().iter().map(|&a| self.stored.rig.actuators[a].name.clone()).collect();
        let is_quartic = matches!(inter_sample, InterSample::Quartic(_));
        let (held, quartic) = if is_quartic { (vec![], names) } else { (names, vec![]) };
        (self.stored.zero_order_hold, self.stored.quartic_interpolation) = (held, quartic);
        self
    }

    /// Effects with their values, in the order of action.
    pub fn effects(&self) -> &[Term] {
        &self.stored.effects
    }

    /// Nominal model that the effects were added to.
    pub fn nominal(&self) -> &NominalModel {
        &self.stored.nominal
    }

    /// Static map m of the nominal residual at rest; none where a map does not reduce it.
    pub fn static_map(&self) -> Option<&StaticMap> {
        self.stored.static_map.as_ref()
    }

    /// The polynomial g that the nominal model started as, where the prediction comes with the data.
    pub fn stands_for(&self) -> Option<&Polynomial> {
        self.stored.stands_for.as_ref()
    }

    /// Whether predictions that come with the data are needed.
    pub fn needs_prediction(&self) -> bool {
        self.stored.stands_for.is_some()
    }

    /// Outputs [T×M] of a trial; `predicted` [T×M] where the nominal prediction comes with the data.
    pub fn predict(&self, record: &Record, predicted: Option<&DMatrix<f64>>) -> DMatrix<f64> {
        let inter_sample = self.inter_sample();
        if inter_sample == InterSample::Straight {
            return self.predict_between(record, predicted);
        }
        let (all, rows) = inter_sample.of(record);
        let corresponding: Option<DMatrix<f64>> = predicted.map(|predicted| {
            let row = |r: usize| rows.partition_point(|row| *row < r);
            DMatrix::from_fn(all.samples(), predicted.ncols(), |r, o| predicted[(row(r), o)])
        });
        self.predict_between(&all, corresponding.as_ref()).select_rows(&rows)
    }

    /// Outputs [T×M] of a record that already has the inter-sample values of actuators ([`InterSample::of`]).
    pub fn predict_between(&self, record: &Record, predicted: Option<&DMatrix<f64>>) -> DMatrix<f64> {
        let rows: Vec<usize> = (0..record.samples()).collect();
        let theta: Vec<&[f64]> = self.stored.effects.iter().map(|term| term.values.as_slice()).collect();
        let corrected = self.stored.clock_correction.map(|c| clock_corrected(record, c));
        let (recorded, record) = (record, corrected.as_ref().unwrap_or(record));
        let q = actuation(&self.instances, &theta, record);
        let mut y = self.response.outputs_at(&q, &rows);
        if let Some(loads) = loads(&self.instances, &theta, record) {
            self.response.add_loads(&q, &loads, &mut y);
        }
        let width = self.response.outputs();
        let mut columns: Vec<Vec<f64>> =
            (0..width).map(|o| y.iter().skip(o).step_by(width).copied().collect()).collect();
        if let (Some(g), Some(own)) = (&self.stored.stands_for, predicted) {
            let actuators = DMatrix::from_fn(rows.len(), recorded.actuators.len(), |t, a| recorded.actuators[a][t]);
            let offset = own - g.predict(&actuators);
            columns.iter_mut().zip(offset.column_iter()).for_each(|(column, offset)| {
                column.iter_mut().zip(offset.iter()).for_each(|(y, offset)| *y += offset);
            });
        }
        downstream(&self.instances, &theta, record, &mut columns);
        DMatrix::from_fn(rows.len(), width, |t, o| columns[o][t])
    }
}

/// Q(q): the actuators of a trial as the model sees them.
pub fn actuation(instances: &[Instance], theta: &[&[f64]], record: &Record) -> Vec<Vec<f64>> {
    let mut q = record.actuators.clone();
    actuate(instances, theta, record, &mut q);
    q
}

/// Actuators after some effects, in place on the result of those before them.
pub fn actuate(instances: &[Instance], theta: &[&[f64]], record: &Record, q: &mut [Vec<f64>]) {
    for (instance, theta) in instances.iter().zip(theta).filter(|(i, _)| i.site() == Site::Actuation) {
        instance.act(theta, record, q);
    }
}

/// w: loads and marker displacements of a trial, one column for each field; none where no effect has any.
pub fn loads(instances: &[Instance], theta: &[&[f64]], record: &Record) -> Option<Vec<Vec<f64>>> {
    let acts = |instance: &Instance| matches!(instance.site(), Site::Load | Site::Marker);
    if !instances.iter().any(acts) {
        return None;
    }
    let mut columns = vec![vec![0.0; record.samples()]; Field::ALL.len()];
    for (instance, theta) in instances.iter().zip(theta).filter(|(i, _)| acts(i)) {
        instance.act(theta, record, &mut columns);
    }
    Some(columns)
}

/// Adds Σ_f w_f u_f to `y` [T×M], M = 3K.
pub fn displace(columns: &[Vec<f64>], fields: &[f64], y: &mut [f64]) {
    let (count, samples) = (columns.len(), columns[0].len());
    let width = y.len() / samples.max(1);
    for t in 0..samples {
        for (marker, y) in y[t * width..(t + 1) * width].chunks_exact_mut(3).enumerate() {
            let first = (t * width / 3 + marker) * count * 3;
            for (f, column) in columns.iter().enumerate().filter(|(_, column)| column[t] != 0.0) {
                let u = &fields[first + 3 * f..first + 3 * f + 3];
                y.iter_mut().zip(u).for_each(|(y, u)| *y += column[t] * u);
            }
        }
    }
}

/// O(F(y)): frame and output, in place on the M columns of a trial.
pub fn downstream(instances: &[Instance], theta: &[&[f64]], record: &Record, columns: &mut [Vec<f64>]) {
    for (instance, theta) in instances.iter().zip(theta).filter(|(i, _)| acts_downstream(i)) {
        instance.act(theta, record, columns);
    }
}

/// Whether an effect acts after the arm: on the frame or on the output.
pub fn acts_downstream(instance: &Instance) -> bool {
    matches!(instance.site(), Site::Frame | Site::Output)
}

impl From<AugmentedModel> for Stored {
    fn from(model: AugmentedModel) -> Self {
        model.stored
    }
}

impl TryFrom<Stored> for AugmentedModel {
    type Error = String;

    fn try_from(mut stored: Stored) -> Result<Self, String> {
        let mut pairs = Vec::new();
        for term in &stored.effects {
            pairs.push((Instance::restore(term, &stored.rig)?, term.clone()));
        }
        // Within a site the order is that of the file; output filters act last.
        pairs.sort_by_key(|(instance, _)| (instance.site(), instance.effect().traits().is_output_filter));
        let (instances, effects) = pairs.into_iter().unzip();
        stored.effects = effects;
        let (found, needed) = (stored.nominal.outputs(), stored.rig.outputs.len());
        if found != needed {
            return Err(format!("the nominal model has {found} outputs and the rig {needed}"));
        }
        if let Some(map) = &stored.static_map {
            map.suits(stored.rig.actuators.len(), needed)?;
        }
        if let Some(c) = stored.clock_correction.filter(|c| !c.is_finite()) {
            return Err(format!("the clock correction is {c} s; it must be a finite time"));
        }
        let known = |name: &&String| stored.rig.actuators.iter().any(|q| q.name == **name);
        let (held, quartic) = (&stored.zero_order_hold, &stored.quartic_interpolation);
        for (key, names) in [("zero_order_hold", held), ("quartic_interpolation", quartic)] {
            if let Some(name) = names.iter().find(|name| !known(name)) {
                return Err(format!("`{key}` names {name}, which is none of the rig's actuators"));
            }
        }
        if !held.is_empty() && !quartic.is_empty() {
            return Err("`zero_order_hold` and `quartic_interpolation` both name actuators; keep one of them".into());
        }
        let down = stored.rig.arm.as_ref().map(|arm| arm.down);
        let response = Response::new(stored.nominal.clone(), stored.static_map.clone(), down);
        Ok(Self { stored, response, instances })
    }
}
