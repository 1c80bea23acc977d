//! Files on disk, with atomic writes, hashes and bounded reads; and folders with locks. The layer does not interpret the files.

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
