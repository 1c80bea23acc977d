//! Effects that see a trial piece by piece do what they do to the whole of it.

use std::f64::consts::TAU;

use acm_core::effects::instance::{Instance, Running};
use acm_core::effects::{Memory, Values};
use acm_core::record::Record;

use crate::rigs::{Case, Scene, all, cases};
use crate::{difference, looks_ahead};

/// The samples `rows`, whose rates of change are those of `whole`.
fn piece(whole: &Record, rows: std::ops::Range<usize>) -> Record {
    whole.select(&rows.collect::<Vec<usize>>())
}

fn cut(columns: &[Vec<f64>], rows: std::ops::Range<usize>) -> Vec<Vec<f64>> {
    columns.iter().map(|column| column[rows.clone()].to_vec()).collect()
}

/// The record of the first `samples`, as it would have been written then.
fn until(case: &Case, samples: usize) -> Record {
    let Record { time, actuators, contexts, acceleration, .. } = &case.scene.record;
    let cut = |columns: &[Vec<f64>]| cut(columns, 0..samples);
    Record::new(time[..samples].to_vec(), cut(actuators), cut(contexts), cut(acceleration))
}

fn varying<'a>(case: &'a Case, start: &'a [f64], slopes: &'a [f64], context: &'a [f64]) -> Values<'a> {
    Values::varying(&case.specs, start, slopes, context)
}

/// Slopes by which each size changes a little with a context of −1 to 1.
fn slopes(case: &Case) -> Vec<f64> {
    case.specs.iter().map(|spec| if spec.may_vary { 0.2 * spec.scale } else { 0.0 }).collect()
}

/// What the effect makes of each sample as it comes, when rates of change are those known by then.
fn online(case: &Case, start: &[f64], context: &[f64], samples: usize) -> Vec<Vec<f64>> {
    let (slopes, columns, mut memory) = (slopes(case), case.columns(), Memory::default());
    let mut acted = vec![vec![]; columns.len()];
    for t in 0..samples {
        let known = until(case, t + 1);
        let mut now = cut(&columns, t..t + 1);
        let values = varying(case, start, &slopes, &context[t..=t]);
        case.effect.proceed(case.carrier, values, &piece(&known, t..t + 1), &mut memory, &mut now);
        acted.iter_mut().zip(now).for_each(|(acted, now)| acted.extend(now));
    }
    acted
}

fn context(samples: usize) -> Vec<f64> {
    (0..samples).map(|t| (0.11 * t as f64).sin()).collect()
}

/// Enough samples for several turns, and for delays to fill.
const SAMPLES: usize = 120;

/// Oracle: the effect on a record that ends at the sample. The same bits.
#[test]
fn a_sample_is_what_it_would_be_at_the_end_of_a_record() {
    // Derivatives of a record come from other windows than those of a stream.
    let is_derived = |case: &&Case| case.specs.iter().any(|spec| spec.name == "window");
    for case in cases(&all()).iter().filter(|case| !is_derived(case)) {
        let samples = case.scene.record.samples().min(SAMPLES);
        let (slopes, context) = (slopes(case), context(samples));
        for start in &case.starts {
            let found = online(case, start, &context, samples);
            for t in (0..samples).step_by(7) {
                let mut whole = cut(&case.columns(), 0..t + 1);
                let values = varying(case, start, &slopes, &context[..=t]);
                case.effect.act(case.carrier, values, &until(case, t + 1), &mut whole);
                let same = found.iter().zip(&whole).all(|(found, whole)| found[t].to_bits() == whole[t].to_bits());
                assert!(same, "{} at sample {t} of {start:?}", case.label());
            }
        }
    }
}

/// Oracle: the effect on the whole trial, of which it sees nothing ahead. The same bits, in pieces of any length.
#[test]
fn pieces_make_the_whole() {
    for case in cases(&all()).iter().filter(|case| looks_ahead(case, &case.neutral()) == 0) {
        let (record, samples) = (&case.scene.record, case.scene.record.samples());
        let (slopes, context) = (slopes(case), context(samples));
        for start in &case.starts {
            let mut whole = case.columns();
            case.effect.act(case.carrier, varying(case, start, &slopes, &context), record, &mut whole);
            for length in [1, 5, 64] {
                let mut memory = Memory::default();
                for first in (0..samples).step_by(length) {
                    let rows = first..samples.min(first + length);
                    let mut now = cut(&case.columns(), rows.clone());
                    let values = varying(case, start, &slopes, &context[rows.clone()]);
                    case.effect.proceed(case.carrier, values, &piece(record, rows.clone()), &mut memory, &mut now);
                    assert!(now == cut(&whole, rows), "{} in pieces of {length}: {start:?}", case.label());
                }
            }
        }
    }
}

/// Of a second trial nothing of the first is remembered.
#[test]
fn a_restart_is_a_beginning() {
    for case in cases(&all()) {
        let instance = Instance::new(case.effect, case.carrier, &case.scene.rig);
        for start in &case.starts {
            let mut running = Running::new(&instance, start);
            let mut acted = || {
                let mut all = vec![];
                for t in 0..case.scene.record.samples().min(20) {
                    let mut now = cut(&case.columns(), t..t + 1);
                    running.proceed(&piece(&case.scene.record, t..t + 1), &mut now);
                    all.push(now);
                }
                running.restart();
                all
            };
            assert!(acted() == acted(), "{}", case.label());
        }
    }
}

/// Oracle: the effect on the whole trial. Without the samples to come, a rate of change is late by about half of them, so signals that move slowly are acted on nearly alike. Time stamps are irregular.
#[test]
fn rates_of_change_are_late_by_a_sample() {
    for mut scene in all() {
        slow_down(&mut scene);
        let samples = scene.record.samples();
        let sample = TAU * PERIODS / samples as f64;
        if sample > 0.3 {
            continue;
        }
        let scenes = [scene];
        // Dry friction is no multiple of a rate.
        let is_dry = |case: &&Case| ["coulomb_friction", "stribeck_friction"].contains(&case.effect.name());
        let late = |case: &&Case| looks_ahead(case, &case.neutral()) > 0 && !is_dry(case);
        for case in cases(&scenes).iter().filter(late) {
            let (context, before) = (vec![0.0; samples], case.columns());
            for start in &case.starts {
                let late = sample * (looks_ahead(case, start) / 2) as f64;
                let share = |acted: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
                    let pairs = acted.iter().zip(&before);
                    pairs.map(|(a, b)| (5..samples - 5).map(|t| a[t] - b[t]).collect()).collect()
                };
                let off = difference(&share(online(case, start, &context, samples)), &share(case.act(start)));
                assert!(off < 2.5 * late, "{}: off by {off:.3} of its size, {late:.3} are due", case.label());
            }
        }
    }
}

const PERIODS: f64 = 5.0;

/// Every signal becomes a sine over its range. A rate that is late by one of n samples to a period is off by 2π/n.
fn slow_down(scene: &mut Scene) {
    let time = scene.record.time.clone();
    let whole = time[time.len() - 1] - time[0];
    let slow = |column: &Vec<f64>| -> Vec<f64> {
        let (low, high) = column.iter().fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(*x), h.max(*x)));
        let wave = |t: &f64| 0.5 * (1.0 + ((t - time[0]) / whole * PERIODS * TAU + column[0]).sin());
        time.iter().map(|t| low + (high - low) * wave(t)).collect()
    };
    let all = |columns: &[Vec<f64>]| columns.iter().map(slow).collect::<Vec<_>>();
    let Record { actuators, contexts, acceleration, .. } = &scene.record;
    let record = Record::new(time.clone(), all(actuators), all(contexts), all(acceleration));
    (scene.outputs, scene.record) = (all(&scene.outputs), record);
}
