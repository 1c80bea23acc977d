//! The 21 trials: held actuator, number of samples, time stamps.
//!
//! Trials 1–12 hover at four altitudes × three slices of q2; 13–16 carry the payload; 17–21 hang from a stand
//! with rotors off. 28,411 samples: 10,538 with rotors off and 17,873 in flight, as in the paper.

use super::excitation::Reciprocation;
use super::random::{Purpose, Seeds, between, happens, normal};
use super::rounding::round_to;
use super::settings::{MeasurementSettings, TwinSettings};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Kind of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Free hover.
    Hover,
    /// Hover with a payload at the tip.
    Payload,
    /// Hold on the stand, rotors off.
    RotorsOff,
}

/// One trial as planned: all recorded facts except the measurements.
#[derive(Clone, Debug)]
pub struct TrialPlan {
    /// Number of the trial, 1–21; it is also the trial's name.
    pub number: usize,
    /// Kind of trial.
    pub kind: Kind,
    /// Held value of q2, rad.
    pub held: f64,
    /// Altitude of the attachment, m.
    pub altitude: f64,
    /// Time stamps, s.
    pub times: Vec<f64>,
    /// Course of q1.
    pub course: Reciprocation,
    /// Wander of q2 about its held value, rad.
    pub wander: f64,
    /// Phase of that wander, rad.
    pub phase: f64,
}

/// Trials of a campaign, numbered from 1.
pub const TRIALS: usize = 21;

/// Trials at the altitude that is not in development.
pub const HELD_OUT: [usize; 3] = [10, 11, 12];

const HOVER_SAMPLES: [usize; 12] = [1223, 1219, 1221, 1224, 1217, 1226, 1220, 1218, 1222, 1225, 1216, 1219];
const PAYLOAD_SAMPLES: [usize; 4] = [806, 805, 806, 806];
const REST_SAMPLES: [usize; 5] = [2108, 2107, 2108, 2107, 2108];
/// Slices of q2 in flight, rad.
const SLICES: [f64; 3] = [0.0, 1.2, 2.8];
/// Slices of q2 with rotors off, rad.
const REST_SLICES: [f64; 5] = [0.0, 0.7, 1.2, 2.0, 2.8];

impl Kind {
    /// Returns the kind of a trial of the schedule, 1–21.
    pub fn of(number: usize) -> Kind {
        match number {
            1..=12 => Kind::Hover,
            13..=16 => Kind::Payload,
            _ => Kind::RotorsOff,
        }
    }
}

impl TrialPlan {
    /// Returns q1 and q2 at a time, rad.
    pub fn actuators(&self, time: f64) -> [f64; 2] {
        // One cycle in 17 s: the hand that holds the second stick is not quite still.
        let wander = self.wander * (std::f64::consts::TAU * time / 17.0 + self.phase).sin();
        [self.course.at(time), self.held + wander]
    }

    /// Returns the time of the last sample, s.
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }
}

/// Returns all 21 trials.
pub fn schedule(settings: &TwinSettings, seeds: &Seeds) -> Vec<TrialPlan> {
    (1..=TRIALS).map(|number| plan(settings, number, seeds)).collect()
}

/// Returns the altitude at which a trial is flown, m.
pub fn held_altitude(settings: &TwinSettings, number: usize) -> f64 {
    match number {
        1..=12 => settings.vehicle.altitudes[(number - 1) / 3],
        13..=16 => settings.vehicle.altitudes[number - 13],
        _ => settings.vehicle.stand,
    }
}

/// Returns one trial of the schedule, 1–21.
pub fn plan(settings: &TwinSettings, number: usize, seeds: &Seeds) -> TrialPlan {
    let excitation = &settings.excitation;
    let altitude = held_altitude(settings, number);
    let kind = Kind::of(number);
    let (samples, held) = match kind {
        Kind::Hover => (HOVER_SAMPLES[number - 1], SLICES[(number - 1) % 3]),
        Kind::Payload => (PAYLOAD_SAMPLES[number - 13], SLICES[(number - 13) % 3]),
        Kind::RotorsOff => (REST_SAMPLES[(number - 17) % 5], REST_SLICES[(number - 17) % 5]),
    };
    let (amplitude, wander) = match kind {
        Kind::RotorsOff => (excitation.calibration_amplitude, excitation.wander[0]),
        _ => (excitation.flight_amplitude, excitation.wander[1]),
    };
    let times = time_stamps(&settings.measurement, samples, &mut seeds.stream(number, Purpose::Clock));
    let mut hand = seeds.stream(number, Purpose::Excitation);
    let phase = std::f64::consts::TAU * hand.random::<f64>();
    let end = times.last().copied().unwrap_or(0.0);
    let course = Reciprocation::new(excitation, amplitude, -settings.measurement.preroll, end, &mut hand);
    TrialPlan { number, kind, held, altitude, times, course, wander, phase }
}

/// Returns the time stamps with jitter, lost frames and occlusions, s.
fn time_stamps(settings: &MeasurementSettings, count: usize, generator: &mut ChaCha8Rng) -> Vec<f64> {
    let mut time = 0.0;
    (0..count)
        .map(|_| {
            // Two stamps are never closer than 0.6 of the period: the camera needs its exposure.
            let elapsed = settings.period + settings.jitter * normal(generator);
            time += elapsed.max(0.6 * settings.period);
            if happens(generator, settings.drop) {
                time += settings.period * f64::from(generator.random_range(1..=5u32));
            }
            if happens(generator, settings.gap) {
                time += between(generator, settings.gap_time);
            }
            round_to(time, settings.decimals[0])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_those_of_the_paper() {
        let plans = schedule(&TwinSettings::default(), &Seeds::both(1));
        let count = |rest: bool| -> usize {
            plans.iter().filter(|plan| (plan.kind == Kind::RotorsOff) == rest).map(|plan| plan.times.len()).sum()
        };
        assert_eq!((count(true), count(false)), (10_538, 17_873));
    }

    #[test]
    fn clock_has_jitter_lost_frames_and_gaps_and_never_goes_back() {
        let plans = schedule(&TwinSettings::default(), &Seeds::both(1));
        let steps: Vec<f64> =
            plans.iter().flat_map(|plan| plan.times.windows(2).map(|pair| pair[1] - pair[0])).collect();
        assert!(steps.iter().all(|step| *step >= 0.06 - 1e-12 && *step < 7.0));
        let lost = steps.iter().filter(|step| **step > 0.15 && **step < 0.7).count();
        let gaps = steps.iter().filter(|step| **step > 1.0).count();
        assert!((100..250).contains(&lost) && (15..60).contains(&gaps), "{lost} lost, {gaps} gaps");
    }
}
