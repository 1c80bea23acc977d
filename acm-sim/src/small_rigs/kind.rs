//! The seven kinds of rigs.

use super::bench::{Bench, Ports};
use super::draw::Draw;
use super::drive::Drive;
use super::plan::{Plan, Subject};
use crate::small_rigs::kinds::axis;
use crate::small_rigs::kinds::hardening_spring;
use crate::small_rigs::kinds::heated_tank;
use crate::small_rigs::kinds::joint_with_load;
use crate::small_rigs::kinds::sheath;
use crate::small_rigs::kinds::six_joints;
use crate::small_rigs::kinds::static_map_motor;

/// A kind of rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Joint: torque from angle.
    JointWithLoad,
    /// Axis: position from command.
    Axis,
    /// Tank: temperature or level.
    HeatedTank,
    /// Position of a mass on a hardening spring.
    HardeningSpring,
    /// Displacement of a tendon's far end.
    Sheath,
    /// Motor with a static nonlinearity: its speed.
    StaticMapMotor,
    /// Drive of six joints: current from six angles.
    SixJoints,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Kind; 7] = [
        Kind::JointWithLoad,
        Kind::Axis,
        Kind::HeatedTank,
        Kind::HardeningSpring,
        Kind::Sheath,
        Kind::StaticMapMotor,
        Kind::SixJoints,
    ];

    /// Returns the name, such as `heated_tank`.
    pub fn name(self) -> &'static str {
        match self {
            Kind::JointWithLoad => "joint_with_load",
            Kind::Axis => "axis",
            Kind::HeatedTank => "heated_tank",
            Kind::HardeningSpring => "hardening_spring",
            Kind::Sheath => "sheath",
            Kind::StaticMapMotor => "static_map_motor",
            Kind::SixJoints => "six_joints",
        }
    }

    /// Returns the kind of a name.
    pub fn find(name: &str) -> Option<Kind> {
        Kind::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Returns the number of its random streams.
    pub(super) fn number(self) -> u64 {
        self as u64 + 1
    }

    /// Returns the subject of its recording.
    pub(super) fn subject(self) -> Subject {
        match self {
            Kind::HeatedTank => Subject::Slow,
            Kind::JointWithLoad | Kind::SixJoints => Subject::Torque,
            _ => Subject::Fast,
        }
    }

    pub(super) fn ports(self, draw: &mut Draw) -> Ports {
        match self {
            Kind::JointWithLoad => joint_with_load::ports(draw),
            Kind::Axis => axis::ports(draw),
            Kind::HeatedTank => heated_tank::ports(draw),
            Kind::HardeningSpring => hardening_spring::ports(draw),
            Kind::Sheath => sheath::ports(draw),
            Kind::StaticMapMotor => static_map_motor::ports(draw),
            Kind::SixJoints => six_joints::ports(draw),
        }
    }

    /// Returns the joint whose motion the output depends on.
    pub(super) fn joint(self, draw: &mut Draw) -> Option<usize> {
        match self {
            Kind::JointWithLoad => Some(0),
            Kind::SixJoints => Some(six_joints::joint(draw)),
            _ => None,
        }
    }

    pub(super) fn build(
        self,
        ports: &Ports,
        plan: &Plan,
        joint: Option<usize>,
        drive: &Drive,
        draw: &mut Draw,
    ) -> Bench {
        match self {
            Kind::JointWithLoad => joint_with_load::build(ports, drive, draw),
            Kind::Axis => axis::build(ports, plan, draw),
            Kind::HeatedTank => heated_tank::build(ports, plan, draw),
            Kind::HardeningSpring => hardening_spring::build(ports, plan, draw),
            Kind::Sheath => sheath::build(ports, plan, draw),
            Kind::StaticMapMotor => static_map_motor::build(ports, plan, draw),
            Kind::SixJoints => six_joints::build(ports, joint.unwrap_or(0), drive, draw),
        }
    }
}
