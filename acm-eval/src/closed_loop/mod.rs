//! The finding of a closed loop, for people: a page, figures, and a summary for the terminal.
//!
//! ```text
//! loop.json         ─ Finding ─────▶ page, figures::ALL ─▶ SVG, PNG; numbers ─▶ CSV; summary
//! separability.json ─ Separability ─▶ separability_page, figures::matrix ─▶ SVG, PNG; numbers ─▶ CSV; separability_summary
//! ```
//!
//! Everything is drawn from one value; nothing is fitted or judged here.

mod apart;
pub mod beside;
mod confirmation;
mod effects;
pub mod figures;
mod left;
mod markup;
mod numbers;
mod outcome;
mod page;
mod quantity;
mod readable;
mod search;
mod separability_page;
mod stamp;
mod summary;
mod verdict;
mod words;

pub use numbers::{of_finding as finding_tables, of_separability as separability_tables};
pub use page::{head, page};
pub use separability_page::{separability_page, separability_summary, write_separability};
pub use summary::summary;
