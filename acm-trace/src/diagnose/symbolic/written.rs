//! The chosen terms as a formula.

use acm_core::display::significant;

use super::Column;
use super::Search;
use crate::diagnose::remainder::Remainder;
use crate::finding::{Symbolic, SymbolicTerm};

impl Search {
    /// Returns the formula with coefficients fitted to all blocks, SI.
    pub(super) fn formula(&self, remainder: &Remainder, chosen: &[Column], mean_square: f64) -> Symbolic {
        let all: Vec<usize> = self.blocks.concat();
        let coefficients = self.normal(&chosen.iter().collect::<Vec<_>>(), &all).solve();
        let on = |place: usize| match remainder.rig.actuators.get(place) {
            Some(actuator) => format!("Δ{}", actuator.name),
            None => format!("Δ{}", remainder.rig.outputs[place - self.actuators].name),
        };
        let mut places: Vec<usize> = chosen.iter().map(|column| column.place).collect();
        places.sort_unstable();
        places.dedup();
        let terms = chosen.iter().zip(coefficients.iter()).map(|(column, a)| {
            let term = &self.terms[column.term];
            SymbolicTerm { on: on(column.place), term: term.name.clone(), coefficient: a / term.scale }
        });
        let terms: Vec<SymbolicTerm> = terms.collect();
        let lines: Vec<String> = places.iter().map(|&place| line(&on(place), &terms)).collect();
        Symbolic { formula: lines.join(", "), error: mean_square.max(0.0).sqrt(), terms }
    }
}

/// Writes a line such as `Δq1 = −0.0903·q1·q2 + 0.0200·t`.
fn line(on: &str, terms: &[SymbolicTerm]) -> String {
    let mut text = String::new();
    for term in terms.iter().filter(|term| term.on == on) {
        let (value, first) = (significant(term.coefficient.abs(), 3), text.is_empty());
        text += match (first, term.coefficient < 0.0) {
            (true, true) => "−",
            (true, false) => "",
            (false, true) => " − ",
            (false, false) => " + ",
        };
        text += &if term.term == "1" { value } else { format!("{value}·{}", term.term) };
    }
    format!("{on} = {text}")
}
