//! Features of the recorded inputs for a linear regression, many of them with memory.
//!
//! | columns | of | number |
//! | --- | --- | --- |
//! | x, standardised | actuators, contexts, acceleration, time since the trial began | A + E + 4 |
//! | v, tanh(v / 0.3) | rates of the actuators, in units of their typical speed | 2A |
//! | x − lag_τ(x) | actuators and contexts, three τ between 4 steps and a sixth of a trial | 3 (A + E) |
//! | play_w(x) − x | actuators, w of 4 % and 12 % of the span | 2A |
//! | products | of pairs of x, and of x with v and tanh v | two fifths of the rest |
//! | sin, cos | of actuators, 1 to 8 periods over the span | a quarter of the rest |
//! | cos(wᵀx + b) | columns of the first four rows, w and b drawn | up to 100 |
//!
//! Rahimi & Recht (2007), NIPS 20 (random features).

use std::f64::consts::TAU;

use acm_core::effects::memory::{lag, play};
use acm_core::record::Record;
use nalgebra::DMatrix;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;

use crate::diagnose::random::normal;
use crate::diagnose::readout::Columns;
use crate::diagnose::remainder::Remainder;
use crate::diagnose::samples::{Sample, gather, median, median_step, moments, standardised};

/// Scale of tanh, as a share of the typical rate.
const SLOW: f64 = 0.3;

/// Half widths of the play, as a share of the span.
const PLAYS: [f64; 2] = [0.04, 0.12];

/// Periods of sine and cosine over the span of an actuator.
const TURNS: [f64; 6] = [1.0, 2.0, 3.0, 4.0, 6.0, 8.0];

/// Largest number of random cosines.
const MOST_COSINES: usize = 100;

/// Mean number of columns that a random cosine mixes; [`REACH`] is the spread of its weights.
const MIXED: f64 = 12.0;
const REACH: f64 = 0.35;

type Column = Vec<f64>;

/// Returns at most `most` columns at `samples`: products, sines, and random columns after the plain ones. Columns that
/// do not vary are left out.
pub(crate) fn features(remainder: &Remainder, samples: &[Sample], most: usize, seed: u64) -> Columns {
    let of = |column: &(dyn Fn(&Record) -> Column + Sync)| gather(remainder, samples, |trial| column(trial.record));
    let rig = remainder.rig;
    let actuators: Vec<Column> = (0..rig.actuators.len()).map(|a| of(&|r| r.actuators[a].clone())).collect();
    let contexts: Vec<Column> = (0..rig.contexts.len()).map(|e| of(&|r| r.contexts[e].clone())).collect();
    let signals: Vec<Column> = actuators.iter().chain(&contexts).filter_map(|column| standardised(column)).collect();
    let rates: Vec<Column> = (0..rig.actuators.len())
        .map(|a| of(&|r| r.actuator_rates[a].clone()))
        .filter_map(|rate| in_units_of_itself(&rate))
        .collect();
    let signs: Vec<Column> = rates.iter().map(|rate| rate.iter().map(|v| (v / SLOW).tanh()).collect()).collect();

    let mut columns = signals.clone();
    columns.extend(signs.iter().chain(&rates).cloned());
    columns.push(of(&|r| r.time.iter().map(|t| t - r.time[0]).collect()));
    columns.extend((0..3).map(|k| of(&|r| r.acceleration.get(k).cloned().unwrap_or_default())));
    columns.extend(memories(remainder, samples));
    let mut columns: Vec<Column> = columns.iter().filter_map(|column| standardised(column)).take(most).collect();

    let (plain, left) = (columns.len(), most - columns.len().min(most));
    columns.extend(products(&signals, &signs, &rates).take(left * 2 / 5));
    columns.extend(turns(&actuators).take(left / 4));
    let left = most - columns.len().min(most);
    let mut cosines = random_cosines(&columns[..plain], left.min(MOST_COSINES), seed);
    columns.append(&mut cosines);
    let columns: Vec<Column> = columns.par_iter().filter_map(|column| standardised(column)).collect();
    Columns { x: DMatrix::from_fn(samples.len(), columns.len(), |row, column| columns[column][row]), plain }
}

/// Divides a column by its root mean square; none where it is 0.
fn in_units_of_itself(column: &Column) -> Option<Column> {
    let (mean, sd) = moments(column);
    let size = mean.hypot(sd);
    (size > 0.0).then(|| column.iter().map(|x| x / size).collect())
}

/// Returns the columns with memory: lags and plays.
fn memories(remainder: &Remainder, samples: &[Sample]) -> Vec<Column> {
    let rig = remainder.rig;
    let times = remainder.trials.iter().map(|trial| trial.record.time.as_slice());
    let mut lengths: Vec<f64> = times.clone().filter_map(|time| Some(time.last()? - time.first()?)).collect();
    let (shortest, longest) = (4.0 * median_step(times), median(&mut lengths) / 6.0);
    let lagged = |x: &[f64], time: &[f64], tau: f64| {
        let mut behind = x.to_vec();
        lag(time, &mut behind, |_| tau);
        x.iter().zip(behind).map(|(x, behind)| x - behind).collect::<Column>()
    };
    let played = |x: &[f64], width: f64| {
        let mut held = x.to_vec();
        play(&mut held, |_| width);
        held.iter().zip(x).map(|(held, x)| held - x).collect::<Column>()
    };
    let of = |column: &(dyn Fn(&Record) -> Column + Sync)| gather(remainder, samples, |trial| column(trial.record));
    let mut columns = Vec::new();
    for (a, signal) in rig.actuators.iter().enumerate() {
        columns.extend(PLAYS.map(|share| of(&|r| played(&r.actuators[a], share * signal.span()))));
    }
    let taus = [shortest, (shortest * longest).sqrt(), longest].into_iter().filter(|tau| *tau > 0.0);
    for tau in taus {
        columns.extend((0..rig.actuators.len()).map(|a| of(&|r| lagged(&r.actuators[a], &r.time, tau))));
        columns.extend((0..rig.contexts.len()).map(|e| of(&|r| lagged(&r.contexts[e], &r.time, tau))));
    }
    columns
}

/// Returns the products of pairs of signals, of a signal with the sign of a rate, and of a signal with a rate.
fn products<'a>(
    signals: &'a [Column],
    signs: &'a [Column],
    rates: &'a [Column],
) -> impl Iterator<Item = Column> + use<'a> {
    let pairs = (0..signals.len()).flat_map(|i| (i..signals.len()).map(move |j| (i, j)));
    let own = signs.iter().zip(rates);
    let with = |others: &'a [Column]| signals.iter().flat_map(move |x| others.iter().map(move |y| (x, y)));
    pairs
        .map(|(i, j)| (&signals[i], &signals[j]))
        .chain(own)
        .chain(with(signs))
        .chain(with(rates))
        .map(|(x, y)| x.iter().zip(y).map(|(x, y)| x * y).collect())
}

/// Returns sines and cosines over the span of each actuator, slow ones first.
fn turns(actuators: &[Column]) -> impl Iterator<Item = Column> {
    let spans = actuators.iter().map(|x| {
        let (low, high) = x.iter().fold((f64::MAX, f64::MIN), |(low, high), &x| (low.min(x), high.max(x)));
        (x, TAU / (high - low).max(f64::MIN_POSITIVE))
    });
    let moving: Vec<(&Column, f64)> = spans.filter(|(_, turn)| turn.is_finite()).collect();
    TURNS.into_iter().flat_map(move |turns| {
        let waves: Vec<Column> = moving
            .iter()
            .flat_map(|(x, turn)| {
                let wave = |of: fn(f64) -> f64| x.iter().map(|x| of(turns * turn * x)).collect::<Column>();
                [wave(f64::sin), wave(f64::cos)]
            })
            .collect();
        waves
    })
}

fn random_cosines(base: &[Column], count: usize, seed: u64) -> Vec<Column> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let share = (MIXED / base.len().max(1) as f64).min(1.0);
    let drawn: Vec<(Vec<(usize, f64)>, f64)> = (0..count)
        .map(|_| {
            let mut weights = Vec::new();
            for column in 0..base.len() {
                let weight = REACH * normal(&mut random);
                if random.random_range(0.0..1.0) < share {
                    weights.push((column, weight));
                }
            }
            (weights, random.random_range(0.0..TAU))
        })
        .collect();
    let rows = base.first().map_or(0, Vec::len);
    drawn
        .par_iter()
        .map(|(weights, phase)| {
            let mut sum = vec![*phase; rows];
            for &(column, weight) in weights {
                sum.iter_mut().zip(&base[column]).for_each(|(sum, x)| *sum += weight * x);
            }
            sum.into_iter().map(f64::cos).collect()
        })
        .collect()
}
