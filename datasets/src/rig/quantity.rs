//! Context signals that are throttle, altitude and payload: as the manifest states, or by name.
//!
//! A name is taken in lower case and without a number at its end; it counts as a whole, or by one of its words, and
//! only with a unit that fits.
//!
//! | quantity | names                                                  | dimension                            |
//! | -------- | ------------------------------------------------------ | ------------------------------------ |
//! | throttle | throttle thr thrust rotor rotors propeller             | one, or force: both as the jet's pressure |
//! | altitude | altitude alt agl height elevation; `h` as a whole      | length                               |
//! | payload  | payload load; `payload_mass`, `tip_mass` as a whole    | mass                                 |

use acm_core::rig;

use crate::manifest::{PhysicalQuantity, Signal};
use crate::units::Unit;

/// Index among `contexts`, of which the first are the signals of the manifest.
pub fn find(wanted: PhysicalQuantity, declared: &[Signal], contexts: &[rig::Signal]) -> Option<usize> {
    let said = declared.iter().position(|signal| signal.quantity == Some(wanted));
    let silent = |index: &usize| declared.get(*index).is_none_or(|signal| signal.quantity.is_none());
    let by = |rule: fn(&str, PhysicalQuantity) -> bool| {
        let fits = |index: &usize| Unit::parse(&contexts[*index].unit).is_ok_and(|u| wanted.fits(u.dimension));
        (0..contexts.len()).filter(silent).filter(fits).find(|index| rule(&contexts[*index].name, wanted))
    };
    said.or_else(|| by(is_called)).or_else(|| by(has_word))
}

fn is_called(name: &str, wanted: PhysicalQuantity) -> bool {
    let name = plain(name);
    let whole: &[&str] = match wanted {
        PhysicalQuantity::Throttle => &[],
        PhysicalQuantity::Altitude => &["h"],
        PhysicalQuantity::Payload => &["payload_mass", "payloadmass", "tip_mass"],
    };
    whole.contains(&name.as_str()) || words(wanted).contains(&name.as_str())
}

fn has_word(name: &str, wanted: PhysicalQuantity) -> bool {
    let name = name.to_lowercase();
    name.split(|c: char| !c.is_alphanumeric()).any(|word| words(wanted).contains(&plain(word).as_str()))
}

fn words(wanted: PhysicalQuantity) -> &'static [&'static str] {
    match wanted {
        PhysicalQuantity::Throttle => &["throttle", "thr", "thrust", "rotor", "rotors", "propeller"],
        PhysicalQuantity::Altitude => &["altitude", "alt", "agl", "height", "elevation"],
        PhysicalQuantity::Payload => &["payload", "load"],
    }
}

fn plain(name: &str) -> String {
    name.to_lowercase().trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches(['_', '-', ' ']).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(wanted: PhysicalQuantity, signals: &[(&str, &str)]) -> Option<usize> {
        let declared: Vec<Signal> = signals
            .iter()
            .map(|(name, unit)| Signal { column: (*name).into(), unit: (*unit).into(), ..Signal::default() })
            .collect();
        let signal = |(name, unit): &(&str, &str)| rig::Signal {
            name: (*name).into(),
            unit: Unit::parse(unit).map_or("?", |u| u.si_name()).into(),
            low: 0.0,
            high: 1.0,
        };
        find(wanted, &declared, &signals.iter().map(signal).collect::<Vec<_>>())
    }

    #[test]
    fn a_name_counts_where_its_unit_fits() {
        use PhysicalQuantity::{Altitude, Payload, Throttle};
        assert_eq!(found(Throttle, &[("pressure", "bar"), ("Mean_Throttle", "%")]), Some(1));
        assert_eq!(found(Throttle, &[("rotor_speed", "rpm"), ("thrust", "N"), ("thr", "1")]), Some(1));
        assert_eq!(found(Altitude, &[("threshold", "m"), ("h", "cm")]), Some(1));
        assert_eq!(found(Altitude, &[("base-altitude", "m"), ("alt", "m")]), Some(1), "a whole name before a word");
        assert_eq!(found(Altitude, &[("alt", "s")]), None);
        assert_eq!(found(Payload, &[("load", "N"), ("payload_mass", "g")]), Some(1));
        assert_eq!(found(Payload, &[("x", "mm"), ("hotload", "kg")]), None);
    }

    #[test]
    fn what_the_manifest_says_goes_before_any_name() {
        let mut declared = [Signal::default(), Signal::default()];
        declared[1].quantity = Some(PhysicalQuantity::Throttle);
        let context = |name: &str| rig::Signal { name: name.into(), unit: "1".into(), low: 0.0, high: 1.0 };
        assert_eq!(find(PhysicalQuantity::Throttle, &declared, &[context("throttle"), context("duty")]), Some(1));
        declared[1].quantity = None;
        declared[0].quantity = Some(PhysicalQuantity::Altitude);
        assert_eq!(find(PhysicalQuantity::Throttle, &declared, &[context("throttle"), context("duty")]), None);
    }
}
