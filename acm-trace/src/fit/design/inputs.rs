//! Actuators of a trial after the effects that act before the map.

use std::borrow::Cow;
use std::sync::Arc;

use acm_core::clock_corrected;
use acm_core::record::Record;
use rayon::prelude::*;

use crate::fit::columns::{Key, Kind};
use crate::fit::problem::Problem;
use crate::fit::state::{Part, Placed, State};
use crate::series::Series;

/// Returns a trial's record with the clock of its actuators corrected.
pub fn record<'r>(problem: &'r Problem, state: &State, s: usize) -> Cow<'r, Record> {
    let record = &problem.series[s].record;
    if state.clock == 0.0 { Cow::Borrowed(record) } else { Cow::Owned(clock_corrected(record, state.clock)) }
}

/// Returns the effects of a kind that act in a trial.
pub fn acting<'s>(state: &'s State, series: &Series, part: Part) -> Vec<&'s Placed> {
    let acts = |placed: &&Placed| placed.acts_in(series.calibrates) && placed.part() == part;
    state.effects.iter().map(AsRef::as_ref).filter(acts).collect()
}

/// Returns the actuators after the input effects, all T samples.
pub fn inputs(problem: &Problem, state: &State, s: usize) -> Vec<Vec<f64>> {
    let record = record(problem, state, s);
    let chain = acting(state, &problem.series[s], Part::Input);
    let known = |done: usize| {
        let key = Key::together(Kind::Courses, s, &chain[..done], &[state.clock]);
        problem.columns.known(&key).map(|flat| (done, flat))
    };
    let (done, mut q) = match (1..=chain.len()).rev().find_map(known) {
        Some((done, flat)) => (done, flat.chunks(record.samples()).map(<[f64]>::to_vec).collect()),
        None => (0, record.actuators.clone()),
    };
    chain[done..].iter().for_each(|placed| placed.instance.act(&placed.theta, &record, &mut q));
    q
}

/// Caches the actuators after each of the first input effects.
pub fn keep_inputs(problem: &Problem, state: &State) {
    (0..problem.series.len()).into_par_iter().for_each(|s| {
        let record = record(problem, state, s);
        let chain = acting(state, &problem.series[s], Part::Input);
        let mut q = record.actuators.clone();
        for (done, placed) in chain.iter().enumerate() {
            placed.instance.act(&placed.theta, &record, &mut q);
            problem.columns.put(Key::together(Kind::Courses, s, &chain[..=done], &[state.clock]), Arc::new(q.concat()));
        }
    });
}

/// Returns each actuator at some rows, one after the other.
pub fn flattened(q: &[Vec<f64>], rows: &[usize]) -> Vec<f64> {
    q.iter().flat_map(|q| rows.iter().map(move |&row| q[row])).collect()
}
