//! From a seed to a campaign: plan, draw, size, simulate, measure.
//!
//! The size of a mechanism is found on a thinned record of the held-out trials: with r(s) ~ s^p between two trial sizes,
//! s = s₁·(r_wanted/r₁)^(1/p).

use super::super::campaign::TwinError;
use super::super::random::{Gusts, Purpose, Seeds, between, normal};
use super::super::rounding::round_to;
use super::super::settings::MeasurementSettings;
use super::amiss::Amiss;
use super::course::Course;
use super::deck::draw;
use super::design::{Design, plans};
use super::draft::Draft;
use super::kind::{Cause, Kind, Null};
use super::mechanism::{Mechanism, Ranges};
use super::quiet::Rig;
use super::separable::{Noise, Part, separable};
use super::several;
use super::simulate::tips;
use super::truth::{Parameter, TrueEffect, Truth};
use crate::role::Role;
use crate::twin::undeclared::mechanisms::pushes::TipMass;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Correlation time of coloured noise, s.
const COLOURED_TIME: f64 = 0.4;
/// Scale of the pulleys' errors in the null of 16 mm misfit.
const MISFIT: [f64; 2] = [1.25, 1.45];
/// Stride of the samples that a size is found from.
const THIN: usize = 9;
/// Stride of the samples that determine whether a mechanism is separable.
const SEPARATE: usize = 5;
/// RMS of a mechanism's displacement of the tip, m: alone, and as one of several.
const WANTED: [[f64; 2]; 2] = [[0.009, 0.022], [0.009, 0.015]];

/// A trial as recorded, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct UndeclaredTrial {
    /// Number of the trial, from 1.
    pub number: usize,
    /// Role of the trial.
    pub role: Role,
    /// Time stamps, s.
    pub time: Vec<f64>,
    /// Encoder readings, rad.
    pub actuators: [Vec<f64>; 2],
    /// Altitude of the attachment, m.
    pub altitude: Vec<f64>,
    /// Throttle, 1.
    pub throttle: Vec<f64>,
    /// Position of the vehicle, m.
    pub vehicle: [Vec<f64>; 3],
    /// Tip relative to the attachment, world axes (z up), m.
    pub tip: Vec<Vector3<f64>>,
    /// Mass at the tip, kg, where it is known.
    pub payload: Option<f64>,
}

/// A campaign with its truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Undeclared {
    /// Motion of actuators and vehicle.
    pub design: Design,
    /// Length of the arm, m.
    pub length: f64,
    /// Trials in the order of their numbers.
    pub trials: Vec<UndeclaredTrial>,
    /// Truth of the campaign.
    pub truth: Truth,
}

/// Makes a campaign; the kind is drawn from the seed where none is given.
///
/// # Errors
/// An arm without equilibrium.
pub fn generate(seed: u64, design: Design, kind: Option<Kind>) -> Result<Undeclared, TwinError> {
    Stage::new(seed, design, kind.unwrap_or_else(|| draw(seed))).campaign()
}

/// Makes the campaign of [`generate`] as it would be recorded without noise: the same motion and mechanisms, neither noise of the tip and
/// of the encoders, nor offsets and errors of the stamps.
///
/// # Errors
/// An arm without equilibrium.
pub fn generate_without_noise(seed: u64, design: Design, kind: Option<Kind>) -> Result<Undeclared, TwinError> {
    let stage = Stage::new(seed, design, kind.unwrap_or_else(|| draw(seed)));
    Stage { amiss: stage.amiss.without_noise(), ..stage }.campaign()
}

/// Parts of a campaign without the mechanisms.
struct Stage {
    seed: u64,
    design: Design,
    kind: Kind,
    seeds: Seeds,
    rig: Rig,
    amiss: Amiss,
    courses: Vec<Course>,
}

/// A mechanism with its size.
type Sized = (Draft, f64, Box<dyn Mechanism>);

impl Stage {
    fn new(seed: u64, design: Design, kind: Kind) -> Self {
        let seeds = Seeds::both(seed);
        let rig = Rig::new(if kind == Kind::Null(Null::Misfit) { MISFIT } else { [0.0; 2] });
        let amiss = Amiss::new(kind, &mut seeds.stream(100 + place(kind), Purpose::Tilt));
        let courses =
            plans(design, amiss.counts, &seeds).par_iter().map(|plan| Course::new(design, plan, &seeds)).collect();
        Self { seed, design, kind, seeds, rig, amiss, courses }
    }

    /// Simulates and measures the trials.
    fn campaign(&self) -> Result<Undeclared, TwinError> {
        let drafts = self.drafts()?;
        let record = |course: &Course| -> Result<Vec<Vector3<f64>>, TwinError> {
            tips(&self.rig, course, &active(course, &drafts), &course.times)
        };
        let found: Vec<Vec<Vector3<f64>>> = self.courses.par_iter().map(record).collect::<Result<_, _>>()?;
        let truth = self.truth(&drafts, &found)?;
        let payload = drafts.iter().find(|(draft, _, _)| draft.cause == Cause::Payload).map(|(_, size, _)| *size);
        let conditions = self.conditions(payload);
        let trials =
            self.courses.iter().zip(&found).map(|(course, tips)| self.measured(course, tips, &conditions)).collect();
        Ok(Undeclared { design: self.design, length: self.rig.settings.arm.length, trials, truth })
    }

    /// Draws the mechanisms and sizes them.
    fn drafts(&self) -> Result<Vec<Sized>, TwinError> {
        let mut generator = self.seeds.stream(100 + place(self.kind), Purpose::Rig);
        let causes = match self.kind {
            Kind::Several(many) => several::causes(usize::from(many), &mut generator),
            kind => kind.causes(),
        };
        let mut sized = Vec::new();
        for cause in &causes {
            let wanted = between(&mut generator, WANTED[causes.len().min(WANTED.len()) - 1]);
            let draft = Draft::new(*cause, &mut generator);
            let size = if draft.trial.is_some() { draft.own_size() } else { self.size(&draft, wanted)? };
            let mechanism = draft.mechanism(size);
            sized.push((draft, size, mechanism));
        }
        Ok(sized)
    }

    fn size(&self, draft: &Draft, wanted: f64) -> Result<f64, TwinError> {
        let [least, usual, most] = draft.sizes();
        let thinned = |course: &&Course| course.times.iter().copied().step_by(THIN).collect::<Vec<f64>>();
        let held: Vec<&Course> = self.held_out().collect();
        let at = |mechanism: Option<&dyn Mechanism>| -> Result<Vec<Vector3<f64>>, TwinError> {
            let active: Vec<&dyn Mechanism> = mechanism.into_iter().collect();
            let parts: Vec<_> =
                held.par_iter().map(|c| tips(&self.rig, c, &active, &thinned(c))).collect::<Result<_, _>>()?;
            Ok(parts.concat())
        };
        let bare = at(None)?;
        let moved = |size: f64| -> Result<f64, TwinError> { Ok(rms(&at(Some(&*draft.mechanism(size)))?, &bare)) };
        let first = moved(usual)?;
        let guess = (usual * wanted / first.max(1e-9)).clamp(least, most);
        let second = moved(guess)?;
        let power = ((second / first).ln() / (guess / usual).ln()).clamp(0.3, 3.0);
        let found = guess * (wanted / second.max(1e-9)).powf(1.0 / power);
        // A guess as large as the usual size has no power to be found.
        Ok(if found.is_finite() { found.clamp(least, most) } else { guess })
    }

    /// Returns the trials that are held out; those of development where none is.
    fn held_out(&self) -> impl Iterator<Item = &Course> {
        let role = if self.amiss.counts[2] > 0 { Role::HeldOut } else { Role::Development };
        self.courses.iter().filter(move |course| course.role == role)
    }

    /// Returns the RMS that some mechanisms make in the held-out trials, m; with those of `found` where they are all.
    fn effect(&self, drafts: &[Sized], found: Option<&[Vec<Vector3<f64>>]>) -> Result<f64, TwinError> {
        let held: Vec<&Course> = self.held_out().collect();
        let part = |course: &&Course| -> Result<(Vec<Vector3<f64>>, Vec<Vector3<f64>>), TwinError> {
            let active = active(course, drafts);
            let bare = tips(&self.rig, course, &[], &course.times)?;
            let with = match found {
                Some(found) => found[course.number - 1].clone(),
                None => tips(&self.rig, course, &active, &course.times)?,
            };
            Ok((with, bare))
        };
        let parts: Vec<_> = held.par_iter().map(part).collect::<Result<_, _>>()?;
        let (with, bare): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
        Ok(rms(&with.concat(), &bare.concat()))
    }

    /// Returns the RMS in the held-out trials of white and coloured noise and of each trial's offset, 3-D, m.
    fn irreducible(&self) -> f64 {
        let offset = |course: &Course| self.amiss.shift(course.number, &self.seeds).norm_squared();
        let (sum, samples) = self.held_out().fold((0.0, 0), |(sum, samples), course| {
            let own = course.times.len();
            (sum + own as f64 * offset(course), samples + own)
        });
        (3.0 * (self.amiss.white.powi(2) + self.amiss.coloured.powi(2)) + sum / samples.max(1) as f64).sqrt()
    }

    fn truth(&self, drafts: &[Sized], found: &[Vec<Vector3<f64>>]) -> Result<Truth, TwinError> {
        let together = if drafts.is_empty() { 0.0 } else { 1e3 * self.effect(drafts, Some(found))? };
        let noise =
            Noise { tip: 3f64.sqrt() * self.amiss.white.hypot(self.amiss.coloured), offsets: self.amiss.offset > 0.0 };
        let separable = separable(&self.parts(drafts, found)?, noise);
        let mut effects = Vec::new();
        for (k, (draft, _, mechanism)) in drafts.iter().enumerate() {
            let alone = if drafts.len() == 1 { together } else { 1e3 * self.effect(&drafts[k..=k], None)? };
            effects.push(TrueEffect {
                kind: draft.cause.name().into(),
                name: draft.cause.library().map(Into::into),
                contained_in: mechanism.contained_in().iter().copied().map(Into::into).collect(),
                inside: draft.cause.library().is_some(),
                since: draft.since,
                trial: draft.trial.map(|trial| trial.to_string()),
                parameters: self.stated(&**mechanism),
                formula: mechanism.formula(),
                held_out_rms_mm: alone,
                separable: separable.get(k).is_some_and(|absence| absence.shows),
                missed: separable.get(k).map_or(0.0, |absence| absence.errors),
            });
        }
        Ok(Truth {
            seed: self.seed,
            design: self.design,
            kind: self.kind.name(),
            class: self.kind.class(),
            effects,
            held_out_rms_mm: together,
            white_noise_mm: 1e3 * self.amiss.white * 3f64.sqrt(),
            coloured_noise_mm: 1e3 * self.amiss.coloured * 3f64.sqrt(),
            encoder_noise_mrad: if self.amiss.has_encoders() { 1e3 * self.amiss.encoder } else { 0.0 },
            offset_mm: 1e3 * self.amiss.offset * 3f64.sqrt(),
            irreducible_mm: 1e3 * self.irreducible(),
            stamp_error_ms: 1e3 * self.amiss.stamps,
        })
    }

    /// Returns the displacement by each mechanism beside the others, in calibration and development trials, thinned.
    fn parts(&self, drafts: &[Sized], found: &[Vec<Vector3<f64>>]) -> Result<Vec<Part>, TwinError> {
        let part = |course: &Course| -> Result<Part, TwinError> {
            let times: Vec<f64> = course.times.iter().copied().step_by(SEPARATE).collect();
            let with: Vec<Vector3<f64>> = found[course.number - 1].iter().copied().step_by(SEPARATE).collect();
            let without = |cause: usize| -> Result<Vec<Vector3<f64>>, TwinError> {
                if !drafts[cause].0.acts(course.number, course.role == Role::Calibration) {
                    return Ok(vec![Vector3::zeros(); with.len()]);
                }
                let rest = tips(&self.rig, course, &active_without(course, drafts, Some(cause)), &times)?;
                Ok(with.iter().zip(rest).map(|(with, rest)| with - rest).collect())
            };
            Ok(Part {
                development: course.role == Role::Development,
                samples: course.times.len(),
                actuators: times.iter().map(|t| [0, 1].map(|j| course.at(&course.actuators[j], *t))).collect(),
                differences: (0..drafts.len()).map(without).collect::<Result<_, _>>()?,
            })
        };
        if drafts.is_empty() {
            return Ok(vec![]);
        }
        self.courses.par_iter().filter(|course| course.role != Role::HeldOut).map(part).collect()
    }

    /// Returns the values with a counterpart in the library, without those that a held actuator would show.
    fn stated(&self, mechanism: &dyn Mechanism) -> Vec<Parameter> {
        let shown = |parameter: &Parameter| {
            let motion = ["width_q2", "friction_q2"].contains(&parameter.name.as_str());
            self.design == Design::Rich || !motion
        };
        mechanism.parameters(&self.ranges()).into_iter().filter(shown).collect()
    }

    /// Returns what each actuator covers in calibration and development trials.
    fn ranges(&self) -> Ranges {
        let fitted = || self.courses.iter().filter(|course| course.role != Role::HeldOut);
        [0, 1].map(|j| {
            let values = || fitted().flat_map(move |course| &course.actuators[j]);
            [values().copied().fold(f64::INFINITY, f64::min), values().copied().fold(f64::NEG_INFINITY, f64::max)]
        })
    }

    /// Returns the recorded conditions of each trial: a payload, where it is known.
    fn conditions(&self, payload: Option<f64>) -> BTreeMap<usize, f64> {
        let Some(size) = payload else { return BTreeMap::new() };
        let mass = TipMass { mass: [0.0, 0.6 * size, size] };
        let of = |course: &Course| if course.role == Role::Calibration { 0.0 } else { mass.of(course.number) };
        self.courses.iter().map(|course| (course.number, of(course))).collect()
    }

    /// Returns the measured record of a trial.
    fn measured(&self, course: &Course, tips: &[Vector3<f64>], conditions: &BTreeMap<usize, f64>) -> UndeclaredTrial {
        let settings = MeasurementSettings::default();
        let [_, digits, throttle_digits] = settings.decimals;
        let mut encoder = self.seeds.stream(course.number, Purpose::Encoder);
        let step = std::f64::consts::TAU / f64::from(1u32 << settings.encoder_bits);
        let mut read = |j: usize| -> Vec<f64> {
            let noisy = |time: &f64| course.at(&course.actuators[j], *time) + self.amiss.encoder * normal(&mut encoder);
            course.times.iter().map(noisy).map(|angle| (angle / step).round() * step).collect()
        };
        let actuators = [read(0), read(1)];
        let mut logger = self.seeds.stream(course.number, Purpose::Logger);
        let mut log = |values: &[f64], noise: f64, digits: i32| -> Vec<f64> {
            course.times.iter().map(|t| round_to(course.at(values, *t) + noise * normal(&mut logger), digits)).collect()
        };
        let parked = course.role == Role::Calibration;
        let altitude = log(&course.altitude, settings.marker_noise, digits);
        // A vehicle on its stand reports a throttle of exactly zero.
        let throttle = log(&course.throttle, if parked { 0.0 } else { 2e-3 }, throttle_digits);
        let [px, py] = [0, 1].map(|axis| log(&course.place[axis], settings.marker_noise, digits));
        UndeclaredTrial {
            number: course.number,
            role: course.role,
            time: self.amiss.stamps(&course.times, course.number, &self.seeds),
            actuators,
            vehicle: [px, py, altitude.clone()],
            altitude,
            throttle,
            tip: self.noisy(course, tips, digits),
            payload: conditions.get(&course.number).copied(),
        }
    }

    fn noisy(&self, course: &Course, tips: &[Vector3<f64>], digits: i32) -> Vec<Vector3<f64>> {
        let mut marker = self.seeds.stream(course.number, Purpose::Marker);
        let mut slow = self.seeds.stream(course.number, Purpose::Turbulence);
        let size = self.amiss.coloured;
        // On a grid of a hundredth of a second, which is fine against its memory.
        let mut gusts = Gusts::new(3, 0.01, COLOURED_TIME, &mut slow);
        let mut done = 0;
        let mut coloured = Vector3::zeros();
        let shift = self.amiss.shift(course.number, &self.seeds);
        course
            .times
            .iter()
            .zip(tips)
            .map(|(time, tip)| {
                while size > 0.0 && f64::from(done) * 0.01 <= *time {
                    coloured = size * Vector3::from_column_slice(gusts.advance(&mut slow));
                    done += 1;
                }
                let white = self.amiss.white * Vector3::from([0; 3].map(|_| normal(&mut marker)));
                (tip + shift + coloured + white).map(|value| round_to(value, digits))
            })
            .collect()
    }
}

fn active<'a>(course: &Course, drafts: &'a [Sized]) -> Vec<&'a dyn Mechanism> {
    active_without(course, drafts, None)
}

/// Returns the mechanisms that act in a trial, but for one.
fn active_without<'a>(course: &Course, drafts: &'a [Sized], absent: Option<usize>) -> Vec<&'a dyn Mechanism> {
    let acts = |draft: &Draft| draft.acts(course.number, course.role == Role::Calibration);
    let there = drafts.iter().enumerate().filter(|(k, (draft, _, _))| Some(*k) != absent && acts(draft));
    there.map(|(_, (_, _, mechanism))| &**mechanism).collect()
}

/// Returns the index of a kind in the list of all. It selects streams of the kind's own: two kinds of one seed have
/// nothing in common but the flight.
fn place(kind: Kind) -> usize {
    Kind::all().iter().position(|other| *other == kind).unwrap_or(0)
}

/// Returns the RMS distance, m.
fn rms(one: &[Vector3<f64>], two: &[Vector3<f64>]) -> f64 {
    let squares: f64 = one.iter().zip(two).map(|(a, b)| (a - b).norm_squared()).sum();
    (squares / one.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the deviations that were drawn: 1.5 mm on each axis, and the encoders' beside the rounding of two readings to a 12-bit step.
    #[test]
    fn without_noise_the_same_tips_are_recorded() {
        let kind = Some(Kind::Several(1));
        let [noisy, quiet] = [generate, generate_without_noise].map(|make| make(3, Design::Rich, kind).unwrap());
        let step = std::f64::consts::TAU / 4096.0;
        let encoder = 1e-3 * noisy.truth.encoder_noise_mrad;
        let (mut squares, mut turns, mut count) = (0.0, 0.0, 0);
        for (noisy, quiet) in noisy.trials.iter().zip(&quiet.trials) {
            let shift: Vector3<f64> =
                noisy.tip.iter().zip(&quiet.tip).map(|(a, b)| a - b).sum::<Vector3<f64>>() / noisy.tip.len() as f64;
            squares += noisy.tip.iter().zip(&quiet.tip).map(|(a, b)| (a - b - shift).norm_squared()).sum::<f64>();
            count += noisy.tip.len();
            turns += noisy.actuators[0].iter().zip(&quiet.actuators[0]).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        }
        let deviation = (squares / (3 * count) as f64).sqrt();
        assert!((deviation / 1.5e-3 - 1.0).abs() < 0.03, "{deviation}");
        let turned = (turns / count as f64).sqrt();
        assert!(
            encoder > 0.5 * step && (turned / encoder.hypot(step / 6f64.sqrt()) - 1.0).abs() < 0.05,
            "{turned} {encoder}"
        );
        let coloured = generate_without_noise(3, Design::Rich, Some(Kind::Null(Null::Coloured))).unwrap();
        for truth in [quiet.truth, coloured.truth] {
            let left = [truth.irreducible_mm, truth.encoder_noise_mrad, truth.offset_mm, truth.stamp_error_ms];
            assert_eq!(left, [0.0; 4]);
        }
    }
}
