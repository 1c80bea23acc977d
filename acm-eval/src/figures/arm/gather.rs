//! Data of the figure in space, from the tables of predictions and the poses beside them.

use acm_core::NominalModel;
use acm_train::run::nominal::poses::{Poses, TrialPoses};
use acm_train::run::record::{NominalSource, RunRecord};

use crate::figures::canvas::palette;
use crate::figures::plotted::space::{Space, SpaceLoad, SpaceTrial, Tip};
use crate::run::Run;
use crate::run::predictions::{HELD_OUT, Predictions};
use crate::section::estimator::Estimator;
use crate::section::{Section, natural};

/// Largest number of trials, and of samples of each, where no poses select them.
const TRIALS: usize = 3;
const SAMPLES: usize = 200;

/// Magnifications of the residual's arrow.
const MAGNIFIED: [f64; 6] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0];
/// The middle one of all arrows is no longer than this part of the picture.
const SHARE: f64 = 0.12;

/// The run whose nominal model is drawn, its first final record, its table, and its poses.
struct Source<'a> {
    run: &'a Run,
    record: &'a RunRecord,
    table: &'a Predictions,
    poses: Option<&'a Poses>,
}

/// Gathers the data in display units; none without held-out trials, or where the outputs are no position in space.
pub fn space(section: &Section) -> Option<Space> {
    if section.outputs.len() != 3 || section.data.unit != "m" {
        return None;
    }
    let source = source(section)?;
    let trials: Vec<SpaceTrial> = match source.poses {
        Some(poses) => poses.trials.iter().map(|poses| trial(section, &source, poses)).collect(),
        None => shown(&source).iter().map(|poses| trial(section, &source, poses)).collect(),
    };
    let trials: Vec<SpaceTrial> = trials.into_iter().filter(|trial| !trial.time.is_empty()).collect();
    let down = trials.first()?.loads.first().map_or([0.0, 0.0, -1.0], |load| load.direction);
    let (unit, axes) = (section.display.symbol.clone(), section.outputs.clone());
    let mut space = Space { unit, axes, frame: frame(down), magnified: 1.0, trials };
    space.magnified = magnified(&space);
    Some(space)
}

/// Returns the first run that has poses, else the first with a final run.
fn source(section: &Section) -> Option<Source<'_>> {
    let with_poses = section.runs.iter().find_map(|run| {
        let poses = run.poses.as_ref()?;
        let (record, table) = run.finals().find(|(record, _)| record.id == poses.run)?;
        Some(Source { run, record, table, poses: Some(poses) })
    });
    with_poses.or_else(|| {
        let first = |run| Run::finals(run).next().map(|(record, table)| Source { run, record, table, poses: None });
        section.runs.iter().find_map(first)
    })
}

/// Returns the trials and times alone, where there are no poses.
fn shown(source: &Source) -> Vec<TrialPoses> {
    let mut trials: Vec<&str> = source.table.trials(HELD_OUT).iter().map(|rows| rows.trial).collect();
    trials.sort_by_key(|trial| natural(trial));
    trials.dedup();
    let of = |trial: &str| {
        let rows = rows(source.table, trial);
        let step = rows.len().div_ceil(SAMPLES).max(1);
        let time = rows.into_iter().step_by(step).map(|row| source.table.time()[row]).collect();
        TrialPoses { trial: trial.into(), time, points: vec![], loads: vec![] }
    };
    trials.into_iter().take(TRIALS).map(of).collect()
}

/// Returns the rows of a held-out trial, by time.
fn rows(table: &Predictions, trial: &str) -> Vec<usize> {
    let own = table.trials(HELD_OUT).into_iter().filter(|rows| rows.trial == trial);
    let mut rows: Vec<usize> = own.flat_map(|rows| rows.rows).collect();
    rows.sort_by(|&a, &b| table.time()[a].total_cmp(&table.time()[b]));
    rows
}

/// Returns one trial at the times of its table.
fn trial(section: &Section, source: &Source, poses: &TrialPoses) -> SpaceTrial {
    let factor = section.display.factor;
    let held = rows(source.table, &poses.trial);
    let is_known = |time: &f64| place(source.table, &held, *time).is_some();
    let kept: Vec<usize> = (0..poses.time.len()).filter(|&k| is_known(&poses.time[k])).collect();
    let time: Vec<f64> = kept.iter().map(|&k| poses.time[k]).collect();
    let shown = |point: &[f64; 3]| point.map(|value| value * factor);
    let arm = |k: &usize| poses.points.get(*k).map(|arm| arm.iter().map(shown).collect());
    let tip = |name: &str, colour: &str, table: &Predictions, estimate: &str| {
        tip(section, (name, colour), (table, estimate), &poses.trial, &time)
    };
    let nominal = section.estimators.iter().find(|estimator| estimator.key == "nominal");
    let name = nominal.map_or("Nominal", |estimator| estimator.label.as_str());
    let mut tips = vec![
        tip("measured", palette::INK, source.table, "measured"),
        tip(name, palette::GREY, source.table, "nominal"),
    ];
    let learned = |network: &Estimator| {
        let (_, table) = section.median_seed(network)?;
        Some(tip(&network.label, network.colour, table, "predicted"))
    };
    tips.extend(section.networks().filter_map(learned));
    tips.retain(|tip| tip.points.len() == time.len());
    let load = |load: &acm_train::run::nominal::poses::Load| SpaceLoad {
        name: load.name.clone(),
        place: load.place,
        direction: load.direction,
        unit: load.unit.clone(),
        size: kept.iter().filter_map(|&k| load.size.get(k).copied()).collect(),
    };
    SpaceTrial {
        trial: poses.trial.clone(),
        arm: kept.iter().filter_map(arm).collect(),
        tips,
        loads: poses.loads.iter().map(load).collect(),
        time,
    }
}

/// Returns the row of a time stamp.
fn place(table: &Predictions, rows: &[usize], time: f64) -> Option<usize> {
    let found = rows.binary_search_by(|&row| table.time()[row].total_cmp(&time)).ok()?;
    Some(rows[found])
}

/// Returns an estimate of the tip, in display units.
fn tip(
    section: &Section,
    (name, colour): (&str, &str),
    (table, estimate): (&Predictions, &str),
    trial: &str,
    time: &[f64],
) -> Tip {
    let held = rows(table, trial);
    let at =
        |row: usize| std::array::from_fn(|o| section.display.factor * table.column(estimate, &section.outputs[o])[row]);
    let points = time.iter().filter_map(|&time| place(table, &held, time)).map(at).collect();
    Tip { name: name.into(), colour: colour.into(), points }
}

/// Returns right, ahead and up, a right-handed frame whose up is against `down`, which lies along an axis.
fn frame(down: [f64; 3]) -> [[f64; 3]; 3] {
    let axis = (0..3).max_by(|&a, &b| down[a].abs().total_cmp(&down[b].abs())).unwrap_or(2);
    let unit = |k: usize, sign: f64| {
        let mut unit = [0.0; 3];
        unit[k % 3] = sign;
        unit
    };
    match down[axis] > 0.0 {
        false => [unit(axis + 1, 1.0), unit(axis + 2, 1.0), unit(axis, 1.0)],
        true => [unit(axis + 2, 1.0), unit(axis + 1, 1.0), unit(axis, -1.0)],
    }
}

/// Returns the error of the nominal model at each time.
pub fn missed(trial: &SpaceTrial) -> Vec<f64> {
    let off = |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
    trial.tips[0].points.iter().zip(&trial.tips[1].points).map(off).collect()
}

/// Returns the largest of [`MAGNIFIED`] at which the median arrow is no longer than [`SHARE`] of the picture; at least
/// 1.
fn magnified(space: &Space) -> f64 {
    let mut missed: Vec<f64> = space.trials.iter().flat_map(missed).collect();
    missed.sort_by(f64::total_cmp);
    let median = missed.get(missed.len() / 2).copied().unwrap_or(0.0);
    let fits = |factor: &&f64| **factor * median <= SHARE * space.extent();
    MAGNIFIED.iter().rev().find(fits).copied().filter(|_| median > 0.0).unwrap_or(1.0)
}

/// Writes the words below the figure.
pub fn explanation(section: &Section, space: &Space) -> String {
    let drawn = match (space.has_arm(), source(section)) {
        (true, Some(source)) => format!(
            "The line is the backbone that the nominal model of {} says, from the base to the tip; only the tip is measured.",
            named(&source)
        ),
        (_, source) => format!("The tip alone is drawn: {}.", source.map_or("", |source| no_arm(&source))),
    };
    let loads: Vec<&str> = space.trials.iter().flat_map(|trial| &trial.loads).filter_map(told).collect();
    let told = if loads.is_empty() {
        String::new()
    } else {
        format!(" Arrows of loads: {}; the nominal model knows none of them.", distinct(loads).join(", "))
    };
    format!(
        "{drawn} The red arrow is the residual ×{}, from the nominal tip towards the measured one. Shown first: the sample of a \
         trial that the nominal model misses most, from azimuth −60°, elevation 18°. Networks: the seed with the median \
         error.{told}",
        space.magnified
    )
}

/// Describes the arrow of a load.
fn told(load: &SpaceLoad) -> Option<&'static str> {
    match load.name.as_str() {
        "weight" => Some("weight, its direction alone"),
        "payload" => Some("payload, its weight in N"),
        "downwash" => Some("downwash, in proportion to the throttle"),
        _ => None,
    }
}

fn distinct(names: Vec<&'static str>) -> Vec<&'static str> {
    let mut seen = vec![];
    for name in names {
        if !seen.contains(&name) {
            seen.push(name);
        }
    }
    seen
}

fn named(source: &Source) -> String {
    format!("{}, {}", source.run.name, source.record.id)
}

/// Returns the reason why there is no arm.
fn no_arm(source: &Source) -> &'static str {
    let is_arm = |pair: &acm_train::run::record::CalibrationPair| {
        pair.nominal.as_ref().is_some_and(|nominal| matches!(nominal.model, NominalModel::Strain(_)))
    };
    match source.run.nominal.source {
        NominalSource::Predicted => "the nominal prediction came with the data, without an arm",
        NominalSource::Augmented => {
            "the nominal prediction is of a saved model with effects, which moves the tip alone"
        }
        NominalSource::None => "there is no nominal model",
        _ if source.run.nominal.calibrations.values().any(is_arm) => {
            "the folder holds no poses of the arm, which acm-train keeps of an experiment that is run alone"
        }
        _ => "the nominal model is a polynomial, which knows no arm",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: up is against gravity, and the determinant of a right-handed frame is 1.
    #[test]
    fn up_is_against_gravity_whatever_axis_that_is() {
        for down in [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]] {
            let [a, b, c] = frame(down);
            assert_eq!(c, down.map(|value| 0.0 - value), "{down:?}");
            let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            assert_eq!(cross, c, "{down:?}");
        }
    }
}
