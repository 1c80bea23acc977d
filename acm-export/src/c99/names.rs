//! Names of inputs and outputs in C: constants with the names of the manifest, and their units.
//!
//! A name is written in capital letters, with `_` for what C does not allow; a name that is taken gets a number: `_2`, `_3`, ….

use std::collections::BTreeSet;

use acm_stream::{AverageParts, Label, Parts};

use super::text::{double, plain};

/// Returns the constants of the inputs of a sample.
pub fn inputs(average: &AverageParts) -> String {
    let all: Vec<(&str, Label)> = (0..average.inputs.len()).map(|place| input(average, place)).collect();
    constants("Places of the inputs of a sample, each with the unit that a step takes: SI", &all)
}

/// Returns the constants of the outputs of an answer.
pub fn outputs(average: &AverageParts) -> String {
    let labels = average.members[0].parts.labelled().outputs;
    let all: Vec<(&str, Label)> = labels.into_iter().map(|label| ("OUTPUT", label)).collect();
    constants("Places of the outputs of an answer, each with its unit: SI", &all)
}

/// Returns kind and label of the input at a place: those that the first member has that reads it.
fn input(average: &AverageParts, place: usize) -> (&'static str, Label) {
    let found = average.members.iter().find_map(|member| {
        let own = member.places.iter().position(|other| *other == place)?;
        Some((kind(&member.parts, own), member.parts.labelled().inputs.swap_remove(own)))
    });
    found.unwrap_or_else(|| ("UNREAD", Label::in_si(&average.inputs[place], "")))
}

fn kind(parts: &Parts, place: usize) -> &'static str {
    let actuators = parts.signals.actuators.len();
    let contexts = actuators + parts.signals.contexts.len();
    match place {
        place if place < actuators => "ACTUATOR",
        place if place < contexts => "CONTEXT",
        place if place < contexts + parts.nominal.acceleration() => "ACCELERATION",
        _ => "PREDICTED",
    }
}

fn constants(title: &str, all: &[(&str, Label)]) -> String {
    let mut taken = BTreeSet::new();
    let constant = |(place, (kind, label)): (usize, &(&str, Label))| {
        let name = identifier(kind, &label.name, place, &mut taken);
        format!("    $WHOLE_{name} = {place}, /* {} */\n", described(label))
    };
    let lines: String = all.iter().enumerate().map(constant).collect();
    format!(
        "\n/* {title}. Behind it, in parentheses, the unit of the manifest where that is another. */\nenum {{\n{lines}}};\n"
    )
}

/// Returns a name for C that no other has.
fn identifier(kind: &str, name: &str, place: usize, taken: &mut BTreeSet<String>) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
    let letters: String = name.chars().map(letter).collect();
    let words: Vec<&str> = letters.split('_').filter(|word| !word.is_empty()).collect();
    let own = if words.is_empty() { place.to_string() } else { words.join("_") };
    let base = if own.starts_with(kind) { own } else { format!("{kind}_{own}") };
    let numbered = (2..).map(|number| format!("{base}_{number}"));
    let free = std::iter::once(base.clone()).chain(numbered).find(|name| !taken.contains(name)).unwrap_or(base);
    taken.insert(free.clone());
    free
}

/// Returns name and unit of a number, for a comment.
fn described(label: &Label) -> String {
    let column = label.column.as_ref().map_or(String::new(), |column| format!(", column {column}"));
    let si = if label.si.is_empty() { "SI" } else { &label.si };
    let manifest = label.manifest.as_ref().map_or(String::new(), |manifest| {
        let offset = if manifest.offset == 0.0 { String::new() } else { format!(" + {}", double(manifest.offset)) };
        let unit = &manifest.unit;
        format!(" (manifest: {unit}; a value in {unit} times {}{offset} is SI)", double(manifest.factor))
    });
    plain(&format!("{}{column}: {si}{manifest}", label.name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_an_identifier_and_no_two_are_equal() {
        let mut taken = BTreeSet::new();
        let names = ["q1", "motors.q1", "Q1", "q1 2", "q-1", "温度", "", "output", "2nd"];
        let found: Vec<String> =
            names.iter().enumerate().map(|(k, name)| identifier("ACTUATOR", name, k, &mut taken)).collect();
        let expected = [
            "ACTUATOR_Q1",
            "ACTUATOR_MOTORS_Q1",
            "ACTUATOR_Q1_2",
            "ACTUATOR_Q1_2_2",
            "ACTUATOR_Q_1",
            "ACTUATOR_5",
            "ACTUATOR_6",
            "ACTUATOR_OUTPUT",
            "ACTUATOR_2ND",
        ];
        assert_eq!(found, expected);
        assert_eq!(identifier("ACCELERATION", "acceleration_x", 2, &mut taken), "ACCELERATION_X");
    }
}
