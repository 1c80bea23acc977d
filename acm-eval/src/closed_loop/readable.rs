//! A finding with its errors in a common unit with one prefix.

use acm_trace::finding::{Baselines, Errors, Estimate, Figures, Finding, Left};

/// Returns a finding in the unit for readers: errors are multiplied by one factor.
pub fn readable(finding: &Finding) -> Finding {
    let display = finding.errors.display();
    let scaled = |value: f64| display.factor * value;
    let mut shown = finding.clone();
    shown.errors = errors(&finding.errors, display.symbol.clone(), &scaled);
    for effect in &mut shown.effects {
        effect.size = scaled(effect.size);
        effect.follows = effect.follows.map(scaled);
    }
    shown.minor.iter_mut().for_each(|effect| effect.size = scaled(effect.size));
    for step in &mut shown.steps {
        step.error = scaled(step.error);
        step.candidates.iter_mut().for_each(|candidate| candidate.error = scaled(candidate.error));
    }
    shown.trial_offset = finding.trial_offset.map(scaled);
    shown.left = left(shown.left, &scaled);
    shown.symbolic.iter_mut().for_each(|symbolic| symbolic.error = scaled(symbolic.error));
    for row in &mut shown.networks {
        (row.error, row.sd) = (scaled(row.error), row.sd.map(scaled));
    }
    scale_figures(&mut shown.figures, &scaled);
    shown
}

fn errors(errors: &Errors, unit: String, scaled: &dyn Fn(f64) -> f64) -> Errors {
    let of = |estimate: Estimate| Estimate { value: scaled(estimate.value), interval: estimate.interval.map(scaled) };
    let squared = |value: f64| scaled(scaled(value));
    let Baselines { nominal, static_map, recalibrated } = errors.baselines;
    Errors {
        unit,
        noise: scaled(errors.noise),
        baselines: Baselines { nominal: of(nominal), static_map: of(static_map), recalibrated: of(recalibrated) },
        after: of(errors.after),
        after_without_offsets: errors.after_without_offsets.map(of),
        change: Estimate { value: squared(errors.change.value), interval: errors.change.interval.map(squared) },
    }
}

fn left(mut left: Left, scaled: &dyn Fn(f64) -> f64) -> Left {
    left.rms = scaled(left.rms);
    left.probe.iter_mut().chain(&mut left.network).for_each(|probe| probe.rms = scaled(probe.rms));
    left
}

fn scale_figures(figures: &mut Figures, scaled: &dyn Fn(f64) -> f64) {
    let scale = |values: &mut Vec<f64>| values.iter_mut().for_each(|value| *value = scaled(*value));
    for carrier in &mut figures.carriers {
        [&mut carrier.before, &mut carrier.after].into_iter().for_each(scale);
    }
    if let Some(trace) = &mut figures.trace {
        [&mut trace.measured, &mut trace.nominal, &mut trace.after].into_iter().for_each(scale);
    }
    for trial in &mut figures.trials {
        for error in [&mut trial.nominal, &mut trial.best_baseline, &mut trial.after] {
            *error = scaled(*error);
        }
    }
}
