//! Files on disk: atomic writes, locks on folders, resource limits, regular files, plain tables.

pub mod atomic;
pub mod limits;
pub mod lock;
pub mod regular;
pub mod table;
