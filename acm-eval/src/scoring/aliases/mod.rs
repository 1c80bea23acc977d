//! Aliases: effects of the library that data of a kind cannot distinguish. A command measures the table, and scoring reads it.
//!
//! ```text
//! share(A by B) = 1 − min over θ_B, β of ‖y_A − f(θ_B, β)‖² / min over β of ‖y_A − f(β)‖²
//! alias:        share(A by B) ≥ 0.98  and  share(B by A) ≥ 0.98
//! ```
//!
//! | symbol | meaning                                                                      | shape |
//! | `y_A`  | outputs of the nominal model with effect A, without noise                    | N × M |
//! | `f`    | the regression that the search fits: nominal form of cubic correction, with effect B | N × M |
//! | `β`    | coefficients of the correction and linear parameters of B                    |       |
//! | `θ_B`  | nonlinear parameters of B                                                    |       |
//!
//! | file | what |
//! | --- | --- |
//! | [`table`] | the table, and what is looked up in it |
//! | [`place`] | trials on which effects are planted: the arm by design, small rigs by kind |
//! | [`planted`] | one effect of a given size in outputs without noise |
//! | [`explained`] | how much of it another effect explains |
//! | [`measure`] | all pairs of all places |

mod explained;
mod measure;
mod place;
mod planted;
mod table;

pub use measure::measure;
pub use place::PLACES;
pub use table::{ALIAS, LEVELS, Table};
