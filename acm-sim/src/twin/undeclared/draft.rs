//! A mechanism as drawn from a seed, before its size is chosen.
//!
//! The size is what makes it large or small; everything else (signs, shapes, times, directions) is drawn first. The size
//! is then chosen so that the tip moves as much as wanted, whatever the excitation.

use super::super::random::{between, happens, normal};
use super::course::DURATION;
use super::kind::Cause;
use super::mechanism::Mechanism;
use super::truth::Since;
use crate::twin::undeclared::mechanisms::maps::{CamTable, Oblique, REACH, Warming, WornPulley, Yielding};
use crate::twin::undeclared::mechanisms::memory::{Bristles, Fibres, PowerLaw, SoftPlay, Sprung, Transport, TwoPoles};
use crate::twin::undeclared::mechanisms::outside::{CrossTerm, HeightGain, QuadraticDrag, Shifted, Slip, Twist, Waves};
use crate::twin::undeclared::mechanisms::pushes::{Air, Blow, HeavyRod, TipMass};
use crate::twin::undeclared::mechanisms::seen::{Bumped, Drifting, Leaning, Stalk, Stretched, Tracker};
use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// Trials of a campaign.
pub const TRIALS: usize = 17;

/// Draft of a mechanism, before its size is drawn.
#[derive(Clone, Debug)]
pub struct Draft {
    /// Mechanism of the draft.
    pub cause: Cause,
    /// Onset of the mechanism.
    pub since: Since,
    /// The trial, where it acts in one only.
    pub trial: Option<usize>,
    /// Sign, −1 or 1.
    sign: f64,
    /// Shapes, each between 0 and 1.
    shape: [f64; 4],
    /// Random direction.
    toward: Vector3<f64>,
    /// Irregularities, standard normal.
    ripple: [f64; 12],
    /// Stream of the random numbers of each trial.
    source: ChaCha8Rng,
}

impl Draft {
    /// Draws all but the size.
    pub fn new(cause: Cause, generator: &mut ChaCha8Rng) -> Self {
        let there = happens(generator, 0.5);
        let trial = 6 + between(generator, [0.0, 9.0]) as usize;
        let sign = if happens(generator, 0.5) { 1.0 } else { -1.0 };
        let shape = [0; 4].map(|_| between(generator, [0.0, 1.0]));
        let toward = Vector3::from([0; 3].map(|_| normal(generator))).normalize();
        let ripple = [0; 12].map(|_| normal(generator));
        let since = since(cause, there);
        let trial = (since == Since::OneTrial).then_some(trial);
        Self { cause, since, trial, sign, shape, toward, ripple, source: generator.clone() }
    }

    /// Returns a number between two limits, from one of the shapes.
    fn part(&self, which: usize, limits: [f64; 2]) -> f64 {
        limits[0] + (limits[1] - limits[0]) * self.shape[which]
    }

    /// Returns the smallest, usual and largest size.
    pub fn sizes(&self) -> [f64; 3] {
        match self.cause {
            Cause::DeadTime => [0.03, 0.15, 0.6],
            Cause::ActuatorLag => [0.03, 0.12, 0.8],
            Cause::Resonance => [0.2, 0.8, 3.0],
            Cause::Backlash => [0.01, 0.08, 0.4],
            Cause::Hysteresis => [0.01, 0.1, 0.4],
            Cause::TendonFriction => [0.005, 0.06, 0.4],
            Cause::Creep => [0.02, 0.15, 0.5],
            Cause::StaticGain | Cause::HeightGain | Cause::GainDrift => [0.01, 0.08, 0.5],
            Cause::ZeroDrift => [0.01, 0.1, 0.5],
            Cause::EncoderPeriodic => [0.01, 0.08, 0.3],
            Cause::Coupling => [0.01, 0.06, 0.3],
            Cause::Saturation => [0.1, 0.5, 1.5],
            Cause::TipLoad => [0.004, 0.03, 0.15],
            Cause::Payload => [0.006, 0.05, 0.2],
            Cause::SelfWeight => [0.1, 0.6, 3.0],
            Cause::Downwash | Cause::WakeLag => [2.0, 30.0, 150.0],
            Cause::GroundEffect => [2.0, 60.0, 600.0],
            Cause::SideWind => [0.5, 10.0, 80.0],
            Cause::BaseTilt => [0.3, 1.0, 2.5],
            Cause::MarkerOffset => [0.004, 0.015, 0.04],
            Cause::Misregistration => [0.005, 0.03, 0.12],
            Cause::Scale => [0.005, 0.03, 0.12],
            Cause::MeasurementLag => [0.02, 0.12, 0.8],
            Cause::MeasurementDrift => [0.004, 0.03, 0.1],
            Cause::CrossTerm => [0.01, 0.05, 0.3],
            Cause::QuadraticDrag => [0.01, 0.2, 3.0],
            Cause::Twist => [0.005, 0.04, 0.3],
            Cause::Slip => [0.15, 0.25, 0.4],
            Cause::TrialOffset => [0.015, 0.022, 0.03],
            Cause::Vibration | Cause::Wandering => [0.003, 0.01, 0.05],
        }
    }

    /// Returns a size between the smallest and the largest, for a mechanism that acts in one trial alone.
    pub fn own_size(&self) -> f64 {
        let [least, _, most] = self.sizes();
        self.part(3, [least, most])
    }

    /// Returns the mechanism of a size.
    pub fn mechanism(&self, size: f64) -> Box<dyn Mechanism> {
        let signed = self.sign * size;
        // The second actuator is of the same make, but not the same.
        let other = self.part(0, [0.6, 1.2]);
        match self.cause {
            Cause::DeadTime => Box::new(Transport { delay: size }),
            Cause::ActuatorLag => Box::new(TwoPoles { slow: size }),
            Cause::Resonance => Box::new(Sprung { period: size, damping: self.part(0, [0.1, 0.3]) }),
            Cause::Backlash => Box::new(SoftPlay { width: [size, other * size] }),
            Cause::Hysteresis => Box::new(Fibres { held: size, threshold: self.part(1, [0.12, 0.3]) }),
            Cause::TendonFriction => {
                Box::new(Bristles { friction: [size, other * size], way: self.part(1, [0.06, 0.2]) })
            }
            Cause::Creep => Box::new(PowerLaw {
                share: size,
                onset: self.part(0, [2.5, 7.0]) * self.part(1, [1.5, 2.5]),
                exponent: self.part(1, [1.5, 2.5]),
            }),
            Cause::StaticGain => Box::new(WornPulley {
                gain: [signed, signed * self.part(0, [-1.0, 1.0])],
                growth: self.part(1, [-0.08, 0.08]),
                offset: [0.5 * size * self.ripple[0].clamp(-1.5, 1.5), 0.5 * size * self.ripple[1].clamp(-1.5, 1.5)],
            }),
            Cause::GainDrift => Box::new(Warming { gain: signed, zero: [0.0; 2], time: self.part(0, [50.0, 110.0]) }),
            Cause::ZeroDrift => Box::new(Warming {
                gain: 0.0,
                zero: [signed, signed * self.part(0, [-1.0, 1.0])],
                time: self.part(1, [40.0, 100.0]),
            }),
            Cause::EncoderPeriodic => {
                let (period, phase) = (self.part(0, [0.8, 1.8]), self.part(1, [0.0, TAU]));
                Box::new(CamTable::new(size, period, phase, self.ripple))
            }
            Cause::Coupling => Box::new(Oblique { share: signed, bend: self.part(0, [0.25, 0.45]) }),
            Cause::Saturation => Box::new(Yielding { limit: REACH - size }),
            Cause::TipLoad => Box::new(TipMass { mass: [size; 3] }),
            Cause::Payload => Box::new(TipMass { mass: [0.0, 0.6 * size, size] }),
            Cause::SelfWeight => Box::new(HeavyRod { share: size }),
            Cause::SideWind => Box::new(Air { square: size, power: 0.0, blow: Blow::Side(self.part(0, [0.0, TAU])) }),
            Cause::Downwash => self.air(size, Blow::Jet(self.part(0, [0.8, 2.0]))),
            Cause::WakeLag => self.air(size, Blow::Late(self.part(0, [0.8, 2.0]), self.part(2, [1.0, 3.0]))),
            Cause::GroundEffect => self.air(size, Blow::Ground(self.part(0, [0.6, 1.1]), self.sign)),
            Cause::BaseTilt => Box::new(Leaning { share: size }),
            Cause::MarkerOffset => Box::new(Stalk { offset: size * self.toward }),
            Cause::Misregistration => Box::new(Bumped {
                turn: size * self.toward,
                shift: 0.1 * size * Vector3::new(self.ripple[0], self.ripple[1], self.ripple[2]),
            }),
            Cause::Scale => Box::new(Stretched { scale: signed }),
            Cause::MeasurementLag => Box::new(Tracker { time: size }),
            Cause::MeasurementDrift => {
                Box::new(Drifting { way: size * self.toward, time: self.part(0, [50.0, 120.0]) })
            }
            _ => self.strange(size),
        }
    }

    fn air(&self, square: f64, blow: Blow) -> Box<dyn Mechanism> {
        Box::new(Air { square, power: self.part(1, [1.0, 1.6]), blow })
    }

    /// Returns a mechanism that the library does not have.
    fn strange(&self, size: f64) -> Box<dyn Mechanism> {
        let signed = self.sign * size;
        let mut source = self.source.clone();
        match self.cause {
            Cause::CrossTerm => Box::new(CrossTerm { share: signed }),
            Cause::QuadraticDrag => Box::new(QuadraticDrag { trail: size }),
            Cause::HeightGain => Box::new(HeightGain { gain: signed }),
            Cause::Twist => Box::new(Twist { share: signed }),
            Cause::Slip => Box::new(Slip { way: signed, time: self.part(0, [0.3, 0.6]) * DURATION }),
            Cause::Vibration => {
                let phases = (0..TRIALS).map(|_| between(&mut source, [0.0, TAU])).collect();
                Box::new(Waves::vibration(size * self.toward, self.part(0, [0.7, 3.5]), phases))
            }
            Cause::Wandering => {
                let uniform = || between(&mut source, [0.0, 1.0]);
                Box::new(Waves::wandering(size, self.part(0, [2.0, 4.0]), TRIALS, uniform))
            }
            _ => Box::new(Shifted { shift: size * self.toward }),
        }
    }

    /// Returns whether it acts in a trial.
    pub fn acts(&self, trial: usize, calibration: bool) -> bool {
        match self.since {
            Since::Start => true,
            Since::AfterCalibration => !calibration,
            Since::OneTrial => self.trial == Some(trial),
        }
    }
}

/// Returns the onset of a mechanism. One that a calibration cannot absorb may have acted before it: `there` decides.
fn since(cause: Cause, there: bool) -> Since {
    match cause {
        Cause::DeadTime
        | Cause::ActuatorLag
        | Cause::Resonance
        | Cause::Backlash
        | Cause::Hysteresis
        | Cause::TendonFriction
        | Cause::Creep
        | Cause::QuadraticDrag
        | Cause::MeasurementLag
            if there =>
        {
            Since::Start
        }
        Cause::Downwash | Cause::WakeLag | Cause::GroundEffect | Cause::BaseTilt => Since::Start,
        Cause::Vibration | Cause::Wandering => Since::Start,
        Cause::Slip | Cause::TrialOffset => Since::OneTrial,
        _ => Since::AfterCalibration,
    }
}
