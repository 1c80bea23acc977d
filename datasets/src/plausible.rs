//! Values that their unit makes unbelievable: a tip 300 m away is a tip in millimetres.
//!
//! Each is a warning, with the unit that would make the value believable and its factor. Lengths of markers are compared
//! with the arm where one is described; everything else with what laboratories measure.

use crate::layout::Source;
use crate::manifest::Manifest;
use crate::trial::Trial;
use crate::units::{Dimension, Unit};

/// Largest believable value in SI.
fn limit(dimension: Dimension) -> Option<f64> {
    Some(match dimension {
        Dimension::Angle => 100.0,
        Dimension::Length => 100.0,
        Dimension::Mass => 1e3,
        Dimension::Force => 1e5,
        Dimension::Torque => 1e4,
        Dimension::Pressure => 1e8,
        Dimension::Voltage => 1e4,
        Dimension::Current => 1e3,
        Dimension::Velocity => 1e3,
        Dimension::AngularVelocity => 1e4,
        Dimension::Acceleration => 1e4,
        Dimension::Temperature => 2e3,
        Dimension::One | Dimension::Time | Dimension::Sample | Dimension::Frequency => return None,
    })
}

/// Warnings for the signals of a trial.
pub(crate) fn warnings(manifest: &Manifest, layout: &crate::layout::Layout, trial: &Trial) -> Vec<String> {
    let mut warnings = Vec::new();
    if trial.samples() == 0 {
        return warnings;
    }
    let arm = manifest.arm.as_ref().map(|a| a.length.si());
    let parts = [(&layout.actuators, &trial.actuators), (&layout.context, &trial.context)];
    for (sources, values) in parts {
        for (source, column) in sources.iter().zip(values.column_iter()) {
            warnings.extend(too_large(source, column.amax(), limit(source.unit.dimension), trial));
        }
    }
    for (source, column) in layout.measured.iter().zip(trial.measured.column_iter()) {
        let far = arm.map(|l| 30.0 * l).or(limit(source.unit.dimension));
        warnings.extend(too_large(source, column.amax(), far, trial));
    }
    if let Some(arm) = arm {
        warnings.extend(too_small(&layout.measured, arm, trial));
    }
    warnings
}

fn too_large(source: &Source, greatest: f64, limit: Option<f64>, trial: &Trial) -> Option<String> {
    let limit = limit.filter(|l| greatest > *l)?;
    let (unit, name) = (source.unit, source.unit.si_name());
    let better = unit.siblings().filter(|u| greatest / unit.factor() * u.factor() <= limit);
    let better = better.max_by(|a, b| a.factor().total_cmp(&b.factor()));
    Some(format!(
        "{}: column `{}` of trial `{}` reaches {greatest:.4} {name}; unit is {}{}",
        trial.file.display(),
        source.column,
        trial.name,
        unit.name,
        better.map_or("; is that right?".to_string(), |b| suggest(&unit, b)),
    ))
}

/// All markers of a trial move and lie within a hundredth of the arm: the unit is too small.
fn too_small(measured: &[Source], arm: f64, trial: &Trial) -> Option<String> {
    let greatest = trial.measured.amax();
    let source = measured.first().filter(|_| greatest > 0.0 && greatest < arm / 100.0)?;
    let unit = source.unit;
    let better = unit.siblings().find(|u| (0.1..=30.0).contains(&(greatest / unit.factor() * u.factor() / arm)))?;
    Some(format!(
        "{}: no marker of trial `{}` is farther than {greatest:.3e} m from the origin, and the arm is {arm} m long; unit is {}{}",
        trial.file.display(),
        trial.name,
        unit.name,
        suggest(&unit, better),
    ))
}

fn suggest(unit: &Unit, better: &Unit) -> String {
    format!("; did you mean {}? (factor {})", better.name, better.factor() / unit.factor())
}
