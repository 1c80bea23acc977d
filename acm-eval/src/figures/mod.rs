//! Figures of a section: one question and one file each, listed in [`ALL`].
//!
//! To add one: a file with a `QUESTION` and a `draw`, and a line in the list. The contract test draws every entry.

mod arm;
pub mod canvas;
mod learning;
pub mod plotted;
mod r2;
mod residual;
mod rmse;
pub(crate) mod short;
mod time;

pub use canvas::drawing::Drawing;

use crate::section::Section;

/// Figure: its question, and how the records answer.
pub struct Figure {
    /// Name of the files, and of the anchor on the page.
    pub name: &'static str,
    /// Question that the figure answers; the caption's title.
    pub question: &'static str,
    /// Function that draws it; `None` where the records lack the data.
    pub draw: fn(&Section) -> Option<Drawing>,
}

/// Every figure, in the order of the page.
pub const ALL: &[Figure] = &[
    Figure { name: "rmse", question: rmse::QUESTION, draw: rmse::draw },
    Figure { name: "r2", question: r2::QUESTION, draw: r2::draw },
    Figure { name: "residual", question: residual::QUESTION, draw: residual::draw },
    Figure { name: "time", question: time::QUESTION, draw: time::draw },
    Figure { name: "arm", question: arm::QUESTION, draw: arm::draw },
    Figure { name: "learning", question: learning::QUESTION, draw: learning::draw },
];
