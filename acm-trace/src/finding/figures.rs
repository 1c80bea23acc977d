//! Data of the figures of a finding: held-out trials, thinned.

use acm_core::effects::instance::Instance;
use acm_core::effects::{Carrier, Site};

use nalgebra::DMatrix;

use crate::case::Trial;
use crate::finding::{CarrierFigure, Figures, FoundEffect, Trace, TrialErrors};
use crate::holdout::{Holdout, Judged, Measure, parts_of};
use crate::prepared::Prepared;
use crate::trace::Traced;

/// Points of a figure against a signal.
const POINTS: usize = 1500;

/// Samples of a trace.
const TRACE: usize = 600;

/// Samples per second of a trace, about.
const RATE: f64 = 20.0;

/// Returns the residuals of held-out trials by the nominal model, the best baseline, and with the effects; a figure for
/// each effect.
pub fn figures(
    prepared: &Prepared,
    holdout: &Holdout,
    traced: &Traced,
    effects: &[FoundEffect],
    judged: &Judged,
    measure: &Measure,
) -> Figures {
    if holdout.is_empty() {
        return Figures::default();
    }
    let [nominal, best, after] = &judged.residuals;
    let sheet = Sheet { prepared, trials: holdout.trials(), counts: &judged.counts, nominal, after };
    let rig = &prepared.case.rig;
    let of = |effect: &FoundEffect| {
        let placed = traced.last.effects.iter().find(|placed| {
            placed.instance.effect().name() == effect.name
                && crate::finding::sentence::carrier(&placed.instance, rig) == effect.carrier
        })?;
        Some(sheet.against(&placed.instance, signal(&placed.instance, prepared)))
    };
    let mut carriers: Vec<CarrierFigure> = effects.iter().filter_map(of).collect();
    if carriers.is_empty() && !rig.actuators.is_empty() {
        carriers.push(sheet.figure("", Axis::Actuator(0)));
    }
    let error = |residuals: &[DMatrix<f64>], s: usize| {
        let parts = parts_of(&holdout.trials()[s], &residuals[s], measure);
        let (squares, samples) = parts.iter().fold((0.0, 0), |(q, n), part| (q + part.squares, n + part.samples));
        (squares / samples.max(1) as f64).sqrt()
    };
    let trials = holdout.trials().iter().enumerate().map(|(s, trial)| TrialErrors {
        name: trial.name.clone(),
        nominal: error(nominal, s),
        best_baseline: error(best, s),
        after: error(after, s),
    });
    Figures { carriers, trace: Some(sheet.trace()), trials: trials.collect() }
}

/// Quantity on the horizontal axis.
#[derive(Debug, Clone, Copy)]
enum Axis {
    Time,
    Actuator(usize),
    Context(usize),
    ActuatorRate(usize),
    ContextRate(usize),
}

/// Returns the signal that shows an effect best.
fn signal(instance: &Instance, prepared: &Prepared) -> Axis {
    let rig = &prepared.case.rig;
    let traits = instance.effect().traits();
    let rate = traits.shows_against_rate;
    let moving = (0..rig.actuators.len()).max_by(|&a, &b| {
        let travel = |j: usize| rig.actuators[j].span() / rig.actuators[j].magnitude().max(f64::MIN_POSITIVE);
        travel(a).total_cmp(&travel(b)).then(b.cmp(&a))
    });
    match (instance.carrier(), instance.site()) {
        (Carrier::Actuator(j), _) if rate => Axis::ActuatorRate(j),
        (Carrier::Context(j), _) if rate => Axis::ContextRate(j),
        (Carrier::Actuator(j), _) => Axis::Actuator(j),
        (Carrier::Context(j), _) => Axis::Context(j),
        (Carrier::Rig, _) if traits.is_drift => Axis::Time,
        (Carrier::Rig, Site::Output) => Axis::Time,
        (Carrier::Rig, _) => match moving {
            Some(j) if rate => Axis::ActuatorRate(j),
            Some(j) => Axis::Actuator(j),
            None => Axis::Time,
        },
    }
}

struct Sheet<'s> {
    prepared: &'s Prepared,
    trials: &'s [Trial],
    counts: &'s [Vec<bool>],
    nominal: &'s [DMatrix<f64>],
    after: &'s [DMatrix<f64>],
}

impl Sheet<'_> {
    fn against(&self, instance: &Instance, axis: Axis) -> CarrierFigure {
        self.figure(instance.effect().name(), axis)
    }

    /// Returns the index of the reported output whose error falls most.
    fn output(&self) -> usize {
        let power =
            |residuals: &[DMatrix<f64>], o: usize| residuals.iter().map(|r| r.column(o).norm_squared()).sum::<f64>();
        let fall = |o: usize| power(self.nominal, o) - power(self.after, o);
        let reported = self.prepared.case.reported.clone();
        let first = reported.start;
        reported.max_by(|&a, &b| fall(a).total_cmp(&fall(b)).then(b.cmp(&a))).unwrap_or(first)
    }

    fn figure(&self, effect: &str, axis: Axis) -> CarrierFigure {
        let rig = &self.prepared.case.rig;
        let (signal, unit) = match axis {
            Axis::Time => ("time".into(), "s".into()),
            Axis::Actuator(j) => (rig.actuators[j].name.clone(), rig.actuators[j].unit.clone()),
            Axis::Context(j) => (rig.contexts[j].name.clone(), rig.contexts[j].unit.clone()),
            Axis::ActuatorRate(j) => {
                (format!("rate of {}", rig.actuators[j].name), format!("{}/s", rig.actuators[j].unit))
            }
            Axis::ContextRate(j) => {
                (format!("rate of {}", rig.contexts[j].name), format!("{}/s", rig.contexts[j].unit))
            }
        };
        let o = self.output();
        let mut figure = CarrierFigure {
            effect: effect.into(),
            signal,
            unit,
            output: rig.outputs[o].name.clone(),
            x: vec![],
            before: vec![],
            after: vec![],
            continues: vec![],
        };
        let counted: usize = self.counts.iter().map(|counts| counts.iter().filter(|c| **c).count()).sum();
        let stride = counted.div_ceil(POINTS).max(1);
        for (s, trial) in self.trials.iter().enumerate() {
            let record = &trial.record;
            let column = match axis {
                Axis::Time => &record.time,
                Axis::Actuator(j) => &record.actuators[j],
                Axis::Context(j) => &record.contexts[j],
                Axis::ActuatorRate(j) => &record.actuator_rates[j],
                Axis::ContextRate(j) => &record.context_rates[j],
            };
            for (n, t) in self.rows(s).step_by(stride).enumerate() {
                figure.x.push(column[t]);
                figure.before.push(self.nominal[s][(t, o)]);
                figure.after.push(self.after[s][(t, o)]);
                figure.continues.push(n > 0);
            }
        }
        figure
    }

    /// Returns the samples of a trial that count.
    fn rows(&self, s: usize) -> impl Iterator<Item = usize> {
        (0..self.counts[s].len()).filter(move |&t| self.counts[s][t])
    }

    /// Returns the trial with the largest fall in error.
    fn trace(&self) -> Trace {
        let o = self.output();
        let power = |s: usize, r: &DMatrix<f64>| {
            let r = r.select_rows(&self.trials[s].measured_rows());
            r.norm_squared() / r.len().max(1) as f64
        };
        let fall = |s: usize| power(s, &self.nominal[s]) - power(s, &self.after[s]);
        let s = (0..self.trials.len()).max_by(|&a, &b| fall(a).total_cmp(&fall(b))).unwrap_or(0);
        let trial = &self.trials[s];
        let stride = (self.prepared.case.rig.step.recip() / RATE).max(1.0) as usize;
        let rows: Vec<usize> = self.rows(s).step_by(stride).take(TRACE).collect();
        let with =
            |residuals: &[DMatrix<f64>]| rows.iter().map(|&t| trial.measured[(t, o)] - residuals[s][(t, o)]).collect();
        Trace {
            trial: trial.name.clone(),
            output: self.prepared.case.rig.outputs[o].name.clone(),
            time: rows.iter().map(|&t| trial.record.time[t]).collect(),
            measured: rows.iter().map(|&t| trial.measured[(t, o)]).collect(),
            nominal: with(self.nominal),
            after: with(self.after),
        }
    }
}
