//! `[arm]`: geometry of a continuum arm, from which the default nominal model is built.

use acm_core::arm::ArmSpec;
use acm_core::axis::Axis;
use acm_core::registration::RegistrationSpec;
use acm_core::strain::StrainBasis;
use serde::{Deserialize, Serialize};

use super::Quantity;

/// A continuum arm.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Arm {
    /// Length of the backbone.
    pub length: Quantity,
    /// Where the straight arm points, roughly: `x`, `y`, `z`, `-x`, `-y` or `-z`; `-z` where it is omitted.
    pub axis: Option<String>,
    /// Where gravity points in the measurement frame; where it is omitted, `-y` for an arm along `-y`, else `-z`.
    pub down: Option<String>,
    /// Strain basis; linear Legendre where it is omitted.
    pub strain: Strain,
    /// Actuation map.
    pub actuation: Actuation,
    /// Integration steps along the arm.
    pub steps: Option<usize>,
    /// Tolerance of the integration, m.
    pub tolerance: Option<f64>,
    /// Pose of the base in the measurement frame; identified from the calibration trials where it is omitted.
    pub registration: Option<Registration>,
}

/// `{ basis = "legendre", order = 1 }` or `{ basis = "piecewise", segments = 3 }`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Strain {
    /// `legendre` or `piecewise`.
    pub basis: Option<String>,
    /// Order of the Legendre polynomials.
    pub order: Option<usize>,
    /// Number of segments of constant strain.
    pub segments: Option<usize>,
}

/// `{ kind = "identified", twist = false }` or `{ kind = "fixed", rotation = [0, 0, 0], translation = [0, 0, 0] }`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Registration {
    /// `identified` or `fixed`.
    pub kind: Option<String>,
    /// Whether the twist about the arm is identified too.
    pub twist: Option<bool>,
    /// Rotation vector, rad.
    pub rotation: Option<[f64; 3]>,
    /// Translation, m.
    pub translation: Option<[f64; 3]>,
}

/// `actuation = { degree = 3 }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Actuation {
    /// Degree of the polynomial from actuators to strain amplitudes.
    pub degree: usize,
}

impl Default for Actuation {
    fn default() -> Self {
        Actuation { degree: 3 }
    }
}

impl Arm {
    /// Where gravity points. An arm along −y hangs in a frame whose y is up, as motion capture has it.
    pub fn down(&self) -> Axis {
        let named = |name: &Option<String>| name.as_deref().and_then(axis);
        let usual = if named(&self.axis) == Some(Axis::MinusY) { Axis::MinusY } else { Axis::MinusZ };
        named(&self.down).unwrap_or(usual)
    }

    /// The arm as the physics takes it; meaningful for a manifest that was validated.
    pub fn spec(&self) -> ArmSpec {
        let usual = ArmSpec::default();
        ArmSpec {
            length: self.length.si(),
            axis: self.axis.as_deref().and_then(axis).unwrap_or(usual.axis),
            strain: match (self.strain.basis.as_deref(), self.strain.segments) {
                (Some("piecewise"), Some(segments)) => StrainBasis::Piecewise { segments },
                _ => StrainBasis::Legendre { order: self.strain.order.unwrap_or(1) },
            },
            degree: self.actuation.degree,
            steps: self.steps.unwrap_or(usual.steps),
            tolerance: self.tolerance,
            registration: self.registration.as_ref().map_or(usual.registration, Registration::spec),
        }
    }
}

impl Registration {
    fn spec(&self) -> RegistrationSpec {
        match self.kind.as_deref() {
            Some("fixed") => RegistrationSpec::Fixed {
                rotation: self.rotation.unwrap_or_default(),
                translation: self.translation.unwrap_or_default(),
            },
            _ => RegistrationSpec::Identified { twist: self.twist.unwrap_or(false) },
        }
    }
}

fn axis(name: &str) -> Option<Axis> {
    Some(match name {
        "x" => Axis::X,
        "y" => Axis::Y,
        "z" => Axis::Z,
        "-x" => Axis::MinusX,
        "-y" => Axis::MinusY,
        "-z" => Axis::MinusZ,
        _ => return None,
    })
}
