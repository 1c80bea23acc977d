//! Figures of the residual characterisation. Panels (a) to (f) are those of the paper's figure.
//!
//! | figure   | panels   | shows                                                                  |
//! | -------- | -------- | ---------------------------------------------------------------------- |
//! | `size`   | (a)–(c)  | root mean square by component, by altitude, and against mean altitude  |
//! | `curves` | (d)–(f)  | mean ± sd of each component against the swept actuator, by slice       |
//! | `arm`    | (g) …    | the same in space: nominal arms with the mean residual at their tips   |

mod arm;
mod curves;
mod size;

use super::Study;
use crate::figures::Drawing;

/// Returns all figures that the record has the data for.
pub fn all(study: &Study) -> Vec<(&'static str, &'static str, Drawing)> {
    let drawn = [
        ("size", size::QUESTION, size::draw(study)),
        ("curves", curves::QUESTION, curves::draw(study)),
        ("arm", arm::QUESTION, arm::draw(study)),
    ];
    drawn.into_iter().filter_map(|(name, question, drawing)| Some((name, question, drawing?))).collect()
}
