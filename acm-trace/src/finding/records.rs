//! The parts of a finding as they are written.

pub mod before;
pub mod data;
pub mod drawn;
pub mod effects;
pub mod errors;
pub mod formula;
pub mod left;
pub mod networks;
pub mod open;
pub mod steps;
