//! Visits of the values of a TOML file.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Visits the values in a table, each before those below it, with the parts of its key and the place of the last part; the
/// first answer of `visit` ends the visit.
pub(super) fn each<T>(
    table: &DeTable<'_>,
    key: &mut Vec<String>,
    visit: &mut impl FnMut(&[String], Range<usize>, &Spanned<DeValue<'_>>) -> Option<T>,
) -> Option<T> {
    table.iter().find_map(|(name, value)| each_below(value, (name.get_ref().to_string(), name.span()), key, visit))
}

fn each_below<T>(
    value: &Spanned<DeValue<'_>>,
    (name, at): (String, Range<usize>),
    key: &mut Vec<String>,
    visit: &mut impl FnMut(&[String], Range<usize>, &Spanned<DeValue<'_>>) -> Option<T>,
) -> Option<T> {
    key.push(name);
    let found = visit(key, at, value).or_else(|| match value.get_ref() {
        DeValue::Table(table) => each(table, key, visit),
        DeValue::Array(members) => members
            .iter()
            .enumerate()
            .find_map(|(i, member)| each_below(member, (i.to_string(), member.span()), key, visit)),
        _ => None,
    });
    key.pop();
    found
}
