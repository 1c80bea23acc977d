//! Columns as signals: what is commanded and what is measured. Names tell first; what they leave open is divided so that there are
//! inputs and outputs.

use std::collections::BTreeMap;

use super::column::Column;
use super::found::Found;
use super::names;
use crate::ingest::periodic;
use crate::units::Unit;

/// Words of columns that are neither, of commands and of measurements: the strong ones first.
const WORDS: [(Part, &str); 5] = [
    (Part::Unknown, "rotation quat quaternion error quality residual temperature temp time timestamp"),
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

/// Words of the point that matters most.
const TIP: &str = "tip tool effector";

/// Signals of one part that are proposed of a table, and of another format.
const PROPOSED: [usize; 2] = [12, 3];

/// What a column is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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

/// What a name tells.
fn named(name: &str) -> Option<Part> {
    let words = names::words(name);
    WORDS.iter().find(|(_, list)| names::any(&words, list)).map(|(part, _)| *part)
}

/// Number of commands minus number of measurements, judged by the names of a group and of its columns.
pub(super) fn commands(found: &Found) -> i32 {
    let vote = |name: &str| match named(name) {
        Some(Part::Actuator) => 1,
        Some(Part::Measured) => -1,
        _ => 0,
    };
    100 * vote(&found.name) + found.columns().iter().map(|column| vote(column.name)).sum::<i32>()
}

/// All columns but those of time and of trials.
pub(super) fn signals(sources: &[Found]) -> Vec<Signal<'_>> {
    let mut signals: Vec<Signal> = Vec::new();
    for source in sources {
        let time = source.time.as_ref().map(|time| time.column.as_str());
        let by = source.by.as_ref().map(|(column, _)| column.as_str());
        let columns = source.columns().into_iter();
        let others = columns.filter(|column| Some(column.name) != time && Some(column.name) != by);
        signals.extend(others.map(|column| Signal::new(source, column, std::ptr::eq(source, &sources[0]))));
    }
    divide(&mut signals);
    signals
}

impl<'a> Signal<'a> {
    fn new(source: &'a Found, of: Column<'a>, is_reference: bool) -> Signal<'a> {
        let said = of.looks.iter().find_map(|look| look.unit.as_deref());
        let (flaw, (period, unit)) = (of.flaw(), period(&of, said));
        Signal { of, source, unit, part: Part::Unknown, period, flaw, is_reference }
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

    /// What its name tells; one that says nothing is what its source is.
    pub fn named(&self) -> Part {
        named(self.of.name).or_else(|| named(&self.source.name)).unwrap_or(Part::Unknown)
    }
}

/// The period by which a column jumps, and its unit: one without a unit is tried as an angle, then as a counter.
fn period<'a>(of: &Column<'a>, said: Option<&'a str>) -> (Option<f64>, Option<&'a str>) {
    let jumps = |turn| of.looks.iter().find_map(|look| periodic::find(&look.values, turn)).map(|wraps| wraps.period);
    let units = if said.is_some() { vec![said] } else { vec![Some("rad"), Some("deg"), None] };
    let found = units.into_iter().find_map(|unit| Some((jumps(unit.and_then(full_turn))?, unit)));
    found.map_or((None, said), |(period, unit)| (Some(period), unit))
}

/// A full turn in a unit of angles.
fn full_turn(unit: &str) -> Option<f64> {
    Unit::parse(unit).ok()?.full_turn()
}

/// Outputs are those of the reference; of motion capture, the tip's come first.
fn rank_as_output(signal: &Signal) -> Option<bool> {
    let is_first = || signal.source.format.is_table() || names::any(&names::words(signal.of.name), TIP);
    (signal.is_reference && signal.named() == Part::Measured).then(|| !is_first())
}

/// Commands are named so, or from another source than the outputs; those of tables come first, and those with empty cells last.
fn rank_as_actuator(signal: &Signal) -> Option<[bool; 4]> {
    let is_other = signal.named() != Part::Actuator;
    let is_sparse = signal.is_reference && signal.of.empty() > 0;
    Some([is_sparse, is_other, is_other && signal.is_reference, !signal.source.format.is_table()])
}

/// Proposes actuators and outputs. Where all are one of the two, half of them become the other.
fn divide(signals: &mut [Signal]) {
    pick(signals, Part::Measured, rank_as_output);
    pick(signals, Part::Actuator, rank_as_actuator);
    pick(signals, Part::Measured, |signal| signal.is_reference.then_some(()));
    let mut picked: Vec<&mut Signal> = signals.iter_mut().filter(|signal| signal.part != Part::Unknown).collect();
    if picked.windows(2).all(|pair| pair[0].part == pair[1].part) {
        let half = picked.len() / 2;
        let (inputs, outputs) = picked.split_at_mut(half);
        inputs.iter_mut().for_each(|signal| signal.part = Part::Actuator);
        outputs.iter_mut().for_each(|signal| signal.part = Part::Measured);
    }
}

/// Where no signal has a part yet, those of the lowest rank get it, a few of each source.
fn pick<R: Ord>(signals: &mut [Signal], part: Part, rank: fn(&Signal) -> Option<R>) {
    let is_open = |signal: &Signal| signal.part == Part::Unknown && signal.flaw.is_none();
    let ranks: Vec<_> = signals.iter().map(|signal| rank(signal).filter(|_| is_open(signal))).collect();
    let best = ranks.iter().flatten().min();
    if best.is_none() || signals.iter().any(|signal| signal.part == part) {
        return;
    }
    let mut counts = BTreeMap::<&str, usize>::new();
    for (signal, _) in signals.iter_mut().zip(&ranks).filter(|(_, rank)| rank.as_ref() == best) {
        let count = counts.entry(&signal.source.name).or_default();
        *count += 1;
        if *count <= PROPOSED[usize::from(!signal.source.format.is_table())] {
            signal.part = part;
        }
    }
}
