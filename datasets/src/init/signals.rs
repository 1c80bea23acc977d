//! Columns as signals: what is commanded and what is measured. Names tell first; what they leave open is divided so that there are
//! inputs and outputs.

use std::collections::BTreeMap;

use super::column::Column;
use super::found::Found;
use super::names;
use super::time::Time;
use crate::ingest::periodic;
use crate::units::Unit;

/// Words of commands and words of measurements: strong ones, and weak ones that tell where no strong one does.
const WORDS: [(Part, &str); 4] = [
    (
        Part::Actuator,
        "cmd command commanded commands ref reference setpoint sp target desired des goal action soll sollwert",
    ),
    (Part::Measured, "meas measured measurement actual ist istwert observation obs feedback sensor encoder mocap"),
    (
        Part::Actuator,
        "u motor motors tendon pwm voltage volt duty throttle valve control ctrl input pressure torque current servo actuator",
    ),
    (Part::Measured, "x y z pos position marker tip state output displacement weg pose optitrack vicon"),
];

/// Words of columns that are neither, whatever else they say.
const NEITHER: &str = "rotation quat quaternion error quality residual temperature temp time timestamp";

/// Words of the point that matters most.
const TIP: &str = "tip tool effector";

/// Signals of one part that are proposed of a table, and of another format.
const PROPOSED: [usize; 2] = [12, 3];

/// What a column is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Part {
    Actuator,
    Measured,
    Unknown,
}

/// A column in a draft.
#[derive(Debug, Clone)]
pub(super) struct Signal<'a> {
    pub of: Column<'a>,
    pub source: &'a Found,
    pub unit: Option<&'a str>,
    pub part: Part,
    pub period: Option<f64>,
    /// Why it cannot be a signal.
    pub flaw: Option<String>,
    is_reference: bool,
}

fn named(name: &str) -> Part {
    let words = names::words(name);
    let part = WORDS.iter().find(|(_, list)| names::any(&words, list)).map_or(Part::Unknown, |(part, _)| *part);
    if names::any(&words, NEITHER) { Part::Unknown } else { part }
}

/// As [`named`]; a name that says nothing is what its group's is.
fn part_of(source: &Found, name: &str) -> Part {
    let silent = named(name) == Part::Unknown && !names::any(&names::words(name), NEITHER);
    named(if silent { &source.name } else { name })
}

/// Number of commands minus number of measurements, judged by the names of a group and of its columns.
pub(super) fn commands(found: &Found) -> i32 {
    let vote = |name: &str| match named(name) {
        Part::Actuator => 1,
        Part::Measured => -1,
        Part::Unknown => 0,
    };
    100 * vote(&found.name) + found.columns().iter().map(|column| vote(column.name)).sum::<i32>()
}

/// All columns but those of time and of trials.
pub(super) fn signals<'a>(sources: &'a [Found], times: &[Option<Time>], trial: Option<&str>) -> Vec<Signal<'a>> {
    let mut signals: Vec<Signal> = Vec::new();
    for (k, (source, time)) in sources.iter().zip(times).enumerate() {
        let time = time.as_ref().map(|time| time.column.as_str());
        let columns = source.columns().into_iter();
        let others = columns.filter(|column| Some(column.name) != time && Some(column.name) != trial);
        signals.extend(others.map(|column| Signal::new(source, column, k == 0)));
    }
    keep_few(&mut signals);
    fill(&mut signals);
    signals
}

impl<'a> Signal<'a> {
    fn new(source: &'a Found, of: Column<'a>, is_reference: bool) -> Signal<'a> {
        let (flaw, said) = (of.flaw(), of.looks.iter().find_map(|look| look.unit.as_deref()));
        let named = part_of(source, of.name);
        let open = flaw.is_some() || (named == Part::Actuator && of.empty() > 0);
        let part = if open { Part::Unknown } else { named };
        let (period, unit) = period(&of, said);
        Signal { of, source, unit, part, period, flaw, is_reference }
    }

    /// Name in results, where the column's name has a unit in brackets and no other column is named so.
    pub fn plain_name(&self) -> Option<&str> {
        let (base, _) = names::unit(self.of.name).filter(|_| self.of.name.ends_with([']', ')']))?;
        let alike = self.source.columns().iter().filter(|other| other.name.starts_with(base)).count();
        (!base.is_empty() && alike == 1).then_some(base)
    }

    /// Whether its period is a full turn.
    pub fn is_angle(&self) -> bool {
        self.unit.and_then(full_turn).is_some()
    }

    fn is_table(&self) -> bool {
        self.source.format.is_table()
    }

    fn most(&self) -> usize {
        PROPOSED[usize::from(!self.is_table())]
    }
}

/// The period by which a column jumps, and its unit: one without a unit is tried as an angle, then as a counter.
fn period<'a>(of: &Column<'a>, unit: Option<&'a str>) -> (Option<f64>, Option<&'a str>) {
    let jumps = |turn| of.looks.iter().find_map(|look| periodic::find(&look.values, turn)).map(|wraps| wraps.period);
    let angle = |unit| full_turn(unit).and_then(|turn| jumps(Some(turn)));
    match unit {
        Some(unit) => (angle(unit), Some(unit)),
        None => match ["rad", "deg"].into_iter().find_map(|unit| Some((angle(unit)?, unit))) {
            Some((turn, unit)) => (Some(turn), Some(unit)),
            None => (jumps(None), None),
        },
    }
}

/// A full turn in a unit of angles.
fn full_turn(unit: &str) -> Option<f64> {
    Unit::parse(unit).ok()?.full_turn()
}

/// Outputs are those of the reference; of motion capture and logs a few, the tip's first.
fn keep_few(signals: &mut [Signal]) {
    let commands = signals.iter().any(|signal| signal.is_table() && signal.part == Part::Actuator);
    let is_tip = |signal: &Signal| signal.is_table() || names::any(&names::words(signal.of.name), TIP);
    let tip = signals.iter().any(|signal| signal.part == Part::Measured && !signal.is_table() && is_tip(signal));
    let mut counts = BTreeMap::<(&str, Part), usize>::new();
    for signal in signals.iter_mut().filter(|signal| signal.part != Part::Unknown) {
        let elsewhere = match signal.part {
            Part::Measured => !signal.is_reference || (tip && !is_tip(signal)),
            _ => commands && !signal.is_table(),
        };
        let count = counts.entry((&signal.source.name, signal.part)).or_insert(0);
        *count += usize::from(!elsewhere);
        if elsewhere || *count > signal.most() {
            signal.part = Part::Unknown;
        }
    }
}

/// Where names tell of no actuator or of no output, open columns become one; where none is open, half of the others do.
fn fill(signals: &mut [Signal]) {
    let of = |signals: &[Signal], part: Part| -> Vec<usize> {
        (0..signals.len()).filter(|k| signals[*k].part == part && signals[*k].flaw.is_none()).collect()
    };
    let set = |signals: &mut [Signal], which: &[usize], part| which.iter().for_each(|k| signals[*k].part = part);
    if of(signals, Part::Actuator).is_empty() {
        let key = |k: &usize| (signals[*k].is_reference, !signals[*k].is_table());
        let full = |k: &usize| signals[*k].of.empty() == 0 || !signals[*k].is_reference;
        let mut pool: Vec<usize> = of(signals, Part::Unknown).into_iter().filter(full).collect();
        let first = pool.iter().map(key).min();
        pool.retain(|k| Some(key(k)) == first);
        let share = if first.is_some_and(|(is_reference, _)| is_reference) && of(signals, Part::Measured).is_empty() {
            2
        } else {
            1
        };
        let count = pool.first().map_or(0, |k| (pool.len() / share).min(signals[*k].most()));
        set(signals, &pool[..count], Part::Actuator);
    }
    if of(signals, Part::Measured).is_empty() {
        let pool: Vec<usize> = of(signals, Part::Unknown).into_iter().filter(|k| signals[*k].is_reference).collect();
        let count = pool.first().map_or(0, |k| pool.len().min(signals[*k].most()));
        set(signals, &pool[..count], Part::Measured);
    }
    let (actuators, outputs) = (of(signals, Part::Actuator), of(signals, Part::Measured));
    if actuators.is_empty() {
        set(signals, &outputs[..outputs.len() / 2], Part::Actuator);
    } else if outputs.is_empty() {
        set(signals, &actuators[actuators.len().div_ceil(2)..], Part::Measured);
    }
}
