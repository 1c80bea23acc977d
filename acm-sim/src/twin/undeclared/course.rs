//! Inputs of a trial on a fine time grid: actuators, throttle, altitude and position of the vehicle.
//!
//! The grid starts before the first sample, so that what has a memory has a past. Between grid points every signal is
//! straight. A grid of 0.01 s is a tenth of the period of the camera: what an effect makes of a signal between two
//! samples is then resolved.

use super::super::excitation::Reciprocation;
use super::super::random::{Gusts, Purpose, Seeds, between, happens, normal};
use super::super::settings::{ExcitationSettings, MeasurementSettings};
use super::design::{Design, Plan};
use crate::role::Role;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// Step of the grid, s.
pub const STEP: f64 = 0.01;
/// Time before the first sample, s.
pub const PREROLL: f64 = 12.0;
/// Time stamp after which no sample is taken, s.
pub const DURATION: f64 = 50.0;
/// Steps of the grid, with a second to spare.
const STEPS: usize = ((PREROLL + DURATION + 1.0) / STEP) as usize;

/// Throttle that carries the vehicle far from the ground, 1.
const HOVER: f64 = 0.62;

/// The signals of one trial on the grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// Number of the trial.
    pub number: usize,
    /// Role of the trial.
    pub role: Role,
    /// Time stamps of the samples, s.
    pub times: Vec<f64>,
    /// Actuator angles as the encoders read them, rad.
    pub actuators: [Vec<f64>; 2],
    /// Throttle, 1.
    pub throttle: Vec<f64>,
    /// Altitude of the attachment, m.
    pub altitude: Vec<f64>,
    /// Horizontal position of the vehicle, m.
    pub place: [Vec<f64>; 2],
    /// Horizontal acceleration of the vehicle, m/s².
    pub acceleration: [Vec<f64>; 2],
}

impl Course {
    /// Simulates the motion of one trial, flying or parked.
    pub fn new(design: Design, plan: &Plan, seeds: &Seeds) -> Self {
        let parked = plan.role == Role::Calibration;
        let mut generator = seeds.stream(plan.number, Purpose::Flight);
        let (throttle, altitude, place) = if parked {
            (vec![0.0; STEPS], vec![plan.altitudes[0]; STEPS], [vec![0.0; STEPS], vec![0.0; STEPS]])
        } else {
            let altitude = altitude(plan, &mut generator);
            let throttle = throttle(design, &altitude, &mut generator);
            (throttle, altitude, [0, 1].map(|_| place(design, &mut generator)))
        };
        let acceleration = [second_difference(&place[0]), second_difference(&place[1])];
        let hand = &mut seeds.stream(plan.number, Purpose::Excitation);
        let actuators = match design {
            Design::Paper => held(plan, parked, hand),
            Design::Rich => moved(parked, hand),
        };
        let times = time_stamps(&mut seeds.stream(plan.number, Purpose::Clock));
        Self { number: plan.number, role: plan.role, times, actuators, throttle, altitude, place, acceleration }
    }

    /// Returns the value of a course at a time, linear between grid points and held beyond the ends.
    pub fn at(&self, values: &[f64], time: f64) -> f64 {
        at(values, time)
    }

    /// Returns the time of a grid point, s.
    pub fn time(&self, n: usize) -> f64 {
        STEP * n as f64 - PREROLL
    }
}

/// Returns the value of a course at a time, linear between grid points and held beyond the ends.
pub fn at(values: &[f64], time: f64) -> f64 {
    let place = ((time + PREROLL) / STEP).clamp(0.0, (values.len() - 1) as f64);
    let left = (place as usize).min(values.len() - 2);
    let share = place - left as f64;
    values[left] * (1.0 - share) + values[left + 1] * share
}

fn grid(of: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..STEPS).map(|n| of(STEP * n as f64 - PREROLL)).collect()
}

/// Returns strokes of varied speed with partial reversals and dwells, on both actuators; slow ones with rotors off.
fn moved(parked: bool, hand: &mut ChaCha8Rng) -> [Vec<f64>; 2] {
    let calm = ExcitationSettings {
        speed: 0.30,
        speed_spread: 0.2,
        speed_limits: [0.18, 0.42],
        shortfall: 0.25,
        partial: 0.35,
        partial_length: [0.3, 1.5],
        dwell: 0.05,
        dwell_time: [0.3, 1.0],
        ..ExcitationSettings::default()
    };
    let brisk = ExcitationSettings {
        speed: 0.42,
        speed_spread: 0.55,
        speed_limits: [0.12, 0.85],
        shortfall: 0.3,
        partial: 0.45,
        dwell: 0.3,
        dwell_time: [0.4, 2.5],
        ..calm.clone()
    };
    let (settings, amplitudes) = if parked { (calm, [2.4, 1.25]) } else { (brisk, [2.25, 1.1]) };
    let mut course = |amplitude: f64, centre: f64| {
        let strokes = Reciprocation::new(&settings, amplitude, -PREROLL, DURATION + 1.0, hand);
        grid(|time| centre + strokes.at(time))
    };
    [course(amplitudes[0], 0.0), course(amplitudes[1], 1.2)]
}

/// Returns q1 to and fro at one speed, q2 held by a hand that is not quite still.
fn held(plan: &Plan, parked: bool, hand: &mut ChaCha8Rng) -> [Vec<f64>; 2] {
    let (amplitude, speed, wander) = if parked { (2.4, 0.35, 0.006) } else { (2.25, 0.55, 0.003) };
    let mut place = between(hand, [-amplitude, amplitude]);
    let mut side = if happens(hand, 0.5) { 1.0 } else { -1.0 };
    let mut goal = side * amplitude;
    let sharp: Vec<f64> = (0..STEPS)
        .map(|_| {
            place += side * speed * STEP;
            if side * (goal - place) <= 0.0 {
                side = -side;
                goal = side * amplitude * between(hand, [0.94, 1.0]);
            }
            place
        })
        .collect();
    let phase = between(hand, [0.0, TAU]);
    // One cycle in 17 s, as in the full campaign.
    [averaged(&sharp, 20), grid(|time| plan.slice + wander * (TAU * time / 17.0 + phase).sin())]
}

/// Returns the mean over `reach` grid points to either side: a reversal takes as long.
fn averaged(values: &[f64], reach: usize) -> Vec<f64> {
    let mean = |n: usize| {
        let near = &values[n.saturating_sub(reach)..(n + reach + 1).min(values.len())];
        near.iter().sum::<f64>() / near.len() as f64
    };
    (0..values.len()).map(mean).collect()
}

/// Returns altitudes one after the other, with the wander of an altitude hold.
fn altitude(plan: &Plan, generator: &mut ChaCha8Rng) -> Vec<f64> {
    let mut hold = Gusts::new(1, STEP, 3.0, generator);
    let hop = DURATION / plan.altitudes.len() as f64;
    let mut path = Path::at_rest(plan.altitudes[0]);
    for (k, level) in plan.altitudes.iter().enumerate().skip(1) {
        path.go(hop * k as f64 - between(generator, [1.0, 4.0]), between(generator, [3.0, 4.5]), *level);
    }
    let smooth = averaged(&(0..STEPS).map(|_| 0.015 * hold.advance(generator)[0]).collect::<Vec<_>>(), 15);
    smooth.iter().zip(grid(|time| path.value(time))).map(|(wander, level)| level + wander).collect()
}

/// Returns the trim, less near the ground (Cheeseman & Bennett 1955), with control activity, and steps where the design
/// has them.
fn throttle(design: Design, altitude: &[f64], generator: &mut ChaCha8Rng) -> Vec<f64> {
    let mut path = Path::at_rest(0.0);
    let mut time = -PREROLL;
    while design == Design::Rich && time < DURATION {
        path.go(time, 0.25, between(generator, [-0.24, 0.20]));
        time += between(generator, [3.0, 7.0]);
    }
    let mut control = Gusts::new(1, STEP, 2.0, generator);
    let activity = if design == Design::Rich { 0.010 } else { 0.014 };
    (0..altitude.len())
        .map(|n| {
            let near = 0.19 / (2.0 * altitude[n]);
            let trim = HOVER * (1.0 - near * near).sqrt();
            trim + path.value(STEP * n as f64 - PREROLL) + activity * control.advance(generator)[0]
        })
        .collect()
}

/// Returns one horizontal coordinate: hover, or brisk moves with pauses.
fn place(design: Design, generator: &mut ChaCha8Rng) -> Vec<f64> {
    if design == Design::Paper {
        let waves: Vec<[f64; 3]> = (0..4)
            .map(|_| {
                [between(generator, [0.02, 0.05]), between(generator, [0.15, 0.35]), between(generator, [0.0, TAU])]
            })
            .collect();
        return grid(|time| waves.iter().map(|[size, rate, phase]| size * (TAU * rate * time + phase).sin()).sum());
    }
    let mut path = Path::at_rest(0.0);
    let mut time = -PREROLL;
    while time < DURATION {
        let duration = between(generator, [2.2, 3.6]);
        path.go(time, duration, between(generator, [-1.0, 1.0]));
        time += duration + between(generator, [0.2, 1.5]);
    }
    grid(|time| path.value(time))
}

/// Moves of minimum jerk (Flash & Hogan 1985) between rests.
struct Path {
    moves: Vec<[f64; 4]>,
    goal: f64,
}

impl Path {
    fn at_rest(value: f64) -> Self {
        Self { moves: Vec::new(), goal: value }
    }

    fn go(&mut self, start: f64, duration: f64, goal: f64) {
        self.moves.push([start, duration, self.goal, goal]);
        self.goal = goal;
    }

    fn value(&self, time: f64) -> f64 {
        let next = self.moves.partition_point(|stroke| stroke[0] <= time);
        let Some([start, duration, from, to]) = self.moves.get(next.saturating_sub(1)) else { return self.goal };
        let u = ((time - start) / duration).clamp(0.0, 1.0);
        from + (to - from) * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
    }
}

fn second_difference(values: &[f64]) -> Vec<f64> {
    let last = values.len() - 1;
    (0..=last)
        .map(|n| {
            let middle = n.clamp(1, last - 1);
            (values[middle - 1] - 2.0 * values[middle] + values[middle + 1]) / (STEP * STEP)
        })
        .collect()
}

/// Returns time stamps at 10 Hz with jitter and lost frames, from 0 s.
fn time_stamps(generator: &mut ChaCha8Rng) -> Vec<f64> {
    let settings = MeasurementSettings::default();
    let (mut times, mut time) = (Vec::new(), 0.0);
    while time <= DURATION {
        times.push((time * 1e4_f64).round() / 1e4);
        time += (settings.period + settings.jitter * normal(generator)).max(0.6 * settings.period);
        if happens(generator, settings.drop) {
            time += settings.period * between(generator, [1.0, 5.0]).floor();
        }
    }
    times
}

/// Returns a flight whose first actuator follows `of`, the second standing still.
#[cfg(test)]
pub fn trial_of(of: &dyn Fn(f64) -> f64) -> Course {
    let seeds = Seeds::both(5);
    let mut course =
        Course::new(Design::Rich, &super::design::plans(Design::Rich, super::design::COUNTS, &seeds)[7], &seeds);
    course.actuators = [grid(of), grid(|_| 0.7)];
    course
}

#[cfg(test)]
mod tests {
    use super::super::design::{COUNTS, plans};
    use super::*;

    fn course(design: Design, number: usize) -> Course {
        let seeds = Seeds::both(5);
        Course::new(design, &plans(design, COUNTS, &seeds)[number - 1], &seeds)
    }

    #[test]
    fn rich_flight_has_speeds_steps_climbs_and_manoeuvres() {
        let course = course(Design::Rich, 8);
        for q in &course.actuators {
            let speeds: Vec<f64> = q.windows(2).map(|pair| ((pair[1] - pair[0]) / STEP).abs()).collect();
            let share = |of: &dyn Fn(f64) -> bool| {
                speeds.iter().filter(|speed| of(**speed)).count() as f64 / speeds.len() as f64
            };
            assert!(share(&|v| v < 1e-9) > 0.01 && share(&|v| v > 0.15 && v < 0.35) > 0.1 && share(&|v| v > 0.5) > 0.1);
        }
        let range = |values: &[f64]| {
            values.iter().copied().fold(f64::MIN, f64::max) - values.iter().copied().fold(f64::MAX, f64::min)
        };
        assert!(range(&course.throttle) > 0.15 && range(&course.altitude) > 0.2);
        let square = course.acceleration[0].iter().map(|a| a * a).sum::<f64>() / course.throttle.len() as f64;
        assert!((0.1..1.0).contains(&square.sqrt()), "{}", square.sqrt());
    }

    #[test]
    fn paper_flight_has_one_speed_and_one_slice() {
        let course = course(Design::Paper, 8);
        let steady = course.actuators[0].windows(2).filter(|p| ((p[1] - p[0]).abs() / STEP - 0.55).abs() < 1e-9);
        assert!(steady.count() as f64 > 0.9 * course.throttle.len() as f64);
        assert!(course.actuators[1].iter().all(|q2| (q2 - course.actuators[1][0]).abs() < 0.01));
    }

    /// Oracle: the acceleration of a move of minimum jerk is at most 5.7735·d/T² (Flash & Hogan).
    #[test]
    fn acceleration_of_a_move() {
        let mut path = Path::at_rest(0.0);
        path.go(1.0, 2.0, 0.5);
        let peak = second_difference(&grid(|time| path.value(time))).into_iter().fold(0.0, f64::max);
        assert!((peak - 5.7735 * 0.5 / 4.0).abs() < 1e-3, "{peak}");
    }

    #[test]
    fn clock_jitters_and_loses_frames() {
        let times = course(Design::Rich, 3).times;
        let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!((470..=502).contains(&times.len()) && times[0] == 0.0, "{}", times.len());
        assert!(steps.iter().all(|step| *step > 0.059) && steps.iter().any(|step| *step > 0.15));
    }
}
