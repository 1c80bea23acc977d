//! Files on disk: atomic writes, locks on folders, resource limits, plain tables.

pub mod atomic;
pub mod limits;
pub mod lock;
pub mod table;
