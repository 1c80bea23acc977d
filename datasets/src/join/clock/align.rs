//! Alignment of a source's clock to the reference's, for one trial.

use std::fmt;

use super::estimate::{Named, Request, estimate};
use super::event;
use crate::join::quality::Quality;
use crate::join::series::Series;
use crate::join::signals::Signals;
use crate::manifest::{Clock, Drift, OffsetTable, Source};
use crate::units::Unit;

/// The clock of one source of one trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Alignment {
    /// The trial.
    pub trial: String,
    /// The source.
    pub source: String,
    /// Added to the source's time at its time `origin`, s.
    pub offset: f64,
    /// Half of the offset's 95 % interval, s; 0 of a given one. Where a lag is part of the offset, it contains it.
    pub interval: f64,
    /// Time constant of the largest lag that may be part of an estimated offset, s, and whether there is one.
    pub lag: (f64, bool),
    /// Relative rate of the clocks less one, 1.
    pub drift: f64,
    /// Half of its 95 % interval, 1; 0 of a given one.
    pub drift_interval: f64,
    /// Source time at which the offset holds, s.
    pub origin: f64,
    /// Origin of the offset.
    pub how: How,
    /// Samples per second of the reference and of the source, Hz.
    pub rates: (f64, f64),
    /// How long both recorded, s.
    pub overlap: f64,
    /// How evenly the source was sampled, and what it lacks.
    pub quality: Quality,
}

/// Origin of an offset.
#[derive(Debug, Clone, PartialEq)]
pub enum How {
    /// It is the reference, or has the same clock.
    Same,
    /// The manifest gives it.
    Given,
    /// Offset from an event.
    Event,
    /// Offset from the correlation of the rates of two columns.
    Estimated {
        /// Column of the reference.
        reference: String,
        /// Column of the source.
        column: String,
        /// Correlation of the rates.
        correlation: f64,
    },
    /// The median of so many trials' estimates.
    Common(usize),
}

impl Alignment {
    /// The source's time at a time of the reference, s.
    pub fn source_time(&self, time: f64) -> f64 {
        self.origin + (time - self.offset - self.origin) / (1.0 + self.drift)
    }

    /// The reference's time at a time of the source, s.
    pub fn reference_time(&self, time: f64) -> f64 {
        self.origin + self.offset + (time - self.origin) * (1.0 + self.drift)
    }

    /// The lag that the interval contains, s.
    pub(crate) fn seen_lag(&self) -> f64 {
        if self.lag.1 { self.lag.0 } else { 0.0 }
    }

    /// Whether it was estimated from what was recorded: then it contains what dead time there is.
    pub fn is_estimated(&self) -> bool {
        matches!(self.how, How::Estimated { .. } | How::Common(_))
    }
}

/// `motors: t + 0.7312 s ± 0.4 ms, drift 41 ± 12 ppm (from `q1` and `X`, correlation 0.98) · 50.0 Hz onto 120.0 Hz · overlap 31.2 s`.
impl fmt::Display for Alignment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.source)?;
        match &self.how {
            How::Same => write!(f, "on the reference's clock")?,
            _ => write!(f, "t {:+.6} s ± {:.2} ms", self.offset, 1e3 * self.interval)?,
        }
        if self.drift != 0.0 || self.drift_interval != 0.0 {
            write!(f, ", drift {:.1} ± {:.1} ppm", 1e6 * self.drift, 1e6 * self.drift_interval)?;
        }
        match &self.how {
            How::Same => {}
            How::Given => write!(f, " (given)")?,
            How::Event => write!(f, " (from an event)")?,
            How::Common(trials) => write!(f, " (median of the estimates of {trials} trials; {})", part(self.lag))?,
            How::Estimated { reference, column, correlation } => {
                let from = format!("`{column}` and `{reference}`, correlation {correlation:.2}");
                write!(f, " (estimated from {from}; {})", part(self.lag))?;
            }
        }
        write!(f, " · {:.1} Hz onto {:.1} Hz · overlap {:.2} s", self.rates.1, self.rates.0, self.overlap)
    }
}

/// What an estimated offset contains beside the clock's.
fn part((constant, is_seen): (f64, bool)) -> String {
    let most = if constant.is_finite() { format!("up to {:.0} ms", 1e3 * constant) } else { "unknown size".into() };
    match is_seen {
        true => format!("a dead time is part of it, and so is a lag of {most}, which the interval covers"),
        false => format!("a dead time is part of it, and a lag of {most} may be"),
    }
}

/// The signals of reference and source of a trial, and the columns to compare, by their names in the files.
pub struct Both<'a> {
    pub reference: &'a Signals,
    pub source: &'a Signals,
    /// Compared columns of the reference and of the source.
    pub compared: (Vec<String>, Vec<String>),
    /// They are of one quantity.
    pub same_quantity: bool,
}

/// Brings a source's clock to the reference's.
pub fn align(trial: &str, source: &Source, both: &Both, start: f64) -> Result<Alignment, String> {
    let mut found = Alignment {
        trial: trial.to_string(),
        source: source.name.clone(),
        offset: 0.0,
        interval: 0.0,
        lag: (0.0, false),
        drift: 0.0,
        drift_interval: 0.0,
        origin: start,
        how: How::Same,
        rates: (rate(both.reference), rate(both.source)),
        overlap: 0.0,
        quality: Quality::of(both.source),
    };
    let drift = match &source.drift {
        Some(Drift::Table(given)) => Some(given.ppm * 1e-6),
        Some(Drift::Word(_)) => None,
        None => Some(0.0),
    };
    if source.clock == Some(Clock::Same) {
        found.offset = between_origins(both);
    } else if !source.is_reference() {
        let offset = source.offset.as_ref().map(crate::manifest::Offset::table).unwrap_or_default();
        if let Some(value) = &offset.value {
            let value = value
                .of(trial)
                .ok_or("`value` in `offset` lacks this trial; add it, or exclude the trial in [roles]")?;
            let unit = offset.unit.as_deref().and_then(|unit| Unit::parse(unit).ok());
            found.offset = unit.map_or(value, |unit| unit.to_si(value));
            found.how = How::Given;
        } else if offset.event.is_some() {
            (found.offset, found.interval) = at_event(&offset, both)?;
            found.how = How::Event;
        } else {
            estimated(&mut found, &offset, drift, both)?;
        }
        if !found.is_estimated() {
            (found.drift, found.origin) = (drift.unwrap_or(0.0), start - found.offset);
        }
    }
    found.overlap = overlap(both, &found);
    match found.overlap > 0.0 {
        true => Ok(found),
        false => {
            Err("it does not overlap with the reference; correct the offset, or check that the files belong together"
                .into())
        }
    }
}

/// Offset of two files on one clock, s: a file with dates counts from its first one, any other from the clock's zero.
fn between_origins(both: &Both) -> f64 {
    let origin = |signals: &Signals| signals.origin.unwrap_or(0);
    (origin(both.source) - origin(both.reference)) as f64 * 1e-9
}

fn estimated(found: &mut Alignment, offset: &OffsetTable, drift: Option<f64>, both: &Both) -> Result<(), String> {
    let series = |signals: &Signals, names: &[String]| -> Vec<(String, Series)> {
        names.iter().filter_map(|name| Some((name.clone(), signals.series(name)?))).collect()
    };
    let (references, sources) = (series(both.reference, &both.compared.0), series(both.source, &both.compared.1));
    if references.is_empty() || sources.is_empty() {
        return Err("no columns are there to compare; name two of the same quantity in `offset`: { estimate = \"estimate\", by = \
                    [\"of the reference\", \"of this source\"] }"
            .into());
    }
    let r: Vec<Named> = references.iter().map(|(name, series)| (name.as_str(), series)).collect();
    let s: Vec<Named> = sources.iter().map(|(name, series)| (name.as_str(), series)).collect();
    let around = match (offset.around.as_ref().map(|around| around.of(&found.trial)), offset.within) {
        (None, None) | (Some(None), _) => None,
        (middle, within) => Some((middle.flatten().unwrap_or(0.0), within.unwrap_or(f64::INFINITY))),
    };
    let estimate = estimate(&r, &s, &Request { around, drift, same_quantity: both.same_quantity })
        .map_err(|refusal| refusal.to_string())?;
    (found.offset, found.interval, found.origin) = (estimate.offset, estimate.interval, estimate.origin);
    (found.drift, found.drift_interval, found.lag) = (estimate.drift, estimate.drift_interval, estimate.lag);
    let (reference, column, correlation) = (estimate.reference, estimate.source, estimate.correlation);
    found.how = How::Estimated { reference, column, correlation };
    Ok(())
}

fn at_event(offset: &OffsetTable, both: &Both) -> Result<(f64, f64), String> {
    let missing = |what: &str| format!("{what} never rises above its threshold; correct the event in `offset`");
    // as in the file, or with the source's name before it
    let of = |signals: &Signals, column: &Option<String>| {
        let name = column.as_deref()?;
        signals.series(name).or_else(|| signals.series(name.split_once('.')?.1))
    };
    let reference = of(both.reference, &offset.reference).ok_or_else(|| missing("the reference"))?;
    let source = of(both.source, &offset.event).ok_or_else(|| missing("the source"))?;
    let (above, reference_above) = (offset.above.unwrap_or(0.0), offset.reference_above.unwrap_or(0.0));
    event::offset((&reference, reference_above), (&source, above)).ok_or_else(|| missing("one of the two columns"))
}

/// Median rate of the axis with the most samples, Hz.
fn rate(signals: &Signals) -> f64 {
    let most = signals.axes.iter().max_by_key(|axis| axis.time.len());
    let step = most.map_or(0.0, |axis| Series { time: axis.time.clone(), values: Vec::new() }.step());
    if step > 0.0 { 1.0 / step } else { 0.0 }
}

/// How long both recorded, s of the reference.
fn overlap(both: &Both, found: &Alignment) -> f64 {
    let span = |signals: &Signals| {
        let first = signals.axes.iter().filter_map(|axis| axis.time.first()).copied().fold(f64::INFINITY, f64::min);
        let last = signals.axes.iter().filter_map(|axis| axis.time.last()).copied().fold(f64::NEG_INFINITY, f64::max);
        (first, last)
    };
    let (r, s) = (span(both.reference), span(both.source));
    let (from, to) = (found.source_time(r.0).max(s.0), found.source_time(r.1).min(s.1));
    (to - from).max(0.0)
}
