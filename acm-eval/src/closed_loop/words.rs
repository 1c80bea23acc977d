//! Names of effects and parameters as words: `viscous_friction(d)` is viscous friction of d.

use acm_core::effects::find;
use maud::{Markup, html};

/// Effects that are called after people.
const PEOPLE: [(&str, &str); 3] = [
    ("prandtl_ishlinskii", "Prandtl–Ishlinskii play"),
    ("bouc_wen", "Bouc–Wen hysteresis"),
    ("coulomb_friction", "Coulomb friction"),
];

/// A name as the search writes it, `+ coulomb_friction(x) × payload`, with its effects in words; all else stays.
pub fn effect_words(label: &str) -> String {
    let word = |token: &str| {
        let (name, carrier) = match token.split_once('(') {
            Some((name, rest)) => (name, rest.strip_suffix(')')),
            None => (token, None),
        };
        match (find(name), carrier) {
            (None, _) => token.to_string(),
            (Some(_), None) => spoken(name),
            (Some(_), Some(carrier)) => format!("{} of {carrier}", spoken(name)),
        }
    };
    label.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

fn spoken(name: &str) -> String {
    let person = PEOPLE.iter().find(|(known, _)| *known == name);
    person.map_or_else(|| name.replace('_', " "), |(_, words)| (*words).to_string())
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

/// A number with its unit, where it has one.
pub fn with_unit(number: &str, unit: &str) -> String {
    if unit == "1" { number.to_string() } else { format!("{number}\u{a0}{unit}") }
}

/// What an axis shows, with its unit in brackets, where it has one.
pub fn axis(words: &str, unit: &str) -> String {
    if matches!(unit, "" | "1") { words.to_string() } else { format!("{words} [{unit}]") }
}

/// `, in mm`, where there is a unit.
pub fn in_unit(unit: &str) -> String {
    if unit == "1" { String::new() } else { format!(", in {unit}") }
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
            ("+ coulomb_friction(x_1) + creep", "+ Coulomb friction of x_1 + creep"),
            ("bouc_wen", "Bouc–Wen hysteresis"),
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
