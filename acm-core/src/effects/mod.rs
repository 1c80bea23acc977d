//! Physical effects that a nominal model may lack: each an operator at the place where it acts.
//!
//! ```text
//! y = O( F( p(Q(q)) + Σ_f w_f(t) · u_f(Q(q)) ) )
//! ```
//!
//! | symbol | meaning                                                           | columns            |
//! | `Q`    | effects of the actuation, on whole trials: they have memory       | A, SI              |
//! | `w_f`  | load of each field ([`crate::fields::Field`])                     | one per field      |
//! | `u_f`  | displacement of each marker per unit of that load                 | m per unit         |
//! | `F`    | effects of the frame in which markers are measured                | M = 3K, m          |
//! | `O`    | effects of the output                                             | M, SI              |
//!
//! An effect sees a trial from its first sample on, as a whole or piece by piece ([`Effect::proceed`]), so that it may
//! remember; it works on the time stamps as they are, and takes every signal as straight between two samples. What it makes
//! of the last sample of a piece is what it would make of the end of a trial that ended there. At its neutral values it
//! changes nothing. To add one: write a file with its equation, units and source in the module of its site, and list it in
//! [`ALL`]; the contract test then walks it. Effects that a file defines are [`own`].
//!
//! | module        | sites ([`Site`])                  |
//! | ------------- | --------------------------------- |
//! | [`actuation`] | [`Site::Actuation`]               |
//! | [`load`]      | [`Site::Load`]                    |
//! | [`frame`]     | [`Site::Marker`], [`Site::Frame`] |
//! | [`output`]    | [`Site::Output`]                  |

mod actuation;
mod frame;
mod guesses;
pub mod instance;
mod load;
pub mod memory;
mod oscillators;
mod output;
pub mod own;
pub mod times;

use serde::{Deserialize, Serialize};

pub use crate::record::Record;
pub use crate::rig::Rig;
pub use memory::Memory;

/// Every effect that the tool knows, in the order in which they act.
pub const ALL: &[&dyn Effect] = &[
    &actuation::encoder_periodic::EncoderPeriodic,
    &actuation::static_gain::StaticGain,
    &actuation::gain_drift::GainDrift,
    &actuation::zero_drift::ZeroDrift,
    &actuation::input_nonlinearity::InputNonlinearity,
    &actuation::saturation::Saturation,
    &actuation::dead_zone::DeadZone,
    &actuation::input_disturbance::InputDisturbance,
    &actuation::input_gain::InputGain,
    &actuation::lag::rate_limit::RateLimit,
    &actuation::coupling::Coupling,
    &actuation::hysteresis::backlash::Backlash,
    &actuation::hysteresis::prandtl_ishlinskii::PrandtlIshlinskii,
    &actuation::hysteresis::bouc_wen::BoucWen,
    &actuation::hysteresis::dry_friction::DryFriction,
    &actuation::hysteresis::tendon_friction::TendonFriction,
    &actuation::hysteresis::viscous_slip::ViscousSlip,
    &actuation::lag::actuator_lag::ActuatorLag,
    &actuation::lag::second_order_lag::SecondOrderLag,
    &actuation::lag::nonlinear_stiffness::NonlinearStiffness,
    &actuation::lag::coulomb_damping::CoulombDamping,
    &actuation::lag::state_dependent_lag::StateDependentLag,
    &actuation::lag::outflow::Outflow,
    &actuation::lag::friction_lag::FrictionLag,
    &actuation::lag::asymmetric_lag::AsymmetricLag,
    &actuation::lag::creep::Creep,
    &actuation::lag::dead_time::DeadTime,
    &load::tip_load::TipLoad,
    &load::self_weight::SelfWeight,
    &load::downwash::Downwash,
    &load::wake_lag::WakeLag,
    &load::ground_effect::GroundEffect,
    &load::side_wind::SideWind,
    &frame::marker_offset::MarkerOffset,
    &frame::base_tilt::BaseTilt,
    &frame::misregistration::Misregistration,
    &frame::scale::Scale,
    &output::output_hysteresis::OutputHysteresis,
    &output::coulomb_friction::CoulombFriction,
    &output::dahl_friction::DahlFriction,
    &output::lugre_friction::LugreFriction,
    &output::stribeck_friction::StribeckFriction,
    &output::viscous_friction::ViscousFriction,
    &output::inertia::Inertia,
    &output::joint_gravity::JointGravity,
    &output::context_term::ContextTerm,
    &output::context_lag::ContextLag,
    &output::context_gain::ContextGain,
    &output::measurement::measurement_second_order::MeasurementSecondOrder,
    &output::measurement::measurement_lag::MeasurementLag,
    &output::measurement::measurement_delay::MeasurementDelay,
    &output::measurement::measurement_drift::MeasurementDrift,
];

/// Where an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Site {
    /// On the actuator coordinates before they reach the model: columns q_1 … q_A.
    Actuation,
    /// On the arm, as a load that bends it: columns are the fields of [`crate::fields::Field`].
    Load,
    /// On the place of the marker on the arm: the same columns.
    Marker,
    /// On the frame in which markers are measured: columns x, y, z of each marker.
    Frame,
    /// On the outputs: columns y_1 … y_M.
    Output,
}

/// What carries an effect: an effect may act through one signal of several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Carrier {
    /// The rig as a whole.
    Rig,
    /// One actuator, by index.
    Actuator(usize),
    /// One context signal, by index.
    Context(usize),
}

impl Carrier {
    /// Its signal; none for the rig as a whole, or where the rig lacks it.
    pub fn signal(self, rig: &Rig) -> Option<&crate::rig::Signal> {
        match self {
            Carrier::Rig => None,
            Carrier::Actuator(a) => rig.actuators.get(a),
            Carrier::Context(c) => rig.contexts.get(c),
        }
    }
}

/// One parameter of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterSpec {
    /// Such as `width_q1`.
    pub name: String,
    /// SI.
    pub unit: String,
    /// The value at which the effect is silent (with all others at theirs).
    pub neutral: f64,
    /// A typical size: steps of differences and initial guesses are fractions of it.
    pub scale: f64,
    /// Smallest possible value.
    pub lower: f64,
    /// Largest possible value.
    pub upper: f64,
    /// Whether it may depend on a context signal, θ = θ0 + θ1·c: sizes of the effect may, shapes do not.
    pub may_vary: bool,
    /// Whether the effect only adds to the outputs and in proportion to it, y_m += Σ_j θ_j φ_j(t; other parameters), with
    /// 0 as its neutral value. For θ1 of a context too.
    pub linear: bool,
    /// Whether the lower bound, and the upper one, is a limit that a rig reaches, as tendons do that don’t stretch: a value may rest there.
    pub is_limit: [bool; 2],
}

impl ParameterSpec {
    /// The size of an effect: silent at 0, unbounded until [`ParameterSpec::within`] is called, may vary with a context.
    pub fn size(name: impl Into<String>, unit: impl Into<String>, scale: f64) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            neutral: 0.0,
            scale: if scale.is_finite() { scale.max(SMALLEST_SCALE) } else { 1.0 },
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            may_vary: true,
            linear: false,
            is_limit: [false; 2],
        }
    }

    /// The shape of an effect, such as a rate at which it fades: it rests at `value`, and does not vary with a context.
    pub fn shape(name: impl Into<String>, unit: impl Into<String>, value: f64, scale: f64) -> Self {
        Self { neutral: value, may_vary: false, ..Self::size(name, unit, scale) }
    }

    /// What the effect must know of the rig and no fit may change: both bounds at `value`, so that a saved effect keeps it.
    pub fn known(name: impl Into<String>, unit: impl Into<String>, value: f64) -> Self {
        Self { lower: value, upper: value, ..Self::shape(name, unit, value, value.abs()) }
    }

    /// Whether a fit may change it: a known value has both bounds at one place, and so has what an actuator at rest lacks.
    pub fn is_free(&self) -> bool {
        self.lower < self.upper
    }

    /// The nearest value within the bounds.
    pub fn inside(&self, value: f64) -> f64 {
        value.max(self.lower).min(self.upper)
    }

    /// Smallest and largest value along a trial in which the parameter depends on a context. A linear parameter has no
    /// bounds there: its effect has to stay proportional to θ0 and θ1.
    pub fn along(&self) -> [f64; 2] {
        if self.linear { [f64::NEG_INFINITY, f64::INFINITY] } else { [self.lower, self.upper] }
    }

    /// Whether a value rests on a bound that is neither the neutral value nor a limit that rigs reach.
    pub fn is_at_bound(&self, value: f64) -> bool {
        let rests = |bound: f64| bound != self.neutral && (value - bound).abs() < AT_BOUND * self.scale;
        self.is_free() && (rests(self.lower) && !self.is_limit[0] || rests(self.upper) && !self.is_limit[1])
    }

    /// With a lower bound that rigs reach.
    #[must_use]
    pub fn from_limit(self) -> Self {
        Self { is_limit: [true, self.is_limit[1]], ..self }
    }

    /// With an upper bound that rigs reach.
    #[must_use]
    pub fn up_to_limit(self) -> Self {
        Self { is_limit: [self.is_limit[0], true], ..self }
    }

    /// With bounds, which open to hold the neutral value where they would not.
    pub fn within(self, lower: f64, upper: f64) -> Self {
        Self { lower: lower.min(self.neutral), upper: upper.max(self.neutral), ..self }
    }
}

/// How close to a bound a value rests on it, in typical sizes.
const AT_BOUND: f64 = 1e-3;

/// So that the parameter of a signal that does not move still has a scale to divide by.
const SMALLEST_SCALE: f64 = 1e-30;

/// How an unknown state at the start of a trial fades: e^{−t/τ}, or e^{−t/τ} cos ωt and e^{−t/τ} sin ωt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Time τ in which it fades, s.
    pub memory: f64,
    /// Frequency ω at which it swings, rad/s; 0 where it does not.
    pub frequency: f64,
}

/// Values of an effect's parameters along a trial.
#[derive(Debug, Clone, Copy)]
pub struct Values<'a> {
    specs: &'a [ParameterSpec],
    base: &'a [f64],
    varying: Option<Varying<'a>>,
}

/// How values vary with a signal.
#[derive(Debug, Clone, Copy)]
struct Varying<'a> {
    /// θ1 of every parameter.
    slope: &'a [f64],
    /// θ2 of every parameter, and the ends of the signal's range; none where values are straight in it.
    bow: Option<(&'a [f64], [f64; 2])>,
    /// c [T].
    context: &'a [f64],
}

impl<'a> Values<'a> {
    /// The same values at every sample.
    pub fn constant(specs: &'a [ParameterSpec], base: &'a [f64]) -> Self {
        Self { specs, base, varying: None }
    }

    /// θ0 + θ1·c(t), within the bounds of each parameter ([`ParameterSpec::along`]).
    pub fn varying(specs: &'a [ParameterSpec], base: &'a [f64], slope: &'a [f64], context: &'a [f64]) -> Self {
        Self { specs, base, varying: Some(Varying { slope, bow: None, context }) }
    }

    /// θ0 + θ1·c(t) + θ2 (c(t) − a)(c(t) − b), within the bounds of each parameter: θ0 and θ1 are those of the line through the values at
    /// the ends a and b of the signal's range.
    pub fn bowed(self, bow: &'a [f64], ends: [f64; 2]) -> Self {
        Self { varying: self.varying.map(|varying| Varying { bow: Some((bow, ends)), ..varying }), ..self }
    }

    /// Number of parameters.
    pub fn count(&self) -> usize {
        self.specs.len()
    }

    /// Whether they are the same at every sample.
    pub fn are_constant(&self) -> bool {
        self.varying.is_none()
    }

    /// Largest value that parameter `j` may have along the trial.
    pub fn largest(&self, j: usize) -> f64 {
        if self.varying.is_some() { self.specs[j].along()[1] } else { self.base[j] }
    }

    /// Value of parameter `j` at sample `t`.
    pub fn at(&self, j: usize, t: usize) -> f64 {
        match self.varying {
            None => self.base[j],
            Some(Varying { slope, bow, context }) => {
                let context = context.get(t).copied().unwrap_or(0.0);
                let [lower, upper] = self.specs[j].along();
                let bow = bow.map_or(0.0, |(bow, [a, b])| bow[j] * (context - a) * (context - b));
                (self.base[j] + slope[j] * context + bow).max(lower).min(upper)
            }
        }
    }
}

/// What sets an effect apart from most others, for whoever looks for it or draws it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Traits {
    /// What it does is a function of the actuators at that moment: all that a nominal model misses at rest looks like it.
    pub is_static: bool,
    /// Rarely what a rig lacks, where a common effect explains as much.
    pub is_rare: bool,
    /// Straight in the actuators: a calibration of the actuation takes it up where it acts in the calibration's trials.
    pub is_calibrated_away: bool,
    /// Its size may grow with an actuator, as friction does with a pressure.
    pub follows_pressure: bool,
    /// One size for all trials, as an arm weighs what it weighs: no signal changes it.
    pub is_constant: bool,
    /// A mass that is carried: it grows with the payload from nothing.
    pub is_carried: bool,
    /// Periodic in its actuator: free where that has not been.
    pub is_periodic: bool,
    /// A resonance: the outputs turn within a few per cent of its period.
    pub is_resonance: bool,
    /// Slow, and begins anew with every trial.
    pub is_drift: bool,
    /// Best seen against the rate of its carrier.
    pub shows_against_rate: bool,
    /// What it may change places with, as an effect on the actuators.
    pub commutes: Commutes,
    /// A linear filter of each output, with one set of values: on a sum of columns it does what it does to each.
    pub is_output_filter: bool,
    /// A form that fits almost anything: what it explains, many causes may.
    pub is_generic: bool,
    /// Several of it, with times or periods of their own, add up to one with more of them.
    pub repeats: bool,
    /// The simpler effect that it takes the place of, with more parameters of the same names: where that one acts, it begins with
    /// its values.
    pub refines: Option<&'static str>,
}

/// What an effect on the actuators acts alike before and behind of.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Commutes {
    /// Nothing.
    #[default]
    No,
    /// Other linear filters.
    WithFilters,
    /// Whatever does not change with time, as a delay does.
    WithAll,
}

/// One physical effect.
pub trait Effect: Send + Sync {
    /// Stable: other programs read it.
    fn name(&self) -> &str;

    /// In words, for a reader who does not know the name: `the tip follows the actuators late`.
    fn meaning(&self) -> &str;

    /// Where it acts.
    fn site(&self) -> Site;

    /// Where the equation comes from.
    fn source(&self) -> &str;

    /// What whoever looks for it must know of it.
    fn traits(&self) -> Traits {
        Traits::default()
    }

    /// The ways in which it can act on this rig; none where the rig lacks what it needs.
    fn carriers(&self, rig: &Rig) -> Vec<Carrier>;

    /// Its parameters on this rig. What it must know of the rig to act is a parameter too ([`ParameterSpec::known`]).
    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec>;

    /// Values to start a fit from, within the bounds, none of them neutral: grids scaled from the record. Linear parameters
    /// stand at their scale.
    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>>;

    /// Acts on the next samples of a trial, in place on the columns of its site. `record`, `columns` and the context of
    /// `values` hold these samples alone; `memory` is what the effect keeps from those before, empty at the first.
    fn proceed(&self, carrier: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]);

    /// Acts on the columns of a whole trial.
    fn act(&self, carrier: Carrier, values: Values, record: &Record, columns: &mut [Vec<f64>]) {
        self.proceed(carrier, values, record, &mut Memory::of_whole_trial(), columns);
    }

    /// Time in which an unknown state at the start of a trial fades, s; none where nothing lasts.
    fn memory(&self, _values: Values) -> Option<f64> {
        None
    }

    /// A shorter time in which another part of that state fades, s.
    fn second_memory(&self, _values: Values) -> Option<f64> {
        None
    }

    /// Frequency at which an unknown state at the start swings while it fades, rad/s; 0 where it does not.
    fn swinging(&self, _values: Values) -> f64 {
        0.0
    }
}

/// The effect of a name.
pub fn find(name: &str) -> Option<&'static dyn Effect> {
    ALL.iter().copied().find(|effect| effect.name() == name)
}
