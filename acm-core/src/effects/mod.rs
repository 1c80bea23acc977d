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
mod parameter;
pub mod times;
mod values;

use serde::{Deserialize, Serialize};

pub use crate::record::Record;
pub use crate::rig::Rig;
pub use memory::Memory;
pub use parameter::ParameterSpec;
pub use values::Values;

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
    &actuation::lag::overflow::Overflow,
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
    &output::output_prandtl_ishlinskii::OutputPrandtlIshlinskii,
    &output::vibration_mode::VibrationMode,
    &output::output_bouc_wen::OutputBoucWen,
    &output::coulomb_friction::CoulombFriction,
    &output::dahl_friction::DahlFriction,
    &output::lugre_friction::LugreFriction,
    &output::stribeck_friction::StribeckFriction,
    &output::viscous_friction::ViscousFriction,
    &output::inertia::Inertia,
    &output::joint_gravity::JointGravity,
    &output::context::context_term::ContextTerm,
    &output::context::context_lag::ContextLag,
    &output::context::context_gain::ContextGain,
    &output::measurement::measurement_second_order::MeasurementSecondOrder,
    &output::measurement::measurement_lag::MeasurementLag,
    &output::measurement::measurement_creep::MeasurementCreep,
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

/// How an unknown state at the start of a trial fades: e^{−t/τ}, or e^{−t/τ} cos ωt and e^{−t/τ} sin ωt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Time τ in which it fades, s.
    pub memory: f64,
    /// Frequency ω at which it swings, rad/s; 0 where it does not.
    pub frequency: f64,
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
    /// Another effect of the same kind that it may take the place of.
    pub replaces: Option<&'static str>,
}

impl Traits {
    /// Returns whether it takes the place of this effect, with more parameters.
    pub fn takes_place_of(&self, name: &str) -> bool {
        [self.refines, self.replaces].contains(&Some(name))
    }
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

    /// In words, for a reader who does not know the name: `the outputs follow the actuators after a fixed delay`.
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
