//! The finding of a closed loop, for people: a page, figures, and a summary for the terminal.
//!
//! ```text
//! loop.json         ─ Finding ─────▶ page, figures::ALL ─▶ SVG, PNG; numbers ─▶ CSV; summary
//! separability.json ─ Separability ─▶ separability_page, figures::matrix ─▶ SVG, PNG; numbers ─▶ CSV; separability_summary
//! ```
//!
//! Everything is drawn from one value; nothing is fitted or judged here. [`folder`] is the folder of the result.

pub mod figures;
pub mod folder;
mod outcome;
pub mod page;
mod quantity;
mod readable;
mod summary;
mod words;

pub use page::numbers::{of_finding as finding_tables, of_separability as separability_tables};
pub use page::separability::{claim_separability, separability_page, separability_summary, write_separability};
pub use page::{head, page};
pub use summary::summary;
