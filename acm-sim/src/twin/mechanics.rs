//! The arm itself: its rod, tendons, sheath, cam and creep, and their equilibrium.

pub mod cam;
pub mod creep;
pub mod equilibrium;
pub mod rod;
pub mod sheath;
pub mod tendons;
