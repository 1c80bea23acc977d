//! Recorded vectors: generated samples, and the estimator's answers to them.
//!
//! Inputs run through the ranges of training, on irregular steps with gaps. Some leave the ranges, and some the network does not
//! see. The same parts and count give the same bits.

use acm_stream::{Average, AverageParts, Estimator, Nominal, Parts, Source, StateRule, StepError};

use crate::ExportError;

/// One sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Inputs in the order of [`Parts`], SI.
    pub inputs: Vec<f64>,
    /// Time since the previous sample, s.
    pub elapsed: f64,
    /// Whether the network processes the sample.
    pub seen: bool,
}

/// Answer of the estimator.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Answer of the estimator, SI.
    pub tip: Vec<f64>,
    /// Answer of the nominal model alone, SI.
    pub nominal: Vec<f64>,
    /// Whether the channels were in their training ranges; see [`Estimator::in_range`].
    pub in_range: Option<bool>,
}

/// Period of gaps in samples; [`UNSEEN`] is the period of samples that the network does not process.
const GAP: usize = 37;
const UNSEEN: usize = 11;

/// Longest gap in steps that is tried; a longer one counts as none.
const LONG: f64 = 1e6;

/// Returns `count` samples: sums of two waves through each input's range, steps of half to one and a half times the
/// usual one.
pub fn samples(parts: &Parts, count: usize) -> Vec<Sample> {
    samples_of_average(&AverageParts::of_one(parts.clone()), count)
}

/// Returns samples of an average: its usual step is the shortest of its members, and each gap is one for all of them.
pub fn samples_of_average(average: &AverageParts, count: usize) -> Vec<Sample> {
    let ranges = ranges_of_average(average);
    let of = |value: fn(&Parts) -> f64, best: fn(f64, f64) -> f64| {
        average.members.iter().map(|member| value(&member.parts)).reduce(best).unwrap_or(1.0)
    };
    let step = of(|parts| parts.first_elapsed.min(0.6 * parts.max_gap), f64::min);
    // A model without a network has no gap: a very long step stands for it.
    let pause = of(|parts| if parts.has_network() { 2.5 * parts.max_gap } else { 0.0 }, f64::max);
    let pause = if pause > 0.0 && pause < LONG * step { pause } else { 20.0 * step };
    let mut time = 0.0;
    let at = |k: usize| {
        let kf = k as f64;
        let gap = k > 0 && k % GAP == 0;
        let elapsed = if gap { pause } else { step * (1.0 + 0.5 * (2.3 * kf).sin()) };
        time += elapsed;
        let phase = time / step;
        let wave = |j: usize| {
            let own = 1.0 + 0.37 * j as f64;
            0.7 * (0.11 * own * phase).sin() + 0.4 * (0.043 * own * phase + j as f64).cos()
        };
        let input = |(j, (low, high)): (usize, &(f64, f64))| 0.5 * (low + high) + 0.5 * (high - low) * wave(j);
        Sample { inputs: ranges.iter().enumerate().map(input).collect(), elapsed, seen: k % UNSEEN != UNSEEN - 1 }
    };
    (0..count).map(at).collect()
}

/// Returns the answers of acm-stream to `samples`, as a new trial.
///
/// # Errors
/// Parts that make no estimator, or that lead beyond what numbers hold.
pub fn answers(parts: &Parts, samples: &[Sample]) -> Result<Vec<Answer>, ExportError> {
    let mut estimator = Estimator::new(parts.clone())?;
    each(samples, |inputs, elapsed, seen| {
        let answer = if seen { estimator.step(inputs, elapsed) } else { estimator.step_unseen(inputs, elapsed) };
        let tip = answer?.to_vec();
        Ok(Answer { tip, nominal: estimator.nominal().to_vec(), in_range: estimator.in_range() })
    })
}

/// Returns the answers of an average to `samples`, as [`answers`].
///
/// # Errors
/// As [`answers`].
pub fn answers_of_average(average: &AverageParts, samples: &[Sample]) -> Result<Vec<Answer>, ExportError> {
    let mut mean = Average::new(average.clone())?;
    each(samples, |inputs, elapsed, seen| {
        let answer = if seen { mean.step(inputs, elapsed) } else { mean.step_unseen(inputs, elapsed) };
        let tip = answer?.to_vec();
        Ok(Answer { tip, nominal: mean.nominal().to_vec(), in_range: mean.in_range() })
    })
}

fn each(
    samples: &[Sample],
    mut answer: impl FnMut(&[f64], f64, bool) -> Result<Answer, StepError>,
) -> Result<Vec<Answer>, ExportError> {
    let one = |(k, Sample { inputs, elapsed, seen }): (usize, &Sample)| {
        answer(inputs, *elapsed, *seen).map_err(|error| ExportError::Rehearsal { sample: k, error })
    };
    samples.iter().enumerate().map(one).collect()
}

/// Returns the root mean square of each output over the answers.
pub fn rms(answers: &[Answer]) -> Vec<f64> {
    let outputs = answers.first().map_or(0, |answer| answer.tip.len());
    let square = |o: usize| answers.iter().map(|answer| answer.tip[o].powi(2)).sum::<f64>() / answers.len() as f64;
    (0..outputs).map(|o| square(o).sqrt()).collect()
}

/// Returns the smallest and largest value of each input of an average: those of the first member that reads it.
fn ranges_of_average(average: &AverageParts) -> Vec<(f64, f64)> {
    let mut all = vec![(-1.0, 1.0); average.inputs.len()];
    for member in average.members.iter().rev() {
        member.places.iter().zip(ranges(&member.parts)).for_each(|(place, range)| all[*place] = range);
    }
    all
}

/// Returns the smallest and largest value of each input: of its channel, or of the rig's known range.
fn ranges(parts: &Parts) -> Vec<(f64, f64)> {
    let (actuators, contexts) = (parts.signals.actuators.len(), parts.signals.contexts.len());
    let mut all: Vec<(f64, f64)> = vec![(-1.0, 1.0); actuators + contexts];
    if let Nominal::Augmented(model) = &parts.nominal {
        let signals = model.rig().actuators.iter().chain(&model.rig().contexts);
        all.iter_mut().zip(signals).for_each(|(range, signal)| *range = (signal.low, signal.high));
    }
    let learned = parts.has_network();
    for (c, channel) in parts.channels.iter().enumerate().filter(|(_, channel)| learned && !channel.rate) {
        let place = match channel.source {
            Source::Actuator(a) => a,
            Source::Context(e) => actuators + e,
        };
        let (mean, spread) = (parts.inputs.mean[c], parts.inputs.spread[c]);
        let trained = parts.ranges.as_ref().map(|ranges| (ranges[c].low, ranges[c].high));
        all[place] = trained.unwrap_or((mean - 2.0 * spread, mean + 2.0 * spread));
    }
    let predicted = parts.targets.spread.first().map_or(1.0, |spread| 10.0 * spread);
    all.extend(vec![(-1.5, 1.5); parts.nominal.acceleration()]);
    all.extend(vec![(-predicted, predicted); parts.nominal.predicted()]);
    all
}

/// One step of the network alone.
#[derive(Debug, Clone, PartialEq)]
pub struct NetworkStep {
    /// Channels, SI.
    pub channels: Vec<f64>,
    /// Elapsed time that the network receives since the previous step, s.
    pub elapsed: f64,
    /// Whether the state is zero before the step.
    pub begins: bool,
    /// Residual that the estimator adds to the nominal model, SI.
    pub residual: Vec<f64>,
}

/// Steps of the network, and the root mean square of each of the estimator's outputs over them.
#[derive(Debug, Clone, PartialEq)]
pub struct Vectors {
    /// Steps of the network, in order.
    pub steps: Vec<NetworkStep>,
    /// Root mean square of each output of nominal model and network, SI.
    pub rms: Vec<f64>,
}

/// Records steps of the estimator's network on [`samples`], with a running state.
///
/// # Errors
/// As [`answers`].
pub fn steps(parts: &Parts, count: usize) -> Result<Vectors, ExportError> {
    let parts = Parts { state: StateRule::Running, ..parts.clone() };
    let samples: Vec<Sample> = samples(&parts, count).into_iter().map(|s| Sample { seen: true, ..s }).collect();
    let answers = answers(&parts, &samples)?;
    let actuators = parts.signals.actuators.len();
    let mut before: Option<&Sample> = None;
    let mut steps = Vec::with_capacity(count);
    for (sample, answer) in samples.iter().zip(&answers) {
        let last = before.filter(|_| sample.elapsed <= parts.max_gap);
        let channel = |channel: &acm_stream::Channel| {
            let place = match channel.source {
                Source::Actuator(a) => a,
                Source::Context(e) => actuators + e,
            };
            match (channel.rate, last) {
                (false, _) => sample.inputs[place],
                (true, None) => 0.0,
                (true, Some(last)) => (sample.inputs[place] - last.inputs[place]) / sample.elapsed,
            }
        };
        steps.push(NetworkStep {
            channels: parts.channels.iter().map(channel).collect(),
            elapsed: if last.is_some() { sample.elapsed } else { parts.first_elapsed },
            begins: last.is_none(),
            residual: answer.tip.iter().zip(&answer.nominal).map(|(tip, nominal)| tip - nominal).collect(),
        });
        before = Some(sample);
    }
    Ok(Vectors { steps, rms: rms(&answers) })
}
