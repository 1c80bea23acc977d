//! Figures over answers: names, shares, intervals; in the terminal, as Markdown, and drawn.

mod diagram;
mod lines;
mod reliability;
mod several;
mod small_rigs;

pub use diagram::{QUESTION, diagram};
pub use lines::{
    Look, compared, pooled_table, rig_heading, rig_line, rig_table, several_heading, several_line, several_table,
};
pub use reliability::{Bin, reliability};
pub use several::{Figures, SeveralRow};
pub use small_rigs::{RigFigures, RigRow, RigScore};
