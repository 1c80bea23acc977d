//! Names of effects and parameters as words: `viscous_friction(d)` is viscous friction of d.

use acm_core::effects::find;
use acm_trace::finding::title::{effect_title, parameter_title};
use maud::{Markup, html};

/// Returns a name as the search writes it, `+ coulomb_friction(x) × payload`, with its effects in words; all else
/// stays.
pub fn effect_words(label: &str) -> String {
    let word = |token: &str| {
        let (name, carrier) = match token.split_once('(') {
            Some((name, rest)) => (name, rest.strip_suffix(')')),
            None => (token, None),
        };
        match (find(name), carrier) {
            (None, _) if name == "clock_correction" => "clock correction".into(),
            (None, _) => token.to_string(),
            (Some(_), None) => effect_title(name),
            (Some(_), Some(carrier)) => format!("{} of {carrier}", effect_title(name)),
        }
    };
    label.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// Writes the words first, then the name that a configuration and the files have, where it is another.
pub fn effect(label: &str) -> Markup {
    with_identifier(&effect_words(label), label)
}

/// Marks up the name of a parameter, as [`effect`] does.
pub fn parameter(name: &str) -> Markup {
    with_identifier(&parameter_title(name), name)
}

/// Writes `, in mm`, where there is a unit.
pub fn in_unit(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(", in {unit}") }
}

/// Returns the text with a capital first letter.
pub fn capitalized(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn with_identifier(words: &str, name: &str) -> Markup {
    let long = words.chars().count() > 32;
    html! {
        @if long { span.wrap { (words) } } @else { (words) }
        @if words != name { " " code.identifier { (name) } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_effects_become_words_and_all_else_stays() {
        let pairs = [
            ("viscous_friction(d)", "viscous friction of d"),
            ("+ coulomb_friction(x_1) + creep", "+ Coulomb friction of x_1 + creep"),
            ("bouc_wen", "Bouc–Wen hysteresis"),
            ("dead_time × pay_load", "dead time × pay_load"),
            ("payload → tip_load", "payload → tip load"),
            ("nominal + effect", "nominal + effect"),
            ("+ clock_correction", "+ clock correction"),
            ("my_effect(", "my_effect("),
        ];
        pairs.iter().for_each(|(name, words)| assert_eq!(effect_words(name), *words));
    }
}
