//! Resampling of a series: interpolated, held or unchanged; never across a gap.
//!
//! | rule | value at t |
//! | --- | --- |
//! | `linear` | between the samples before and after; of a series that is sampled faster than it is asked for, after a low-pass |
//! | `previous` | the previous sample |
//! | `none` | the sample at t itself, to a tenth of a step |
//!
//! Low-pass, for going to the step T (zero phase, irregular samples u_k with spacing d_k):
//!
//! ```text
//! x(t) = l(t) + Σ_k h(u_k − t)·d_k·(x_k − l(u_k)) / Σ_k h(u_k − t)·d_k,      h(u) = sinc(2·f·u)·cos²(π·u/(2·H)),  |u| < H
//! f = 0.375/T,   H = 8·T, less near an end or a gap;     l: least-squares line of the window
//! ```
//!
//! Half of T's Nyquist frequency passes, and from that frequency on −40 dB or less is left. Angles are unwrapped before;
//! quaternions go along great circles (Shoemake 1985, SIGGRAPH 19(3)).

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::series::Series;

/// How a source is brought to the reference's samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rule {
    /// Straight lines, with a low-pass where the reference is slower.
    #[default]
    Linear,
    /// The last sample before.
    Previous,
    /// The sample at that time, or nothing.
    None,
}

/// At what times, and how far apart samples may be.
pub struct Onto<'a> {
    /// Times on the series' own clock `[T]`, s, increasing.
    pub times: &'a [f64],
    /// Step of the reference on the series' clock, s.
    pub step: f64,
    /// A longer distance of samples is a gap, s.
    pub gap: f64,
    /// How.
    pub rule: Rule,
}

/// A series that is faster than this share of the step is filtered.
const FASTER: f64 = 0.75;

/// Values at the times `[T]`; NaN in gaps and beyond the ends.
pub fn resample(series: &Series, onto: &Onto) -> Vec<f64> {
    let filtered = onto.rule == Rule::Linear && series.step() < FASTER * onto.step;
    onto.times
        .iter()
        .map(|t| match onto.rule {
            Rule::Linear if filtered => low_pass(series, *t, onto),
            Rule::Linear => linear(series, *t, onto.gap),
            Rule::Previous => previous(series, *t, onto.gap),
            Rule::None => itself(series, *t, 0.1 * onto.step),
        })
        .collect()
}

/// The samples before and after, or both at t; none where they are a gap apart.
fn around(series: &Series, t: f64, gap: f64) -> Option<(usize, usize)> {
    let after = series.from(t);
    if series.time.get(after) == Some(&t) {
        return Some((after, after));
    }
    let before = after.checked_sub(1)?;
    (series.time.get(after)? - series.time[before] <= gap).then_some((before, after))
}

fn share(series: &Series, t: f64, before: usize, after: usize) -> f64 {
    if before == after { 0.0 } else { (t - series.time[before]) / (series.time[after] - series.time[before]) }
}

fn linear(series: &Series, t: f64, gap: f64) -> f64 {
    let Some((before, after)) = around(series, t, gap) else { return f64::NAN };
    let share = share(series, t, before, after);
    series.values[before] * (1.0 - share) + series.values[after] * share
}

fn previous(series: &Series, t: f64, gap: f64) -> f64 {
    let count = series.time.partition_point(|u| *u <= t);
    let last = count.checked_sub(1).filter(|k| t - series.time[*k] <= gap);
    last.map_or(f64::NAN, |k| series.values[k])
}

fn itself(series: &Series, t: f64, near: f64) -> f64 {
    let after = series.from(t);
    let candidates = [after.checked_sub(1), Some(after)].into_iter().flatten().filter(|k| *k < series.time.len());
    let nearest = candidates.min_by(|a, b| (series.time[*a] - t).abs().total_cmp(&(series.time[*b] - t).abs()));
    nearest.filter(|k| (series.time[*k] - t).abs() <= near).map_or(f64::NAN, |k| series.values[k])
}

fn low_pass(series: &Series, t: f64, onto: &Onto) -> f64 {
    let Some((before, after)) = around(series, t, onto.gap) else { return f64::NAN };
    let half = reach(series, t, before, after, onto);
    let (start, end) = (series.from(t - half), series.from(t + half));
    if end.saturating_sub(start) < 4 {
        return linear(series, t, onto.gap);
    }
    let (level, slope) = line(&series.time[start..end], &series.values[start..end], t);
    let f = 0.375 / onto.step;
    let (mut sum, mut weights) = (0.0, 0.0);
    for k in start..end {
        let u = series.time[k] - t;
        let spacing = series.time[(k + 1).min(end - 1)] - series.time[k.saturating_sub(1).max(start)];
        let x = 2.0 * f * u;
        let sinc = if x == 0.0 { 1.0 } else { (PI * x).sin() / (PI * x) };
        let h = sinc * (PI * u / (2.0 * half)).cos().powi(2) * spacing;
        sum += h * (series.values[k] - level - slope * u);
        weights += h;
    }
    level + sum / weights
}

/// Half-width of the window: up to the nearest end or gap.
fn reach(series: &Series, t: f64, before: usize, after: usize, onto: &Onto) -> f64 {
    let full = 8.0 * onto.step;
    let mut back = before;
    while back > 0 && t - series.time[back] < full && series.time[back] - series.time[back - 1] <= onto.gap {
        back -= 1;
    }
    let mut ahead = after;
    let last = series.time.len() - 1;
    while ahead < last && series.time[ahead] - t < full && series.time[ahead + 1] - series.time[ahead] <= onto.gap {
        ahead += 1;
    }
    full.min(t - series.time[back]).min(series.time[ahead] - t)
}

/// Least-squares line: its value at t, and its slope.
fn line(time: &[f64], values: &[f64], t: f64) -> (f64, f64) {
    let count = time.len() as f64;
    let (middle, mean) = (time.iter().map(|u| u - t).sum::<f64>() / count, values.iter().sum::<f64>() / count);
    let (mut xx, mut xy) = (0.0, 0.0);
    for (u, value) in time.iter().zip(values) {
        let x = u - t - middle;
        xx += x * x;
        xy += x * (value - mean);
    }
    let slope = if xx > 0.0 { xy / xx } else { 0.0 };
    (mean - slope * middle, slope)
}

/// Quaternions `[4][T]` at other times, of unit length, on the shorter of two ways.
pub fn slerp(parts: &[Series; 4], onto: &Onto) -> [Vec<f64>; 4] {
    let mut all: [Vec<f64>; 4] = std::array::from_fn(|_| Vec::with_capacity(onto.times.len()));
    for t in onto.times {
        let found = match onto.rule {
            Rule::Linear => {
                around(&parts[0], *t, onto.gap).and_then(|(a, b)| between(parts, a, b, share(&parts[0], *t, a, b)))
            }
            Rule::Previous => Some(parts.each_ref().map(|part| previous(part, *t, onto.gap))),
            Rule::None => Some(parts.each_ref().map(|part| itself(part, *t, 0.1 * onto.step))),
        };
        let found = found.unwrap_or([f64::NAN; 4]);
        all.iter_mut().zip(found).for_each(|(values, value)| values.push(value));
    }
    all
}

/// `q_a·sin((1 − s)·φ)/sin φ ± q_b·sin(s·φ)/sin φ`, both scaled to unit length.
fn between(parts: &[Series; 4], a: usize, b: usize, share: f64) -> Option<[f64; 4]> {
    let unit = |k: usize| -> Option<[f64; 4]> {
        let q: [f64; 4] = std::array::from_fn(|i| parts[i].values.get(k).copied().unwrap_or(f64::NAN));
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        (length > 0.0).then(|| q.map(|x| x / length))
    };
    let (p, q) = (unit(a)?, unit(b)?);
    let dot: f64 = p.iter().zip(&q).map(|(x, y)| x * y).sum();
    let (sign, angle) = (if dot < 0.0 { -1.0 } else { 1.0 }, dot.abs().min(1.0).acos());
    let (first, second) = match angle < 1e-6 {
        true => (1.0 - share, share),
        false => (((1.0 - share) * angle).sin() / angle.sin(), (share * angle).sin() / angle.sin()),
    };
    Some(std::array::from_fn(|i| first * p[i] + sign * second * q[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(frequency: f64, rate: f64, seconds: f64) -> Series {
        // irregular by a tenth of a step
        let time: Vec<f64> =
            (0..(rate * seconds) as u32).map(|k| (f64::from(k) + 0.1 * f64::from(k * 7 % 5)) / rate).collect();
        let values: Vec<f64> = time.iter().map(|t| (2.0 * PI * frequency * t).sin()).collect();
        Series { time, values }
    }

    fn times(rate: f64) -> Vec<f64> {
        (0..(8.0 * rate) as u32).map(|k| 1.0 + f64::from(k) / rate).collect()
    }

    /// Oracle: the sine itself. At 20 Hz, 4 Hz passes and 16 Hz would appear as 4 Hz.
    #[test]
    fn a_low_pass_keeps_what_the_slower_clock_can_hold_and_nothing_else() {
        let times = times(20.0);
        let onto = Onto { times: &times, step: 0.05, gap: 0.1, rule: Rule::Linear };
        let error = |frequency: f64, expected: f64| {
            let found = resample(&wave(frequency, 500.0, 10.0), &onto);
            let wrong = found.iter().zip(&times).map(|(x, t)| x - expected * (2.0 * PI * frequency * t).sin());
            wrong.map(f64::abs).fold(0.0, f64::max)
        };
        assert!(error(4.0, 1.0) < 0.01, "{}", error(4.0, 1.0));
        assert!(error(16.0, 0.0) < 0.02, "{}", error(16.0, 0.0));
        let line = Series { time: wave(1.0, 500.0, 10.0).time, values: wave(1.0, 500.0, 10.0).time };
        assert!(resample(&line, &onto).iter().zip(&times).all(|(x, t)| (x - t).abs() < 1e-9), "a line stays itself");
    }

    /// Oracle: by hand.
    #[test]
    fn gaps_stay_gaps_and_rules_differ() {
        let series = Series { time: vec![0.0, 1.0, 2.0, 6.0], values: vec![0.0, 10.0, 20.0, 60.0] };
        let times = [-0.5, 0.0, 0.25, 1.5, 3.0, 6.0, 6.5];
        let at = |rule| {
            let found = resample(&series, &Onto { times: &times, step: 0.5, gap: 1.5, rule });
            found.iter().map(|x| if x.is_nan() { -1.0 } else { *x }).collect::<Vec<_>>()
        };
        assert_eq!(at(Rule::Linear), [-1.0, 0.0, 2.5, 15.0, -1.0, 60.0, -1.0]);
        assert_eq!(at(Rule::Previous), [-1.0, 0.0, 0.0, 10.0, 20.0, 60.0, 60.0]);
        assert_eq!(at(Rule::None), [-1.0, 0.0, -1.0, -1.0, -1.0, 60.0, -1.0]);
    }

    /// Oracle: by hand; a turn about one axis at a constant rate, whose signs flip.
    #[test]
    fn quaternions_do_not_jump() {
        let half = |t: f64| 0.5 * 1.2 * t;
        let time: Vec<f64> = (0..10).map(f64::from).collect();
        let flip = |t: f64| if t as u32 % 2 == 1 { -1.0 } else { 1.0 };
        let part = |f: &dyn Fn(f64) -> f64| Series {
            time: time.clone(),
            values: time.iter().map(|t| flip(*t) * f(*t)).collect(),
        };
        let parts = [part(&|t| half(t).cos()), part(&|t| half(t).sin()), part(&|_| 0.0), part(&|_| 0.0)];
        let times = [0.25, 3.5, 7.75];
        let found = slerp(&parts, &Onto { times: &times, step: 1.0, gap: 1.5, rule: Rule::Linear });
        for (k, t) in times.iter().enumerate() {
            let sign = (found[0][k] * half(*t).cos() + found[1][k] * half(*t).sin()).signum();
            assert!((sign * found[0][k] - half(*t).cos()).abs() < 1e-12, "{t}");
            assert!((sign * found[1][k] - half(*t).sin()).abs() < 1e-12, "{t}");
        }
    }
}
