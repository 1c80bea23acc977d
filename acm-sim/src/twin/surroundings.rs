//! External influences on the arm: the vehicle, the air about it, wind.

pub mod air;
pub mod flight;
pub mod transport;
pub mod wind;
