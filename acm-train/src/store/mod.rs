//! Files on the disk: written whole or not at all, with their hash, up to a length that could be right; and folders, each held by
//! a lock. Nothing here knows what the files say.

pub mod atomic;
pub mod bounded;
mod claim;
mod differences;
mod error;
pub mod hashed;
mod hold;
mod run_folder;
mod shared;
mod study_folder;

pub use error::StoreError;
pub use hold::Hold;
pub use run_folder::RunFolder;
pub use study_folder::StudyFolder;

pub(crate) use claim::{claim, in_use};
pub(crate) use differences::differences;
pub(crate) use error::rises;
