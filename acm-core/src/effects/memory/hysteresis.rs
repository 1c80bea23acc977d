//! Operators with memory of a path.

mod bouc_wen;
mod lugre;
mod play;

pub use bouc_wen::BoucWen;
pub use lugre::LuGre;
pub use play::{Play, play};
