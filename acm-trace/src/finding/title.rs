//! Names of effects and parameters in words: stable names are for files, titles for readers.

/// Returns the title of an effect, such as `Coulomb friction` for `coulomb_friction`.
pub fn effect_title(name: &str) -> String {
    match name {
        "bouc_wen" => "Bouc–Wen hysteresis".into(),
        "output_bouc_wen" => "Bouc–Wen hysteresis of the outputs".into(),
        "output_prandtl_ishlinskii" => "Prandtl–Ishlinskii hysteresis of the outputs".into(),
        "prandtl_ishlinskii" => "Prandtl–Ishlinskii play".into(),
        "stribeck_friction" => "Stribeck friction".into(),
        "coulomb_friction" => "Coulomb friction".into(),
        "dahl_friction" => "Dahl friction".into(),
        "lugre_friction" => "LuGre friction".into(),
        other => other.replace('_', " "),
    }
}

/// Returns the title of a parameter, such as `width of q1` for `width_q1`, `stiffness 2 of y` for `stiffness_2_y`, or `width of q1
/// per payload` where it depends on that signal.
pub fn parameter_title(name: &str) -> String {
    let (own, per) = name.split_once(" per ").map_or((name, None), |(own, per)| (own, Some(per)));
    let own = match own.split_once('_') {
        Some(("tau", signal)) => format!("time constant of {signal}"),
        None if own == "tau" => "time constant".into(),
        Some((word, number)) if is_number(number) => format!("{word} {number}"),
        Some((word, rest)) => match rest.split_once('_') {
            Some((number, signal)) if is_number(number) => format!("{word} {number} of {signal}"),
            _ => format!("{word} of {rest}"),
        },
        None => own.into(),
    };
    per.map_or(own.clone(), |per| format!("{own} per {per}"))
}

fn is_number(word: &str) -> bool {
    word.chars().all(|c| c.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_words() {
        let titles =
            ["width_q1", "width_q1 per payload", "weight_2", "presliding", "gain_motor_1"].map(parameter_title);
        assert_eq!(titles, ["width of q1", "width of q1 per payload", "weight 2", "presliding", "gain of motor_1"]);
        assert_eq!(["stiffness_2_y", "radius_12"].map(parameter_title), ["stiffness 2 of y", "radius 12"]);
        assert_eq!(["dead_time", "coulomb_friction"].map(effect_title), ["dead time", "Coulomb friction"]);
    }
}
