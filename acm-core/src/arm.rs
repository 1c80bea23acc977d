//! Specification of a continuum arm before calibration.

use serde::{Deserialize, Serialize};

use crate::actuation::LARGEST_DEGREE;
use crate::kinematics::axis::Axis;
use crate::kinematics::strain::{LARGEST, StrainBasis};
use crate::registration::RegistrationSpec;

/// Most integration steps that are accepted.
pub const LARGEST_STEPS: usize = 4096;

/// Geometry and model order of a continuum arm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ArmSpec {
    /// Arc length from base to tip, m.
    pub length: f64,
    /// Approximate direction of the straight arm in the measurement frame.
    pub axis: Axis,
    /// Basis of the bending along the arm.
    pub strain: StrainBasis,
    /// Degree of the actuation map.
    pub degree: usize,
    /// Least number of integration steps from base to tip.
    pub steps: usize,
    /// Wanted accuracy of the integration, m; the step count is doubled until it is met.
    pub tolerance: Option<f64>,
    /// Pose of the base.
    pub registration: RegistrationSpec,
}

impl Default for ArmSpec {
    /// The paper's arm: 0.62 m, hanging, linear strain, cubic actuation map.
    fn default() -> Self {
        Self {
            length: 0.62,
            axis: Axis::MinusZ,
            strain: StrainBasis::default(),
            degree: 3,
            // Within a micrometre where both curvatures are at most 4 rad/m at the middle and 8 rad/m at the ends.
            steps: 6,
            tolerance: None,
            registration: RegistrationSpec::default(),
        }
    }
}

/// Reasons why an arm is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ArmError {
    /// Length is not a positive number.
    #[error("arm length is {length} m; give a positive length in metres")]
    Length {
        /// As given, m.
        length: f64,
    },
    /// Order, segments, degree or steps out of range.
    #[error("{what} is {value}; choose {least} to {most}")]
    OutOfRange {
        /// Name of the field.
        what: &'static str,
        /// As given.
        value: usize,
        /// Smallest accepted.
        least: usize,
        /// Largest accepted.
        most: usize,
    },
    /// Tolerance is not a positive number.
    #[error("tolerance is {tolerance} m; give a positive number such as 1e-9, or leave it out for a fixed step count")]
    Tolerance {
        /// As given, m.
        tolerance: f64,
    },
    /// Registration holds NaN or infinity.
    #[error("registration.{what} has {value}; give finite numbers (rotation in rad, translation in m)")]
    Registration {
        /// `rotation` or `translation`.
        what: &'static str,
        /// The offending number.
        value: f64,
    },
}

impl ArmSpec {
    /// Validates all values.
    ///
    /// # Errors
    /// The first invalid value.
    pub fn validate(&self) -> Result<(), ArmError> {
        if !(self.length.is_finite() && self.length > 0.0) {
            return Err(ArmError::Length { length: self.length });
        }
        match self.strain {
            StrainBasis::Legendre { order } => within("strain.order", order, 0, LARGEST)?,
            StrainBasis::Piecewise { segments } => within("strain.segments", segments, 1, LARGEST)?,
        }
        within("degree", self.degree, 1, LARGEST_DEGREE)?;
        within("steps", self.steps, 1, LARGEST_STEPS)?;
        if let Some(tolerance) = self.tolerance
            && !(tolerance.is_finite() && tolerance > 0.0)
        {
            return Err(ArmError::Tolerance { tolerance });
        }
        self.validate_registration()
    }

    fn validate_registration(&self) -> Result<(), ArmError> {
        let RegistrationSpec::Fixed { rotation, translation } = self.registration else {
            return Ok(());
        };
        for (what, values) in [("rotation", rotation), ("translation", translation)] {
            if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
                return Err(ArmError::Registration { what, value });
            }
        }
        Ok(())
    }
}

fn within(what: &'static str, value: usize, least: usize, most: usize) -> Result<(), ArmError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(ArmError::OutOfRange { what, value, least, most })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(change: impl Fn(&mut ArmSpec)) -> String {
        let mut arm = ArmSpec::default();
        change(&mut arm);
        arm.validate().map_or_else(|error| error.to_string(), |()| String::new())
    }

    #[test]
    fn every_refusal_names_value_and_remedy() {
        assert_eq!(message(|_| ()), "");
        for length in [0.0, -0.6, f64::NAN, f64::INFINITY] {
            let text = message(|arm| arm.length = length);
            assert!(text.contains(&length.to_string()) && text.contains("positive"), "{text}");
        }
        assert!(message(|arm| arm.degree = 0).contains("degree is 0; choose 1 to 9"));
        assert!(message(|arm| arm.steps = 0).contains("steps is 0"));
        assert!(message(|arm| arm.strain = StrainBasis::Piecewise { segments: 0 }).contains("strain.segments is 0"));
        assert!(message(|arm| arm.strain = StrainBasis::Legendre { order: 65 }).contains("strain.order is 65"));
        assert!(message(|arm| arm.tolerance = Some(-1.0)).contains("1e-9"));
        let lost = RegistrationSpec::Fixed { rotation: [0.0; 3], translation: [0.0, f64::NAN, 0.0] };
        assert!(message(|arm| arm.registration = lost).contains("registration.translation has NaN"));
    }

    #[test]
    fn unknown_keys_are_refused_and_missing_ones_have_defaults() {
        let arm: ArmSpec = serde_json::from_str(r#"{"length": 0.4, "axis": "-y"}"#).unwrap();
        assert_eq!((arm.length, arm.axis, arm.degree), (0.4, Axis::MinusY, 3));
        assert!(serde_json::from_str::<ArmSpec>(r#"{"lenght": 0.4}"#).is_err());
    }
}
