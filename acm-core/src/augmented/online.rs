//! A nominal model with effects, evaluated sample by sample.
//!
//! | result at a sample                                     | condition                                           |
//! | that of [`AugmentedModel::predict`] on the whole trial | no effect looks ahead                               |
//! | that on a trial that ends there                        | an effect uses a rate of change                     |
//!
//! Steps allocate nothing, but for a dead time with more than a thousand samples a second.

use thiserror::Error;

use super::AugmentedModel;
use super::between::Between;
use super::point::Point;
use crate::effects::instance::Running;
use crate::effects::memory::{Memory, Slopes, State};
use crate::effects::{Record, Site};
use crate::fields::{Field, FieldModel, FieldScratch};
use crate::nominal::NominalModel;

/// Inputs of one sample, SI.
#[derive(Debug, Clone, Copy)]
pub struct Sample<'a> {
    /// Time since any instant before the trial, s; increasing.
    pub time: f64,
    /// A of them.
    pub actuators: &'a [f64],
    /// E of them: context signals, then conditions.
    pub contexts: &'a [f64],
    /// Acceleration of the carrier x, y, z, m/s²; empty where the rig has no carrier.
    pub acceleration: &'a [f64],
    /// M of them where the nominal prediction comes with the data, or none.
    pub predicted: &'a [f64],
}

/// See the head of this file.
#[derive(Debug)]
pub struct OnlineModel {
    point: Point,
    stands_for: Option<Point>,
    fields: Option<Fields>,
    effects: Vec<Running>,
    rates: Vec<Slopes>,
    between: Option<Between>,
    /// One sample.
    record: Record,
    q: Vec<Vec<f64>>,
    y: Vec<Vec<f64>>,
    here: Vec<f64>,
    out: Vec<f64>,
}

/// A model that needs future samples of a stream.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "the model reads its actuators {correction} s after their time stamps (clock correction), which a stream cannot; take \
     {correction} s off the actuators' time stamps before streaming, and make a model of data with these"
)]
pub struct NeedsFuture {
    /// Clock correction of the model, s; positive where a stream would need future samples.
    pub correction: f64,
}

/// State of a model at one sample of a trial, so that a step can be undone.
#[derive(Debug)]
pub struct Snapshot {
    effects: Vec<Memory>,
    rates: Vec<Slopes>,
    between: Option<Between>,
}

/// Loads, and the arm that they bend.
#[derive(Debug)]
struct Fields {
    model: FieldModel,
    theta: Vec<f64>,
    scratch: FieldScratch,
    loads: Vec<Vec<f64>>,
    /// Weights at the one sample.
    weights: Vec<f64>,
}

impl OnlineModel {
    /// Estimator before the first sample of a trial.
    ///
    /// # Errors
    /// A model with a clock correction: the actuators' time stamps must be right before they are streamed.
    pub fn new(model: &AugmentedModel) -> Result<Self, NeedsFuture> {
        if let Some(correction) = model.stored.clock_correction {
            return Err(NeedsFuture { correction });
        }
        let (stored, rig) = (&model.stored, &model.stored.rig);
        let terms = model.instances.iter().zip(&stored.effects);
        let effects: Vec<Running> = terms.map(|(instance, term)| Running::new(instance, &term.values)).collect();
        let point = Point::new(stored.nominal.clone(), stored.static_map.clone());
        let stands_for = stored.stands_for.clone().map(|g| Point::new(NominalModel::Polynomial(g), None));
        let one = |count: usize| vec![vec![0.0]; count];
        let (actuators, contexts, outputs) = (rig.actuators.len(), rig.contexts.len(), point.outputs());
        let record = Record {
            time: vec![0.0],
            actuators: one(actuators),
            contexts: one(contexts),
            actuator_rates: one(actuators),
            context_rates: one(contexts),
            acceleration: one(if rig.carried { 3 } else { 0 }),
            ..Record::default()
        };
        let mut online = Self {
            fields: Fields::new(model, &effects),
            rates: (0..actuators + contexts).map(|_| Slopes::default()).collect(),
            between: Between::new(model.inter_sample(), &record),
            record,
            q: one(actuators),
            y: one(outputs),
            here: vec![0.0; actuators],
            out: vec![0.0; outputs],
            point,
            stands_for,
            effects,
        };
        online.take_memory();
        Ok(online)
    }

    /// A first sample of zeros, so that effects allocate their memory.
    fn take_memory(&mut self) {
        let zeros = |columns: &[Vec<f64>]| vec![0.0; columns.len()];
        let record = &self.record;
        let (actuators, contexts) = (zeros(&record.actuators), zeros(&record.contexts));
        let acceleration = zeros(&record.acceleration);
        let (time, mut out) = (0.0, zeros(&self.y));
        let predicted = if self.stands_for.is_some() { out.clone() } else { vec![] };
        let sample = Sample {
            time,
            actuators: &actuators,
            contexts: &contexts,
            acceleration: &acceleration,
            predicted: &predicted,
        };
        self.step(&sample, &mut out);
        self.restart();
    }

    /// Number of outputs M.
    pub fn outputs(&self) -> usize {
        self.out.len()
    }

    /// Outputs `[M]` at the next sample of the trial.
    ///
    /// # Panics
    /// If there is not one value for each actuator, context, and output.
    pub fn step(&mut self, sample: &Sample, out: &mut [f64]) {
        self.note(sample);
        if let Some(mut between) = self.between.take() {
            if let Some(added) = between.added(&self.record) {
                std::mem::swap(&mut self.record, added);
                self.pass(sample.predicted, out);
                std::mem::swap(&mut self.record, added);
            }
            between.keep(&self.record);
            self.between = Some(between);
        }
        self.pass(sample.predicted, out);
    }

    /// Outputs at the recorded sample.
    fn pass(&mut self, predicted: &[f64], out: &mut [f64]) {
        self.q.iter_mut().zip(&self.record.actuators).for_each(|(q, recorded)| q[0] = recorded[0]);
        act(&mut self.effects, &self.record, &mut self.q, |site| site == Site::Actuation);
        self.here.iter_mut().zip(&self.q).for_each(|(here, q)| *here = q[0]);
        self.point.evaluate(&self.here, out);
        if let Some(fields) = &mut self.fields {
            fields.add(&mut self.effects, &self.record, &self.here, out);
        }
        if let (Some(g), false) = (&mut self.stands_for, predicted.is_empty()) {
            self.here.iter_mut().zip(&self.record.actuators).for_each(|(here, q)| *here = q[0]);
            g.evaluate(&self.here, &mut self.out);
            let offsets = predicted.iter().zip(&self.out).map(|(own, g)| own - g);
            out.iter_mut().zip(offsets).for_each(|(out, offset)| *out += offset);
        }
        put(&mut self.y, out);
        act(&mut self.effects, &self.record, &mut self.y, |site| matches!(site, Site::Frame | Site::Output));
        out.iter_mut().zip(&self.y).for_each(|(out, y)| *out = y[0]);
    }

    /// Resets all states, for a new trial.
    pub fn restart(&mut self) {
        self.effects.iter_mut().for_each(Running::restart);
        self.rates.iter_mut().for_each(Slopes::restart);
        self.between.iter_mut().for_each(Between::restart);
    }

    /// Copy of the present state.
    pub fn snapshot(&self) -> Snapshot {
        let effects = self.effects.iter().map(|effect| effect.memory().clone()).collect();
        Snapshot { effects, rates: self.rates.clone(), between: self.between.clone() }
    }

    /// Copies the state into a snapshot of this model; nothing is allocated.
    pub fn save(&self, snapshot: &mut Snapshot) {
        let effects = snapshot.effects.iter_mut().zip(&self.effects);
        effects.for_each(|(saved, effect)| saved.clone_from(effect.memory()));
        snapshot.rates.iter_mut().zip(&self.rates).for_each(|(saved, rate)| saved.clone_from(rate));
        snapshot.between.iter_mut().zip(&self.between).for_each(|(saved, between)| saved.take(between));
    }

    /// Restores a snapshot of this model; nothing is allocated.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        self.effects.iter_mut().zip(&snapshot.effects).for_each(|(effect, saved)| effect.remember(saved));
        self.rates.iter_mut().zip(&snapshot.rates).for_each(|(rate, saved)| rate.clone_from(saved));
        self.between.iter_mut().zip(&snapshot.between).for_each(|(between, saved)| between.take(saved));
    }

    /// Writes the sample into the record, with rates of change as far as they are known.
    fn note(&mut self, sample: &Sample) {
        let record = &mut self.record;
        record.time[0] = sample.time;
        put(&mut record.actuators, sample.actuators);
        put(&mut record.contexts, sample.contexts);
        put(&mut record.acceleration, sample.acceleration);
        let signals = record.actuators.iter().chain(&record.contexts);
        let rates = record.actuator_rates.iter_mut().chain(&mut record.context_rates);
        for ((signal, rate), slopes) in signals.zip(rates).zip(&mut self.rates) {
            rate.copy_from_slice(slopes.of(&record.time, signal));
        }
    }
}

impl Fields {
    /// None where no effect has a load or moves a marker, or where there is no arm to bend.
    fn new(model: &AugmentedModel, effects: &[Running]) -> Option<Self> {
        let NominalModel::Strain(strain) = &model.stored.nominal else { return None };
        let down = model.stored.rig.arm.as_ref()?.down;
        if !effects.iter().any(|effect| loads(effect.site())) {
            return None;
        }
        let fields = FieldModel::new(strain, down);
        Some(Self {
            theta: strain.parameters().to_vec(),
            scratch: fields.scratch(),
            loads: vec![vec![0.0]; Field::ALL.len()],
            weights: vec![0.0; Field::ALL.len()],
            model: fields,
        })
    }

    /// Adds Σ_f w_f u_f to `out` [M].
    fn add(&mut self, effects: &mut [Running], record: &Record, q: &[f64], out: &mut [f64]) {
        self.loads.iter_mut().for_each(|load| load[0] = 0.0);
        act(effects, record, &mut self.loads, loads);
        self.weights.iter_mut().zip(&self.loads).for_each(|(weight, load)| *weight = load[0]);
        self.model.add(&self.theta, q, &self.weights, &mut self.scratch, out);
    }
}

fn loads(site: Site) -> bool {
    matches!(site, Site::Load | Site::Marker)
}

/// Applies the effects of these sites in order.
fn act(effects: &mut [Running], record: &Record, columns: &mut [Vec<f64>], at: impl Fn(Site) -> bool) {
    effects.iter_mut().filter(|effect| at(effect.site())).for_each(|effect| effect.proceed(record, columns));
}

/// Writes a sample into columns of one.
fn put(columns: &mut [Vec<f64>], values: &[f64]) {
    assert_eq!(columns.len(), values.len(), "one value for each signal");
    columns.iter_mut().zip(values).for_each(|(column, value)| column[0] = *value);
}
