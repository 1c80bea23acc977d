//! Kinds of campaigns: mechanisms, pairs, several, none.

use super::truth::Class;

/// One mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // the names say it; equations stand where the mechanisms do
pub enum Cause {
    DeadTime,
    ActuatorLag,
    Resonance,
    Backlash,
    Hysteresis,
    TendonFriction,
    Creep,
    StaticGain,
    GainDrift,
    ZeroDrift,
    EncoderPeriodic,
    Coupling,
    Saturation,
    TipLoad,
    Payload,
    SelfWeight,
    Downwash,
    WakeLag,
    GroundEffect,
    SideWind,
    BaseTilt,
    MarkerOffset,
    Misregistration,
    Scale,
    MeasurementLag,
    MeasurementDrift,
    CrossTerm,
    QuadraticDrag,
    HeightGain,
    Twist,
    Slip,
    TrialOffset,
    Vibration,
    Wandering,
}

/// A campaign without a mechanism to be found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Null {
    /// White noise only.
    White,
    /// Noise that remembers, on top.
    Coloured,
    /// A nominal model that is off by about 16 mm at every trial, calibration as well.
    Misfit,
    /// Encoders that are off by up to 5 mrad.
    Encoder,
    /// The tip has an unrecorded offset of up to 15 mm in each trial.
    Offsets,
}

/// Mechanisms of a campaign, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// No mechanism.
    Null(Null),
    /// One mechanism.
    One(Cause),
    /// Two mechanisms at once.
    Two(Cause, Cause),
    /// One to six mechanisms at once; the seed draws which, and the further imperfections.
    Several(u8),
}

/// Mechanisms that the library has an effect for.
pub const INSIDE: [Cause; 26] = [
    Cause::DeadTime,
    Cause::ActuatorLag,
    Cause::Resonance,
    Cause::Backlash,
    Cause::Hysteresis,
    Cause::TendonFriction,
    Cause::Creep,
    Cause::StaticGain,
    Cause::GainDrift,
    Cause::ZeroDrift,
    Cause::EncoderPeriodic,
    Cause::Coupling,
    Cause::Saturation,
    Cause::TipLoad,
    Cause::Payload,
    Cause::SelfWeight,
    Cause::Downwash,
    Cause::WakeLag,
    Cause::GroundEffect,
    Cause::SideWind,
    Cause::BaseTilt,
    Cause::MarkerOffset,
    Cause::Misregistration,
    Cause::Scale,
    Cause::MeasurementLag,
    Cause::MeasurementDrift,
];

/// Mechanisms that no single effect of the library describes: a gain that depends on altitude is its `static_gain` with
/// a context signal.
pub const OUTSIDE: [Cause; 8] = [
    Cause::CrossTerm,
    Cause::QuadraticDrag,
    Cause::HeightGain,
    Cause::Twist,
    Cause::Slip,
    Cause::TrialOffset,
    Cause::Vibration,
    Cause::Wandering,
];

/// Pairs of mechanisms: each pair acts at two places.
pub const PAIRS: [(Cause, Cause); 8] = [
    (Cause::Backlash, Cause::Creep),
    (Cause::ActuatorLag, Cause::Downwash),
    (Cause::TendonFriction, Cause::SideWind),
    (Cause::EncoderPeriodic, Cause::WakeLag),
    (Cause::StaticGain, Cause::BaseTilt),
    (Cause::DeadTime, Cause::GroundEffect),
    (Cause::Creep, Cause::MarkerOffset),
    (Cause::Coupling, Cause::MeasurementDrift),
];

/// Campaigns without a mechanism that seeds draw.
pub const NULLS: [Null; 3] = [Null::White, Null::Coloured, Null::Misfit];

/// Every kind of campaign without a mechanism.
pub const ALL_NULLS: [Null; 5] = [Null::White, Null::Coloured, Null::Misfit, Null::Encoder, Null::Offsets];

/// Largest number of mechanisms at once.
pub const MOST: u8 = 6;

impl Kind {
    /// Returns every kind. A kind's index selects its random streams, so new kinds are added last.
    pub fn all() -> Vec<Kind> {
        let nulls = [Null::Encoder, Null::Offsets].map(Kind::Null);
        Kind::drawn().into_iter().chain(nulls).chain((1..=MOST).map(Kind::Several)).collect()
    }

    /// Returns the kinds that a seed alone draws: nulls, single mechanisms inside and outside of the library, pairs.
    pub fn drawn() -> Vec<Kind> {
        let nulls = NULLS.into_iter().map(Kind::Null);
        let ones = INSIDE.into_iter().chain(OUTSIDE).map(Kind::One);
        nulls.chain(ones).chain(PAIRS.into_iter().map(|(a, b)| Kind::Two(a, b))).collect()
    }

    /// Returns the name, such as `misfit`, `backlash`, `backlash+creep` or `several3`.
    pub fn name(self) -> String {
        match self {
            Kind::Null(null) => null.name().into(),
            Kind::One(cause) => cause.name().into(),
            Kind::Two(one, two) => format!("{}+{}", one.name(), two.name()),
            Kind::Several(many) => format!("several{many}"),
        }
    }

    /// Returns the kind of a name.
    pub fn find(name: &str) -> Option<Kind> {
        Kind::all().into_iter().find(|kind| kind.name() == name)
    }

    /// Returns the correct class of answer.
    pub fn class(self) -> Class {
        match self {
            Kind::Null(_) => Class::Null,
            Kind::One(cause) if OUTSIDE.contains(&cause) => Class::Outside,
            Kind::One(_) => Class::Inside,
            Kind::Two(..) => Class::Pair,
            Kind::Several(_) => Class::Several,
        }
    }

    /// Returns the mechanisms; none where the seed draws them.
    pub fn causes(self) -> Vec<Cause> {
        match self {
            Kind::Null(_) | Kind::Several(_) => vec![],
            Kind::One(cause) => vec![cause],
            Kind::Two(one, two) => vec![one, two],
        }
    }
}

impl Null {
    /// Returns the name of the null.
    pub fn name(self) -> &'static str {
        match self {
            Null::White => "white",
            Null::Coloured => "coloured",
            Null::Misfit => "misfit",
            Null::Encoder => "null+encoder",
            Null::Offsets => "null+offsets",
        }
    }
}

impl Cause {
    /// Returns the name; that of the library where one mechanism has it.
    pub fn name(self) -> &'static str {
        match self {
            Cause::Resonance => "resonance",
            Cause::Hysteresis => "hysteresis",
            Cause::Payload => "payload",
            Cause::CrossTerm => "cross_term",
            Cause::QuadraticDrag => "quadratic_drag",
            Cause::HeightGain => "height_gain",
            Cause::Twist => "twist",
            Cause::Slip => "slip",
            Cause::TrialOffset => "trial_offset",
            Cause::Vibration => "vibration",
            Cause::Wandering => "wandering",
            other => other.library().unwrap_or("unknown"),
        }
    }

    /// Returns the effect of the library that should be found.
    pub fn library(self) -> Option<&'static str> {
        Some(match self {
            Cause::DeadTime => "dead_time",
            Cause::ActuatorLag => "actuator_lag",
            Cause::Resonance => "second_order_lag",
            Cause::Backlash => "backlash",
            Cause::Hysteresis => "prandtl_ishlinskii",
            Cause::TendonFriction => "tendon_friction",
            Cause::Creep => "creep",
            Cause::StaticGain | Cause::HeightGain => "static_gain",
            Cause::GainDrift => "gain_drift",
            Cause::ZeroDrift => "zero_drift",
            Cause::EncoderPeriodic => "encoder_periodic",
            Cause::Coupling => "coupling",
            Cause::Saturation => "saturation",
            Cause::TipLoad | Cause::Payload => "tip_load",
            Cause::SelfWeight => "self_weight",
            Cause::Downwash => "downwash",
            Cause::WakeLag => "wake_lag",
            Cause::GroundEffect => "ground_effect",
            Cause::SideWind => "side_wind",
            Cause::BaseTilt => "base_tilt",
            Cause::MarkerOffset => "marker_offset",
            Cause::Misregistration => "misregistration",
            Cause::Scale => "scale",
            Cause::MeasurementLag => "measurement_lag",
            Cause::MeasurementDrift => "measurement_drift",
            Cause::CrossTerm
            | Cause::QuadraticDrag
            | Cause::Twist
            | Cause::Slip
            | Cause::TrialOffset
            | Cause::Vibration
            | Cause::Wandering => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_its_own_name_and_class() {
        let names: std::collections::BTreeSet<String> = Kind::all().into_iter().map(Kind::name).collect();
        assert_eq!(names.len(), Kind::all().len());
        assert!(Kind::all().into_iter().all(|kind| Kind::find(&kind.name()) == Some(kind)));
        assert!(INSIDE.iter().all(|cause| cause.library().is_some()));
        assert!(OUTSIDE.iter().all(|cause| Kind::One(*cause).class() == Class::Outside));
        let named: Vec<Cause> = OUTSIDE.into_iter().filter(|cause| cause.library().is_some()).collect();
        assert_eq!(named, [Cause::HeightGain]);
    }
}
