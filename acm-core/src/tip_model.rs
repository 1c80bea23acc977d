//! Tip model: actuation map, strain, shape and registration in one.
//!
//! ```text
//! p_k = C·U·r(L·at_k; c(q)) + p_0
//! Legendre:   c_{i,0} = A_i,   c_{i,n} = A_i a_{i,n},   (A_1, A_2) = Φ(q)       κ_i = A_i [1 + Σ a_{i,n} P_n]
//! piecewise:  c_{i,n} = A_{i,n},   all 2·segments of them from Φ(q)
//! ```
//!
//! | symbol | meaning                                         | shape   | unit  |
//! | `q`    | actuator coordinates                            | A       | SI    |
//! | `θ_Φ`  | actuation coefficients, one row per amplitude   | K × M   | see [`crate::actuation`] |
//! | `θ_s`  | strain parameters a_{1,1…m}, a_{2,1…m}          | 2m or 0 | 1     |
//! | `p`    | marker positions, x y z of each                 | 3K      | m     |
//!
//! All parameters stand in one list: θ_Φ, θ_s, then the six of [`crate::registration`].

mod block;
mod evaluate;
mod frame;
mod slopes;

pub use block::{Block, STRIDE};

use std::ops::Range;

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

use crate::actuation::{Monomials, monomials};
use crate::arm::{ArmError, ArmSpec};
use crate::kinematics::se3::Pose;
use crate::kinematics::shape::Shape;
use crate::kinematics::strain::StrainBasis;
use crate::registration;
use evaluate::{Rows, Work};
use frame::Frame;

/// A strain model with values for all its parameters.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "Stored", into = "Stored")]
pub struct StrainModel {
    arm: ArmSpec,
    at: Vec<f64>,
    actuators: usize,
    theta: Vec<f64>,
    shape: Shape,
    monomials: Monomials,
    axis: Matrix3<f64>,
    /// Frame that belongs to `theta`.
    frame: Frame,
}

/// Serialized form; the rest is computed from it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    arm: ArmSpec,
    at: Vec<f64>,
    actuators: usize,
    parameters: Vec<f64>,
}

/// A model that cannot be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// The arm itself is refused.
    #[error(transparent)]
    Arm(#[from] ArmError),
    /// Marker place out of (0, 1].
    #[error("marker {marker} is at s/L = {at}; markers lie above 0 (base) and up to 1 (tip)")]
    At {
        /// Number of the marker, from 1.
        marker: usize,
        /// As given.
        at: f64,
    },
    /// No marker or no actuator.
    #[error("the strain model has no {what}; give at least one")]
    Nothing {
        /// `marker` or `actuator`.
        what: &'static str,
    },
    /// A stored model with a wrong number of parameters.
    #[error("stored model has {found} parameters where its arm needs {needed}; calibrate again")]
    Parameters {
        /// In the file.
        found: usize,
        /// Number of parameters that arm, actuators and markers need.
        needed: usize,
    },
    /// A stored parameter is NaN or infinite.
    #[error("stored model's parameter {index} is {value}; calibrate again")]
    NotFinite {
        /// Index, counted from 0.
        index: usize,
        /// The stored value.
        value: f64,
    },
}

/// Memory of one evaluation, reused from sample to sample.
#[derive(Debug, Clone)]
pub struct Scratch {
    work: Work<f64>,
}

impl StrainModel {
    /// A model with every parameter zero, or as the registration fixes it: a straight arm.
    ///
    /// # Errors
    /// The arm is refused, there is no marker or no actuator, or a marker lies off the arm.
    pub fn new(arm: &ArmSpec, actuators: usize, at: &[f64]) -> Result<Self, ModelError> {
        arm.validate()?;
        validate_markers(at)?;
        if actuators == 0 {
            return Err(ModelError::Nothing { what: "actuator" });
        }
        let mut model = Self {
            arm: arm.clone(),
            at: at.to_vec(),
            actuators,
            theta: Vec::new(),
            shape: Shape::new(arm.length, arm.strain, at, arm.steps, arm.tolerance),
            monomials: monomials(actuators, arm.degree),
            axis: arm.axis.rotation(),
            frame: Frame::default(),
        };
        model.theta = vec![0.0; model.strain_range().end];
        model.theta.extend(arm.registration.start(arm.axis));
        model.frame = model.frame_of(&model.theta);
        Ok(model)
    }

    /// The same model with other parameters.
    ///
    /// # Panics
    /// If there is not one value for each parameter.
    pub fn with_parameters(mut self, theta: &[f64]) -> Self {
        assert_eq!(theta.len(), self.theta.len(), "one value per parameter");
        self.theta.copy_from_slice(theta);
        self.frame = self.frame_of(theta);
        self
    }

    /// All parameters: θ_Φ, θ_s, registration.
    pub fn parameters(&self) -> &[f64] {
        &self.theta
    }

    /// The arm that the model describes.
    pub fn arm(&self) -> &ArmSpec {
        &self.arm
    }

    /// The arm without its strain.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Marker places s/L.
    pub fn at(&self) -> &[f64] {
        &self.at
    }

    /// Number of actuators.
    pub fn actuators(&self) -> usize {
        self.actuators
    }

    /// Number of outputs: x, y, z of each marker.
    pub fn outputs(&self) -> usize {
        3 * self.at.len()
    }

    /// Monomials of the actuation map.
    pub fn monomials(&self) -> &Monomials {
        &self.monomials
    }

    /// Number of amplitudes that the actuation map feeds.
    pub fn amplitudes(&self) -> usize {
        match self.arm.strain {
            StrainBasis::Legendre { .. } => 2,
            StrainBasis::Piecewise { segments } => 2 * segments,
        }
    }

    /// Range of θ_Φ among the parameters.
    pub fn actuation_range(&self) -> Range<usize> {
        0..self.amplitudes() * self.monomials.len()
    }

    /// Range of θ_s among the parameters.
    pub fn strain_range(&self) -> Range<usize> {
        let start = self.actuation_range().end;
        let per_direction = match self.arm.strain {
            StrainBasis::Legendre { order } => order,
            StrainBasis::Piecewise { .. } => 0,
        };
        start..start + 2 * per_direction
    }

    /// Range of the six registration parameters.
    pub fn registration_range(&self) -> Range<usize> {
        let start = self.strain_range().end;
        start..start + 6
    }

    /// Name and unit of every parameter; `q` in a unit is the SI unit of the actuators.
    pub fn parameter_names(&self) -> Vec<(String, String)> {
        let mut names = Vec::with_capacity(self.theta.len());
        for amplitude in 0..self.amplitudes() {
            for (j, exponents) in self.monomials.exponents().iter().enumerate() {
                let name = format!("{}[{}]", self.amplitude_name(amplitude), self.monomials.name(j));
                let degree: usize = exponents.iter().sum();
                names.push((name, format!("rad/m/q^{degree}")));
            }
        }
        let orders = self.strain_range().len() / 2;
        for i in 0..2 {
            for n in 0..orders {
                let order = if orders == 1 { String::new() } else { format!(",{}", n + 1) };
                names.push((format!("a{}{order}", i + 1), "1".into()));
            }
        }
        let registration = registration::PARAMETERS.iter();
        names.extend(registration.map(|(name, unit)| (name.to_string(), unit.to_string())));
        names
    }

    fn amplitude_name(&self, amplitude: usize) -> String {
        match self.arm.strain {
            StrainBasis::Legendre { .. } => format!("A{}", amplitude + 1),
            StrainBasis::Piecewise { segments } => {
                format!("A{},{}", amplitude / segments + 1, amplitude % segments + 1)
            }
        }
    }

    /// Memory for the functions below.
    pub fn scratch(&self) -> Scratch {
        Scratch { work: self.work(0.0) }
    }

    /// Marker positions of one sample into `out` (3 per marker), m.
    pub fn predict(&self, q: &[f64], scratch: &mut Scratch, out: &mut [f64]) {
        self.predict_in(&self.frame, &self.theta, q, scratch, out);
    }

    /// [`StrainModel::predict`] with other parameters than the model's own.
    pub fn predict_with(&self, theta: &[f64], q: &[f64], scratch: &mut Scratch, out: &mut [f64]) {
        self.predict_in(&self.frame_of(theta), theta, q, scratch, out);
    }

    fn predict_in(&self, frame: &Frame, theta: &[f64], q: &[f64], scratch: &mut Scratch, out: &mut [f64]) {
        let work = &mut scratch.work;
        self.strain(theta, q, work);
        let level = self.shape.level(&work.coordinates, &mut work.shape);
        self.positions(level, frame, work, &mut Rows { table: out, width: 1 });
    }

    /// Strain coordinates of one sample, rad/m, in the order of [`crate::kinematics::shape`].
    pub fn strain_coordinates(&self, q: &[f64]) -> Vec<f64> {
        let mut scratch = self.scratch();
        self.strain(&self.theta, q, &mut scratch.work);
        scratch.work.coordinates
    }

    /// [`StrainModel::strain_coordinates`] with other parameters than the model's own; they stay in `scratch`.
    pub fn strain_coordinates_with<'a>(&self, theta: &[f64], q: &[f64], scratch: &'a mut Scratch) -> &'a [f64] {
        self.strain(theta, q, &mut scratch.work);
        &scratch.work.coordinates
    }

    /// Pose at arc length s m from the base, in the measurement frame.
    pub fn pose(&self, q: &[f64], s: f64) -> Pose {
        let local = self.shape.pose(&self.strain_coordinates(q), s);
        let mut pose = self.base_pose().then(&local);
        pose.rotation *= self.axis.transpose();
        pose
    }

    /// Where the arm's own frame (base, along +z) lies in the measurement frame.
    pub fn base_pose(&self) -> Pose {
        self.base_pose_with(&self.theta)
    }

    /// [`StrainModel::base_pose`] with other parameters than the model's own.
    pub fn base_pose_with(&self, theta: &[f64]) -> Pose {
        let frame = self.frame_of(theta);
        Pose { rotation: frame.turn, position: frame.base }
    }

    /// Positions as [`StrainModel::predict_with`], and their slopes with respect to all parameters:
    /// output o, parameter j in `slopes[o·P + j]`.
    pub fn jacobian_with(&self, theta: &[f64], q: &[f64], scratch: &mut Scratch, out: &mut [f64], slopes: &mut [f64]) {
        self.differentiate(theta, q, &mut scratch.work, out, slopes);
    }

    fn differentiate(&self, theta: &[f64], q: &[f64], work: &mut Work<f64>, out: &mut [f64], slopes: &mut [f64]) {
        let (frame, width) = (self.frame_of(theta), theta.len());
        self.strain(theta, q, work);
        let level = self.shape.level(&work.coordinates, &mut work.shape);
        self.slopes(level, &frame, theta, work, &mut Rows { table: out, width: 1 });
        self.parameter_slopes(&frame, theta, work, &mut Rows { table: slopes, width });
    }
}

fn validate_markers(at: &[f64]) -> Result<(), ModelError> {
    if at.is_empty() {
        return Err(ModelError::Nothing { what: "marker" });
    }
    match at.iter().position(|&at| !(at > 0.0 && at <= 1.0)) {
        Some(index) => Err(ModelError::At { marker: index + 1, at: at[index] }),
        None => Ok(()),
    }
}

impl From<StrainModel> for Stored {
    fn from(model: StrainModel) -> Self {
        Self { arm: model.arm, at: model.at, actuators: model.actuators, parameters: model.theta }
    }
}

impl TryFrom<Stored> for StrainModel {
    type Error = ModelError;

    fn try_from(stored: Stored) -> Result<Self, ModelError> {
        let model = StrainModel::new(&stored.arm, stored.actuators, &stored.at)?;
        let (found, needed) = (stored.parameters.len(), model.theta.len());
        if found != needed {
            return Err(ModelError::Parameters { found, needed });
        }
        if let Some(index) = stored.parameters.iter().position(|v| !v.is_finite()) {
            let value = stored.parameters[index];
            return Err(ModelError::NotFinite { index, value });
        }
        Ok(model.with_parameters(&stored.parameters))
    }
}
