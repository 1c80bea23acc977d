//! Offset between two clocks, estimated from the recorded motion.
//!
//! 1. Outliers are left out, and the rates of every pair of columns are correlated over all offsets at which half of the shorter
//!    recording overlaps: [`super::correlate`]. The pair with the most evidence is taken.
//! 2. Offsets elsewhere whose correlation is within 20 % of the best are as likely: all are named, and none is taken.
//! 3. Offset and drift are refined below one sample, with an interval: [`super::refine`]. Of windows of several widths, that with
//!    the smallest interval is taken: a wide one is quieter, a narrow one sees more of the motion. What the others' offsets are
//!    off from it widens the interval.
//!
//! It cannot be distinguished from a dead time: where the source commands what the reference measures, the offset includes the plant's
//! delay at the rates of the motion. A lag can be distinguished from a delay where the motion is fast enough: [`super::lag`].

use super::correlate::{POINTS, PRODUCTS, Peak, correlate};
use super::lag::largest_lag;
use super::refine::{Pair, Refined, refine};
use super::slope::local;
use crate::join::series::Series;

/// A rival with this share of the best correlation is refused.
const RIVAL: f64 = 0.8;

/// Ratio of the remaining power of a rival offset to that of the best from which on the best is clear.
const TELLING: f64 = 2.0;

/// Smallest remaining power that is assumed of the best: between two steps of offsets a correlation is that much smaller.
const LEFT: f64 = 0.1;

/// Smaller correlations are none.
const LOWEST: f64 = 0.4;

/// Half widths of the windows of rates, in steps of the slower signal.
const WIDTHS: [f64; 5] = [4.0, 8.0, 16.0, 32.0, 64.0];

/// Offsets that are named where several are as likely.
const NAMED: usize = 5;

/// Correlation above which the window with the smallest interval is taken.
const CLEAR: f64 = 0.8;

/// Pairs of columns that are compared, at most.
const PAIRS: usize = 64;

/// Prior knowledge of the offset.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Request {
    /// The offset is looked for around this one, within so many seconds; everywhere where it is left out.
    pub around: Option<(f64, f64)>,
    /// The drift; it is estimated where it is left out.
    pub drift: Option<f64>,
    /// The columns are of one quantity: of several offsets, those with a positive correlation come first.
    pub same_quantity: bool,
}

/// A named column.
pub type Named<'a> = (&'a str, &'a Series);

/// An offset that was estimated.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Added to the source's time at the trial's start, s.
    pub offset: f64,
    /// Half of its 95 % interval, s. It contains the lag where there is one.
    pub interval: f64,
    /// Time constant of the largest first-order lag that may be part of it, s, and whether there is one: a delay alone does not fit.
    pub lag: (f64, bool),
    /// Relative rate of the clocks less one, 1.
    pub drift: f64,
    /// Half of its 95 % interval, 1; 0 where it was given.
    pub drift_interval: f64,
    /// Source time at which the offset holds, s.
    pub origin: f64,
    /// Correlation of the rates.
    pub correlation: f64,
    /// Column of the reference.
    pub reference: String,
    /// Column of the source.
    pub source: String,
}

/// Why there is no estimate; the texts end with what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)]
pub enum Refusal {
    #[error("too few samples overlap; record longer, or give the offset: {{ value = …, unit = \"s\" }}")]
    TooShort,
    #[error(
        "no columns move together: the best correlation of rates is {best:.2} (`{source_column}` and `{reference}`); name two columns of \
         the same quantity in `by`, or give the offset: {{ value = …, unit = \"s\" }}"
    )]
    Unrelated { best: f64, source_column: String, reference: String },
    #[error(
        "{} offsets are as likely: {}, from `{source_column}` and `{reference}`; say where it is: around = …, within = … (s; of one trial: \
         around = {{ trial = … }}), or give the offset", .offsets.len(), listed(.offsets)
    )]
    Ambiguous { offsets: Vec<(f64, f64)>, source_column: String, reference: String },
    #[error(
        "the offset of about {near:.3} s from `{source_column}` and `{reference}` does not converge below one sample; give the offset, or \
         name other columns in `by`"
    )]
    NotConverged { near: f64, source_column: String, reference: String },
}

/// `0.400 s (correlation 0.99), -2.742 s (-0.98) and 3 more`.
fn listed(offsets: &[(f64, f64)]) -> String {
    let one = |(i, (offset, correlation)): (usize, &(f64, f64))| {
        let what = if i == 0 { "correlation " } else { "" };
        format!("{offset:.3} s ({what}{correlation:.2})")
    };
    let named: Vec<String> = offsets.iter().take(NAMED).enumerate().map(one).collect();
    let more = offsets.len().saturating_sub(NAMED);
    named.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
}

/// One pair on its grid.
struct Coarse<'a> {
    reference: Named<'a>,
    source: Named<'a>,
    /// Offset with the most evidence, and those that are as likely.
    best: Peak,
    likely: Vec<Peak>,
    /// Offset of lag 0 and step of lags, s.
    zero: f64,
    step: f64,
}

/// Estimates the offset of a source from all pairs of columns.
///
/// # Errors
/// Nothing moves together, or several offsets are as likely.
pub fn estimate(references: &[Named], sources: &[Named], request: &Request) -> Result<Estimate, Refusal> {
    let clean = |all: &[Named]| -> Vec<(String, Series)> {
        all.iter().map(|(name, series)| (name.to_string(), series.without_outliers())).collect()
    };
    let (references, sources) = (clean(references), clean(sources));
    let pairs = references.iter().flat_map(|r| sources.iter().map(move |s| (r, s))).take(PAIRS);
    let coarse = pairs.map(|(r, s)| coarse((&r.0, &r.1), (&s.0, &s.1), request));
    let best = coarse.filter(|windows| !windows.is_empty()).max_by(|a, b| evidence(a).total_cmp(&evidence(b)));
    let windows = best.ok_or(Refusal::TooShort)?;
    let best = windows.iter().max_by(|a, b| a.evidence().total_cmp(&b.evidence())).ok_or(Refusal::TooShort)?;
    best.check()?;
    let near = best.offset(best.best.lag);
    let (reference, source) = (best.reference.0.to_string(), best.source.0.to_string());
    let origin = best.reference.1.span().ok_or(Refusal::TooShort)?.0 - near;
    let agree = |window: &&Coarse| (window.offset(window.best.lag) - near).abs() <= 2.0 * best.step;
    let clear = windows.iter().filter(|window| window.size() >= CLEAR.min(best.size())).filter(agree);
    let all: Vec<(Pair, Refined)> =
        clear.filter_map(|window| window.refine(near, request.drift, origin, best.step)).collect();
    let least = |a: &&(Pair, Refined), b: &&(Pair, Refined)| a.1.interval.total_cmp(&b.1.interval);
    let (_, refined) = all.iter().min_by(least).ok_or_else(|| Refusal::NotConverged {
        near,
        source_column: source.clone(),
        reference: reference.clone(),
    })?;
    // what is smaller than a hundredth of a sample is no longer known of clocks that count samples
    let floor = 0.01 * best.reference.1.step().max(best.source.1.step());
    let lag = largest_lag(&all, origin);
    let lagged = if lag.is_seen { lag.largest } else { 0.0 };
    Ok(Estimate {
        offset: refined.offset,
        interval: refined.interval.hypot(floor).hypot(disagreement(refined, &all)) + lagged,
        lag: (lag.largest, lag.is_seen),
        drift: refined.drift,
        drift_interval: refined.drift_interval,
        origin,
        correlation: best.best.correlation,
        reference,
        source,
    })
}

impl Coarse<'_> {
    fn size(&self) -> f64 {
        self.best.correlation.abs()
    }

    /// Evidence by the time that overlaps, so that grids of different steps can be compared.
    fn evidence(&self) -> f64 {
        self.best.evidence() * self.step
    }

    fn offset(&self, lag: i64) -> f64 {
        self.zero + self.step * lag as f64
    }

    /// Offset and drift below one sample, where they stay near.
    fn refine(&self, near: f64, drift: Option<f64>, origin: f64, step: f64) -> Option<(Pair<'_>, Refined)> {
        let pair = Pair { reference: self.reference.1, source: self.source.1, width: 2.0 * self.step };
        let refined = refine(&pair, near, drift.unwrap_or(0.0), drift.is_none(), origin);
        let near_enough = refined.filter(|r| (r.offset - near).abs() <= 2.0 * step && r.explained > 0.1);
        near_enough.map(|refined| (pair, refined))
    }

    fn check(&self) -> Result<(), Refusal> {
        let (best, source_column, reference) = (self.size(), self.source.0.to_string(), self.reference.0.to_string());
        if best < LOWEST {
            return Err(Refusal::Unrelated { best, source_column, reference });
        }
        if self.likely.len() < 2 {
            return Ok(());
        }
        let offsets = self.likely.iter().map(|peak| (self.offset(peak.lag), peak.correlation)).collect();
        Err(Refusal::Ambiguous { offsets, source_column, reference })
    }
}

/// The best peak, and the peaks that are as likely.
fn likely(peaks: &[Peak], same_quantity: bool) -> Option<(Peak, Vec<Peak>)> {
    let best = *peaks.first()?;
    let left = |peak: &Peak| 1.0 - peak.correlation.powi(2);
    let near = |peak: &&Peak| peak.correlation.abs() >= RIVAL * best.correlation.abs();
    let close = |peak: &&Peak| left(peak) < TELLING * left(&best).max(LEFT);
    let mut likely: Vec<Peak> = peaks.iter().filter(near).filter(close).copied().collect();
    likely.sort_by_key(|peak| same_quantity && peak.correlation < 0.0);
    Some((best, likely))
}

/// Distance of the mean of the windows' offsets, weighted by their precisions, from that of one of them, s.
fn disagreement(one: &Refined, all: &[(Pair, Refined)]) -> f64 {
    let weight = |window: &Refined| 1.0 / window.interval.powi(2).max(f64::MIN_POSITIVE);
    let weights: f64 = all.iter().map(|(_, window)| weight(window)).sum();
    let mean = all.iter().map(|(_, window)| weight(window) / weights * window.offset).sum::<f64>();
    (mean - one.offset).abs()
}

/// The most evidence.
fn evidence(windows: &[Coarse]) -> f64 {
    windows.iter().map(Coarse::evidence).fold(0.0, f64::max)
}

/// The correlation of a pair in windows of all widths.
fn coarse<'a>(reference: Named<'a>, source: Named<'a>, request: &Request) -> Vec<Coarse<'a>> {
    let slow = reference.1.step().max(source.1.step());
    if !(slow > 0.0) {
        return Vec::new();
    }
    let mut windows: Vec<Coarse> = Vec::new();
    for window in WIDTHS.iter().filter_map(|steps| in_window(reference, source, steps * slow, request)) {
        // long recordings have one step for several widths
        if windows.last().is_none_or(|last| last.step < window.step) {
            windows.push(window);
        }
    }
    windows
}

fn in_window<'a>(reference: Named<'a>, source: Named<'a>, width: f64, request: &Request) -> Option<Coarse<'a>> {
    let (r, s) = (reference.1.span()?, source.1.span()?);
    let lengths = (r.1 - r.0) * (s.1 - s.0);
    let step = (0.5 * width).max((lengths / PRODUCTS).sqrt()).max((r.1 - r.0).max(s.1 - s.0) / POINTS);
    if !step.is_finite() {
        return None;
    }
    let rates = |series: &Series, (from, to): (f64, f64)| -> Vec<f64> {
        let count = ((to - from) / step) as usize + 1;
        (0..count)
            .map(|k| local(series, from + step * k as f64, 2.0 * step).map_or(f64::NAN, |(_, rate)| rate))
            .collect()
    };
    let (rates_r, rates_s) = (rates(reference.1, r), rates(source.1, s));
    let zero = r.0 - s.0;
    let lag = |offset: f64| ((offset - zero) / step).round() as i64;
    let all = (-(rates_s.len() as i64), rates_r.len() as i64);
    let (from, to) = match request.around {
        Some((middle, within)) => (lag(middle - within).max(all.0), lag(middle + within).min(all.1)),
        None => all,
    };
    let fewest = (rates_r.len().min(rates_s.len()) / 2).max(20);
    let (best, likely) = likely(&correlate(&rates_r, &rates_s, from..=to, fewest), request.same_quantity)?;
    Some(Coarse { reference, source, best, likely, zero, step })
}
