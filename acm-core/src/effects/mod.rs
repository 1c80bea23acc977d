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
//! An effect processes a trial from its first sample on, as a whole or piece by piece ([`Effect::proceed`]), and may have
//! memory. It works on the original time stamps; signals are linearly interpolated between samples. At the last sample of
//! a piece it gives the result of a trial that ends there. At its neutral values it changes nothing. To add an effect,
//! write a file with its equation, units and source in the module of its site, and list it in [`ALL`]; the contract test
//! then checks it. Effects that a file defines are [`own`].
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

/// The signal that an effect acts through, or the rig as a whole.
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

/// How an unknown initial state of a trial decays: e^{−t/τ}, or e^{−t/τ} cos ωt and e^{−t/τ} sin ωt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Time constant τ, s.
    pub memory: f64,
    /// Angular frequency ω, rad/s; 0 if it does not oscillate.
    pub frequency: f64,
}

/// Properties of an effect that the search and the figures use.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Traits {
    /// A function of the present sample: any static error of the nominal model may look like it.
    pub is_static: bool,
    /// Rare: a common effect is preferred where it explains as much.
    pub is_rare: bool,
    /// Linear in the actuators: a calibration of the actuation absorbs it where it acts in the calibration trials.
    pub is_calibrated_away: bool,
    /// Its size may grow with an actuator, as friction does with a pressure.
    pub follows_pressure: bool,
    /// One size for all trials, as the weight of an arm: no signal changes it.
    pub is_constant: bool,
    /// A carried mass: its size is proportional to the payload.
    pub is_carried: bool,
    /// Periodic in its actuator: undetermined where unsampled.
    pub is_periodic: bool,
    /// A resonance: sensitive to a few per cent of its period.
    pub is_resonance: bool,
    /// Slow, and begins anew with every trial.
    pub is_drift: bool,
    /// Best seen against the rate of its carrier.
    pub shows_against_rate: bool,
    /// Which effects it commutes with, as an actuator effect.
    pub commutes: Commutes,
    /// A linear filter of each output, with one set of values: the columns of a sum may be filtered one by one.
    pub is_output_filter: bool,
    /// A form that fits almost anything: many causes may explain the same.
    pub is_generic: bool,
    /// Several of it, each with its own time or period, act as one of higher order.
    pub repeats: bool,
    /// The simpler effect that it replaces. It has the same parameters and more; where the simpler effect acts, it starts from
    /// its values.
    pub refines: Option<&'static str>,
    /// Another effect of the same kind that it may replace.
    pub replaces: Option<&'static str>,
}

impl Traits {
    /// Returns whether it refines or replaces the effect `name`.
    pub fn takes_place_of(&self, name: &str) -> bool {
        [self.refines, self.replaces].contains(&Some(name))
    }
}

/// Which effects an actuator effect commutes with.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Commutes {
    /// Nothing.
    #[default]
    No,
    /// Other linear filters.
    WithFilters,
    /// All time-invariant effects, as a delay does.
    WithAll,
}

/// One physical effect.
pub trait Effect: Send + Sync {
    /// Stable name; programs read it.
    fn name(&self) -> &str;

    /// Meaning in words, for readers: `the outputs follow the actuators after a fixed delay`.
    fn meaning(&self) -> &str;

    /// Where it acts.
    fn site(&self) -> Site;

    /// Where the equation comes from.
    fn source(&self) -> &str;

    /// Properties for search and figures.
    fn traits(&self) -> Traits {
        Traits::default()
    }

    /// The ways in which it can act on this rig; none where the rig lacks what it needs.
    fn carriers(&self, rig: &Rig) -> Vec<Carrier>;

    /// Its parameters on this rig, with known values of the rig that it needs ([`ParameterSpec::known`]).
    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec>;

    /// Initial values of a fit, within the bounds and none neutral: grids scaled from the record. Linear parameters are at
    /// their scale.
    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>>;

    /// Acts on the next samples of a trial, in place on the columns of its site. `record`, `columns` and the context of
    /// `values` hold these samples alone; `memory` is what the effect keeps from those before, empty at the first.
    fn proceed(&self, carrier: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]);

    /// Acts on the columns of a whole trial.
    fn act(&self, carrier: Carrier, values: Values, record: &Record, columns: &mut [Vec<f64>]) {
        self.proceed(carrier, values, record, &mut Memory::of_whole_trial(), columns);
    }

    /// Time constant with which an unknown initial state decays, s; none without memory.
    fn memory(&self, _values: Values) -> Option<f64> {
        None
    }

    /// A shorter time constant, of another part of that state, s.
    fn second_memory(&self, _values: Values) -> Option<f64> {
        None
    }

    /// Angular frequency of an unknown initial state while it decays, rad/s; 0 without oscillation.
    fn swinging(&self, _values: Values) -> f64 {
        0.0
    }
}

/// The effect of a name.
pub fn find(name: &str) -> Option<&'static dyn Effect> {
    ALL.iter().copied().find(|effect| effect.name() == name)
}
