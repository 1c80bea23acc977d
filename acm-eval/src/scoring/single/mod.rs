//! Campaigns of one cause, of pairs, of none, and of causes outside the library: rows and figures.

mod parameters;
mod row;
mod score;
mod text;

pub use parameters::{ParameterRow, parameters, with_values_without_noise};
pub use row::{Row, Top};
pub use score::{Score, Summary};
pub use text::{heading, line, table};
