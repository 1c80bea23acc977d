//! Figures of the nominal study. Panels (a) to (i) are those of the paper's figure; (j) it lacks.
//!
//! | figure     | panels   | shows                                                                     |
//! | ---------- | -------- | ------------------------------------------------------------------------- |
//! | `orders`   | (a)      | error of each strain order, binned and raw, under both protocols          |
//! | `models`   | (b), (c) | error of polynomial and strain model by coordinate, and by trial          |
//! | `tip`      | (d)–(f)  | measured and predicted coordinates against the swept actuator             |
//! | `plane`    | (g)–(i)  | the tip's path in the plane, constant strain against each higher order    |
//! | `left-out` | (j)      | error on each trial as predicted by a fit to the others                   |

mod left_out;
mod models;
mod orders;
mod plane;
mod tip;

use super::Study;
use crate::figures::Drawing;

/// Returns all figures that the record has the data for.
pub fn all(study: &Study) -> Vec<(&'static str, &'static str, Drawing)> {
    let drawn = [
        ("orders", orders::QUESTION, orders::draw(study)),
        ("models", models::QUESTION, models::draw(study)),
        ("tip", tip::QUESTION, tip::draw(study)),
        ("plane", plane::QUESTION, plane::draw(study)),
        ("left-out", left_out::QUESTION, left_out::draw(study)),
    ];
    drawn.into_iter().filter_map(|(name, question, drawing)| Some((name, question, drawing?))).collect()
}
