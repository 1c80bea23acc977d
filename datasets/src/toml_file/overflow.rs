//! Numbers beyond the types of TOML: 64-bit integers with a sign, and floats of double precision.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::walk::each;

/// Returns the place of the first such number of a text that is TOML, its key and value, and the remedy.
pub fn find(text: &str) -> Option<(Range<usize>, String, &'static str)> {
    each(DeTable::parse(text).ok()?.get_ref(), &mut vec![], &mut |key, _, value| {
        let (shown, what, remedy) = match value.get_ref() {
            DeValue::Integer(number) if i64::from_str_radix(number.as_str(), number.radix()).is_err() => (
                number.to_string(),
                "beyond the whole numbers of TOML",
                "write one from -9223372036854775808 to 9223372036854775807",
            ),
            DeValue::Float(number) if is_too_large(number.as_str()) => {
                (number.to_string(), "beyond the numbers of TOML", "write one from -1.7e308 to 1.7e308")
            }
            _ => return None,
        };
        Some((value.span(), format!("`{}` is {shown}, {what}", key.join(".")), remedy))
    })
}

fn is_too_large(float: &str) -> bool {
    float.parse().is_ok_and(f64::is_infinite) && !float.contains("inf")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected values written by hand.
    #[test]
    fn numbers_beyond_the_types_are_found() {
        let found = |text: &str| find(text).map(|(span, what, _)| (text[span].to_string(), what));
        assert_eq!(found("a = 9223372036854775807\nb = [-9223372036854775808, 0xff]\nc = 1.5e308\nd = -inf"), None);
        for (text, number, key) in [
            ("seed = 18446744073709551615", "18446744073709551615", "`seed`"),
            ("[t]\nepochs = 1_000\nseeds = [1, 9_223_372_036_854_775_808]", "9_223_372_036_854_775_808", "`t.seeds.1`"),
            ("[[a]]\nb = { c = -99999999999999999999 }", "-99999999999999999999", "`a.0.b.c`"),
            ("a = 0xffff_ffff_ffff_ffff_f", "0xffff_ffff_ffff_ffff_f", "`a`"),
            ("a = 1e400", "1e400", "`a`"),
        ] {
            let (place, what) = found(text).unwrap_or_default();
            assert_eq!(place, number);
            assert!(what.starts_with(key), "{what}");
        }
    }
}
