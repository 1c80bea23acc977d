//! What the figures of a finding show: untouched trials, thinned.

use acm_core::effects::instance::Instance;
use acm_core::effects::{Carrier, Site};

use crate::finding::{CarrierFigure, Figures, Trace, TrialErrors};
use crate::judge::Model;
use crate::prepared::Prepared;
use crate::series::Series;

/// Points of a figure against a signal.
const POINTS: usize = 1500;

/// Samples of a trace.
const TRACE: usize = 600;

/// Residuals of untouched trials by the nominal model, the best of the befores, and with the effect.
pub fn figures(
    prepared: &Prepared,
    untouched: &[Series],
    model: &Model,
    nominal: &[Vec<f64>],
    best: &[Vec<f64>],
    after: &[Vec<f64>],
    scale: f64,
) -> Figures {
    if untouched.is_empty() {
        return Figures::default();
    }
    let sheet = Sheet { prepared, untouched, nominal, after, scale };
    let mut carriers: Vec<CarrierFigure> =
        model.instances.iter().map(|instance| sheet.against(instance, signal(instance, prepared))).collect();
    if carriers.is_empty() && !prepared.case.rig.actuators.is_empty() {
        carriers.push(sheet.figure("", Axis::Actuator(0)));
    }
    let errors = |residuals: &[Vec<f64>], s: usize| {
        let parts = crate::judge::parts(prepared, &untouched[s..=s], &residuals[s..=s]);
        let (squares, samples) = parts.iter().fold((0.0, 0), |(q, n), part| (q + part.squares, n + part.samples));
        (squares / samples.max(1) as f64).sqrt() * scale
    };
    let trials = (0..untouched.len()).map(|s| TrialErrors {
        name: untouched[s].name.clone(),
        nominal: errors(nominal, s),
        best_before: errors(best, s),
        after: errors(after, s),
    });
    Figures { carriers, trace: Some(sheet.trace()), trials: trials.collect() }
}

/// What stands on the horizontal axis.
#[derive(Debug, Clone, Copy)]
enum Axis {
    Time,
    Actuator(usize),
    Context(usize),
    ActuatorRate(usize),
    ContextRate(usize),
}

/// The signal that shows an effect best.
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
    untouched: &'s [Series],
    nominal: &'s [Vec<f64>],
    after: &'s [Vec<f64>],
    scale: f64,
}

impl Sheet<'_> {
    fn against(&self, instance: &Instance, axis: Axis) -> CarrierFigure {
        self.figure(instance.effect().name(), axis)
    }

    fn width(&self) -> usize {
        self.prepared.weight.len()
    }

    /// The reported output whose error falls most.
    fn output(&self) -> usize {
        let power = |residuals: &[Vec<f64>], o: usize| -> f64 {
            residuals.iter().flat_map(|r| r.iter().skip(o).step_by(self.width())).map(|r| r * r).sum()
        };
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
        let (o, width) = (self.output(), self.width());
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
        let counted: usize = self.untouched.iter().map(|s| s.counts.iter().filter(|c| **c).count()).sum();
        let stride = counted.div_ceil(POINTS).max(1);
        for (s, series) in self.untouched.iter().enumerate() {
            let record = &series.thin;
            let column = match axis {
                Axis::Time => &record.time,
                Axis::Actuator(j) => &record.actuators[j],
                Axis::Context(j) => &record.contexts[j],
                Axis::ActuatorRate(j) => &record.actuator_rates[j],
                Axis::ContextRate(j) => &record.context_rates[j],
            };
            let rows = (0..series.samples()).filter(|&k| series.counts[k]).step_by(stride);
            for (n, k) in rows.enumerate() {
                figure.x.push(column[k]);
                figure.before.push(self.nominal[s][k * width + o] * self.scale);
                figure.after.push(self.after[s][k * width + o] * self.scale);
                figure.continues.push(n > 0);
            }
        }
        figure
    }

    /// The trial with the largest fall in error.
    fn trace(&self) -> Trace {
        let (o, width) = (self.output(), self.width());
        let power = |r: &Vec<f64>| r.iter().map(|r| r * r).sum::<f64>() / r.len().max(1) as f64;
        let fall = |s: usize| power(&self.nominal[s]) - power(&self.after[s]);
        let s = (0..self.untouched.len()).max_by(|&a, &b| fall(a).total_cmp(&fall(b))).unwrap_or(0);
        let series = &self.untouched[s];
        let rows: Vec<usize> = (0..series.samples()).filter(|&k| series.counts[k]).take(TRACE).collect();
        let measured = |k: usize| series.measured[k * width + o] * self.scale;
        let with = |residuals: &[Vec<f64>]| {
            rows.iter().map(|&k| measured(k) - residuals[s][k * width + o] * self.scale).collect()
        };
        Trace {
            trial: series.name.clone(),
            output: self.prepared.case.rig.outputs[o].name.clone(),
            time: rows.iter().map(|&k| series.thin.time[k]).collect(),
            measured: rows.iter().map(|&k| measured(k)).collect(),
            nominal: with(self.nominal),
            after: with(self.after),
        }
    }
}
