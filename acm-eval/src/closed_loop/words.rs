//! Names of effects and parameters as words: `viscous_friction(d)` is viscous friction of d.

use acm_core::effects::find;
use maud::{Markup, html};

/// A name as the search writes it, `+ coulomb_friction(x) × payload`, with its effects in words; all else stays.
pub fn effect_words(label: &str) -> String {
    let word = |token: &str| {
        let (name, carrier) = match token.split_once('(') {
            Some((name, rest)) => (name, rest.strip_suffix(')')),
            None => (token, None),
        };
        match (find(name), carrier) {
            (None, _) => token.to_string(),
            (Some(_), None) => name.replace('_', " "),
            (Some(_), Some(carrier)) => format!("{} of {carrier}", name.replace('_', " ")),
        }
    };
    label.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// The words first, then the name that a configuration and the files have, where it is another.
pub fn effect(label: &str) -> Markup {
    with_identifier(&effect_words(label), label)
}

/// A parameter: `time_constant` is a time constant, and so is `tau`.
pub fn parameter_words(name: &str) -> String {
    let words = name.replace('_', " ");
    match words.strip_prefix("tau") {
        Some(rest) if rest.is_empty() || rest.starts_with(' ') => format!("time constant{rest}"),
        _ => words,
    }
}

/// As [`effect`].
pub fn parameter(name: &str) -> Markup {
    with_identifier(&parameter_words(name), name)
}

/// With a large first letter.
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
            ("+ coulomb_friction(x_1) + creep", "+ coulomb friction of x_1 + creep"),
            ("dead_time × pay_load", "dead time × pay_load"),
            ("payload → tip_load", "payload → tip load"),
            ("nominal + effect", "nominal + effect"),
            ("my_effect(", "my_effect("),
        ];
        pairs.iter().for_each(|(name, words)| assert_eq!(effect_words(name), *words));
        let names = ["tau", "tau_q1", "half_width_x", "taut"].map(parameter_words);
        assert_eq!(names, ["time constant", "time constant q1", "half width x", "taut"]);
    }
}
