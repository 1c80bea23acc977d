//! Effects and nominal models of one's own.

pub mod effects;
pub mod nominal;
