//! What acts on the arm from outside: the vehicle, the air about it, wind.

pub mod air;
pub mod flight;
pub mod transport;
pub mod wind;
