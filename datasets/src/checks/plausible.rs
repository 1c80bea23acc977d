//! Values that cannot be meant: a tip 300 m away is a tip in millimetres, a joint at 45 rad is one in degrees, an actuator that
//! never moves is another column.
//!
//! Each is a warning, with the unit that would make the value believable and its factor. Lengths of markers are compared
//! with the arm where one is described; everything else with what laboratories measure.

mod digits;

use std::ops::Range;
use std::path::PathBuf;

use nalgebra::DMatrix;

use crate::checks::{periodic, suspect};
use crate::ingest::layout::{Layout, Source};
use crate::join::jump::longest_pause;
use crate::manifest::{Manifest, Role};
use crate::preprocessing::segments::usual_step;
use crate::trial::Trial;
use crate::units::{Dimension, Unit};

pub(crate) use digits::number;

/// Largest believable value in SI.
fn limit(dimension: Dimension) -> Option<f64> {
    Some(match dimension {
        // two turns
        Dimension::Angle => 4.0 * std::f64::consts::PI,
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
        Dimension::Temperature | Dimension::Celsius => 2e3,
        Dimension::One | Dimension::Time | Dimension::Sample | Dimension::Frequency => return None,
        Dimension::Power | Dimension::Flow | Dimension::FluxDensity => return None,
    })
}

/// Nothing that is moved on purpose, and written in this unit, stays below it all the time, in SI.
fn least(unit: &Unit) -> Option<f64> {
    match unit.name {
        // a radian, taken for a degree
        "deg" => Some(3.2f64.to_radians()),
        "mm" => Some(1e-3),
        _ => None,
    }
}

/// No vehicle with an arm travels farther in a trial, m. Where it is does not matter: the origin is anywhere.
const FARTHEST: f64 = 1e3;

/// A part of a quaternion of length 1, and what rounding adds.
const QUATERNION: f64 = 1.01;

/// Steps in time that recordings have, s.
const STEPS: std::ops::RangeInclusive<f64> = 2e-5..=10.0;

/// Summary of a trial: range of each signal, and clock.
#[derive(Debug)]
pub(crate) struct Seen {
    trial: String,
    file: PathBuf,
    role: Role,
    samples: usize,
    /// Least and greatest value of the actuators, the context signals, the outputs and the vehicle, in this order.
    ranges: Vec<(f64, f64)>,
    /// The usual step, s.
    step: f64,
    /// The longest step, its ends, s, and the row behind it.
    pause: Option<(f64, f64, f64, usize)>,
    /// Its time has a type, and so a unit, of its own.
    typed_time: bool,
    /// Suspicious samples.
    suspicions: Vec<String>,
}

impl Seen {
    /// Statistics of a trial whose samples come from these rows of its file.
    pub fn of(trial: &Trial, rows: &[usize], layout: &Layout, typed_time: bool) -> Seen {
        let signals = [&trial.actuators, &trial.context, &trial.measured].into_iter().chain(&trial.vehicle);
        let signals = signals.flat_map(|part| part.column_iter());
        let range = |column: &[f64]| {
            column.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
        };
        let (whole, _) = trial.with_unmeasured();
        let time = &whole.time;
        let steps = trial.time.windows(2).zip(rows.iter().skip(1)).map(|(t, row)| (t[1] - t[0], t[0], t[1], *row));
        Seen {
            trial: trial.name.clone(),
            file: trial.file.clone(),
            role: trial.role,
            samples: trial.samples(),
            ranges: signals.map(|column| range(column.as_slice())).collect(),
            step: usual_step(time),
            pause: steps.reduce(|a, b| if b.0 > a.0 { b } else { a }),
            typed_time,
            suspicions: if trial.role == Role::Excluded {
                Vec::new()
            } else {
                [suspect::look(trial, rows, layout), jumps(trial, rows, layout)].concat()
            },
        }
    }

    fn greatest(&self, column: usize) -> f64 {
        self.ranges.get(column).map_or(0.0, |(low, high)| low.abs().max(high.abs()))
    }
}

/// Signals of a table that jump by a period; those of sources are looked at before they are joined.
fn jumps(trial: &Trial, rows: &[usize], layout: &Layout) -> Vec<String> {
    if layout.joined {
        return Vec::new();
    }
    let declared = |name: &String| {
        layout.periods.contains_key(name) || layout.quaternions.iter().flatten().any(|part| part == name)
    };
    let parts = [(&layout.actuators, Some(&trial.actuators)), (&layout.context, Some(&trial.context))];
    let others = [(&layout.measured, Some(&trial.measured)), (&layout.vehicle, trial.vehicle.as_ref())];
    let of = |(sources, values): (&Vec<Source>, Option<&DMatrix<f64>>)| {
        let mut named: Vec<(&Source, Vec<f64>)> = Vec::new();
        for (source, column) in sources.iter().zip(values.into_iter().flat_map(DMatrix::column_iter)) {
            named.push((source, column.iter().map(|value| value / source.unit.factor()).collect()));
        }
        let columns: Vec<periodic::Column> = named
            .iter()
            .filter(|(source, _)| !declared(&source.column))
            .map(|(source, values)| periodic::Column { name: &source.column, unit: Some(source.unit), values })
            .collect();
        let (table, row) = ("[table]".to_string(), |i: usize| rows[i]);
        periodic::warnings(&columns, &periodic::Place { file: &trial.file, trial: &trial.name, table, row: &row })
    };
    parts.into_iter().chain(others).flat_map(of).collect()
}

/// Warnings for the signals of the trials. What is said of all of them together waits until they are `complete`.
pub(crate) fn warnings(manifest: &Manifest, layout: &Layout, trials: &[Seen], complete: bool) -> Vec<String> {
    let read: Vec<&Seen> = trials.iter().filter(|t| t.samples > 0).collect();
    let used: Vec<&Seen> = read.iter().copied().filter(|t| t.samples > 1 && t.role != Role::Excluded).collect();
    let arm = manifest.arm.as_ref().map(|a| a.length.si()).filter(|_| manifest.has_markers());
    let (mut warnings, mut index) = (Vec::new(), 0);
    for (sources, part) in parts(layout) {
        for source in sources {
            let far = match (part, source.unit.dimension, arm) {
                (Kind::Measured, _, Some(length)) => Some(30.0 * length),
                (Kind::Vehicle, Dimension::Length, _) => Some(FARTHEST),
                (Kind::Vehicle, Dimension::One, _) => Some(QUATERNION),
                (_, dimension, _) => limit(dimension),
            };
            let column = Column { source, part, index };
            index += 1;
            warnings.extend(too_large(&column, far, &read));
            if complete {
                warnings.extend(too_small(&column, arm, &used));
                warnings.extend(constant(&column, &used));
            }
        }
    }
    let markers = index - layout.vehicle.len() - layout.measured.len()..index - layout.vehicle.len();
    if let Some(arm) = arm {
        warnings.extend(read.iter().filter_map(|trial| far_too_near(&layout.measured, markers.clone(), arm, trial)));
    }
    warnings.extend(unmoved(layout, &used).filter(|_| complete));
    warnings.extend(used.iter().filter_map(|trial| clock(layout, trial)));
    warnings.extend(used.iter().flat_map(|trial| trial.suspicions.iter().cloned()));
    warnings
}

/// Kind of a column of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Actuator,
    Context,
    Measured,
    Vehicle,
}

fn parts(layout: &Layout) -> [(&Vec<Source>, Kind); 4] {
    [
        (&layout.actuators, Kind::Actuator),
        (&layout.context, Kind::Context),
        (&layout.measured, Kind::Measured),
        (&layout.vehicle, Kind::Vehicle),
    ]
}

/// One signal, in all trials.
struct Column<'a> {
    source: &'a Source,
    part: Kind,
    index: usize,
}

impl Column<'_> {
    /// Its greatest value in a trial, or how far a vehicle travels.
    fn size(&self, trial: &Seen) -> f64 {
        match (self.part, self.source.unit.dimension) {
            (Kind::Vehicle, Dimension::Length) => trial.ranges.get(self.index).map_or(0.0, |(low, high)| high - low),
            _ => trial.greatest(self.index),
        }
    }

    /// The trial with the greatest value, and that value.
    fn worst<'t>(&self, trials: &[&'t Seen]) -> Option<(&'t Seen, f64)> {
        let all = trials.iter().map(|trial| (*trial, self.size(trial)));
        all.reduce(|a, b| if b.1 > a.1 { b } else { a })
    }
}

fn too_large(column: &Column, limit: Option<f64>, trials: &[&Seen]) -> Option<String> {
    let limit = limit?;
    let beyond = trials.iter().filter(|trial| column.size(trial) > limit).count();
    let (trial, greatest) = column.worst(trials).filter(|(_, greatest)| *greatest > limit)?;
    let (unit, name) = (column.source.unit, column.source.unit.si_name());
    let verb = if column.part == Kind::Vehicle && unit.dimension == Dimension::Length { "travels" } else { "reaches" };
    let others = if beyond > 1 { format!(", and {} more trials do,", beyond - 1) } else { String::new() };
    Some(format!(
        "{}: column `{}` of trial `{}` {verb} {}{others} {name}; unit is {}{}",
        trial.file.display(),
        column.source.column,
        trial.trial,
        number(greatest),
        unit.name,
        suggest(&unit, |converted| converted <= limit, greatest),
    ))
}

/// A marker is compared with the arm elsewhere, and a vehicle may stay where it is.
fn too_small(column: &Column, arm: Option<f64>, trials: &[&Seen]) -> Option<String> {
    if column.part == Kind::Vehicle || (column.part == Kind::Measured && arm.is_some()) {
        return None;
    }
    let unit = column.source.unit;
    let least = least(&unit)?;
    let (trial, greatest) = column.worst(trials).filter(|(_, greatest)| *greatest > 0.0 && *greatest < least)?;
    let limit = limit(unit.dimension).unwrap_or(f64::INFINITY);
    Some(format!(
        "{}: column `{}` stays below {} {} in all trials (greatest in `{}`); unit is {}{}",
        trial.file.display(),
        column.source.column,
        number(greatest),
        unit.si_name(),
        trial.trial,
        unit.name,
        suggest(&unit, |converted| converted >= least && converted <= limit, greatest),
    ))
}

/// A signal with one value in all trials tells nothing, and an output needs no model.
fn constant(column: &Column, trials: &[&Seen]) -> Option<String> {
    let (what, remedy) = match column.part {
        Kind::Actuator => ("actuator", "name the column that is commanded, or leave it out of the manifest"),
        Kind::Context => ("context signal", "leave it out of the manifest, or put it into [conditions]"),
        Kind::Measured => ("output", "name the column that is measured, or leave it out of the manifest"),
        // it may stay where it is
        Kind::Vehicle => return None,
    };
    let trial = trials.first()?;
    let (first, _) = *trial.ranges.get(column.index)?;
    let same = |trial: &&Seen| trial.ranges.get(column.index) == Some(&(first, first));
    trials.iter().all(same).then(|| {
        format!(
            "{}: column `{}` of trial `{}` and of all others is {} {}: the {what} is constant; {remedy}",
            trial.file.display(),
            column.source.column,
            trial.trial,
            number(first),
            column.source.unit.si_name(),
        )
    })
}

/// Development trials in which no input moves show no effect.
fn unmoved(layout: &Layout, trials: &[&Seen]) -> Option<String> {
    let inputs = layout.actuators.len() + layout.context.len();
    let rests = |trial: &&Seen| trial.ranges.iter().take(inputs).all(|(low, high)| low == high);
    let moving = trials.iter().filter(|trial| !rests(trial)).count();
    let mut developing = trials.iter().filter(|trial| trial.role == Role::Development);
    let first = developing.clone().next().filter(|_| !layout.actuators.is_empty() && moving > 0)?;
    developing.all(rests).then(|| {
        format!(
            "{}: no development trial moves an actuator (the first is `{}`), and only motion shows an effect; in [roles], name trials \
             under `development` in which actuators move",
            first.file.display(),
            first.trial
        )
    })
}

/// All markers of a trial move and lie within a hundredth of the arm: the unit is too small.
fn far_too_near(measured: &[Source], columns: Range<usize>, arm: f64, trial: &Seen) -> Option<String> {
    let greatest = columns.map(|column| trial.greatest(column)).fold(0.0, f64::max);
    let source = measured.first().filter(|_| greatest > 0.0 && greatest < arm / 100.0)?;
    let unit = source.unit;
    let better = unit.siblings().find(|u| (0.1..=30.0).contains(&(greatest / unit.factor() * u.factor() / arm)))?;
    Some(format!(
        "{}: no marker of trial `{}` is farther than {greatest:.3e} m from the origin, and the arm is {arm} m long; unit is {}{}",
        trial.file.display(),
        trial.trial,
        unit.name,
        meant(&unit, better),
    ))
}

/// A clock that was set while it was read, or a unit of time that is another.
fn clock(layout: &Layout, trial: &Seen) -> Option<String> {
    let step = trial.step;
    let Some(source) = layout.time.source() else {
        let rate = (step > 0.0 && !STEPS.contains(&step)).then(|| number(1.0 / step))?;
        return Some(format!(
            "{}: rate_hz is {rate} Hz for trial `{}`; is that right?",
            trial.file.display(),
            trial.trial
        ));
    };
    let place = format!("{}: column `{}` of trial `{}`", trial.file.display(), source.column, trial.trial);
    if let Some((length, from, to, row)) = trial.pause.filter(|(length, ..)| *length > longest_pause(step)) {
        return Some(format!(
            "{place} jumps by {} s in row {row}, from {from} s to {to} s; if the clock was set, correct it or split the trial",
            number(length)
        ));
    }
    let unit = source.unit;
    let wrong = wrong_step(&unit, step).filter(|_| unit.dimension == Dimension::Time)?;
    Some(match trial.typed_time {
        true => format!("{place} has {} s from sample to sample; is that right?", number(step)),
        false => format!("{place} {wrong}"),
    })
}

/// A step in time, in s, that no recording has, and the unit of time that was meant.
pub(crate) fn wrong_step(unit: &Unit, step: f64) -> Option<String> {
    (step > 0.0 && !STEPS.contains(&step)).then(|| {
        let suggestion = suggest(unit, |converted| STEPS.contains(&converted), step);
        format!("has {} s from sample to sample; unit is {}{suggestion}", number(step), unit.name)
    })
}

/// Units in which people write, before others that are believable too.
const USUAL: &[&str] = &["mm", "m", "deg", "rad", "ms", "s", "us", "bar", "kPa", "g", "N"];

/// The unit that was meant, if there is one in which the value is believable.
fn suggest(unit: &Unit, believable: impl Fn(f64) -> bool, value: f64) -> String {
    let fits = |u: &&Unit| believable(value / unit.factor() * u.factor());
    let usual = USUAL.iter().find_map(|name| unit.siblings().filter(fits).find(|u| u.name == *name));
    let other = || unit.siblings().filter(fits).max_by(|a, b| a.factor().total_cmp(&b.factor()));
    usual.or_else(other).map_or("; is that right?".to_string(), |better| meant(unit, better))
}

fn meant(unit: &Unit, better: &Unit) -> String {
    format!("; did you mean {}? (factor {})", better.name, better.factor() / unit.factor())
}
