//! Files on disk: atomic writes, locks on folders, owned and regular files, resource limits, plain tables.

pub mod atomic;
pub mod limits;
pub mod lock;
pub mod owned;
pub mod regular;
pub mod table;
