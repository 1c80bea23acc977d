//! The seven kinds of small rigs, and the parts that several of them have.

pub mod axis;
pub mod hardening_spring;
pub mod heated_tank;
pub mod joint_with_load;
pub mod parts;
pub mod sheath;
pub mod six_joints;
pub mod static_map_motor;
