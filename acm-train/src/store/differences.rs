//! Keys in which two TOML tables differ, in words.

use std::collections::{BTreeMap, BTreeSet};

use toml::{Table, Value};

/// Returns one line for each dotted key in which the two differ; the question is a sentence, and no setting.
pub(crate) fn differences(held: &Table, asked: &Table) -> Vec<String> {
    of_leaves(&leaves(held), &leaves(asked))
}

/// Returns dotted keys with the values as TOML writes them.
fn leaves(table: &Table) -> BTreeMap<String, String> {
    let below = |(name, value): (&String, &Value)| -> Vec<(String, String)> {
        match value {
            Value::Table(inner) => leaves(inner).into_iter().map(|(key, v)| (format!("{name}.{key}"), v)).collect(),
            leaf => vec![(name.clone(), leaf.to_string())],
        }
    };
    table.iter().flat_map(below).collect()
}

fn of_leaves(held: &BTreeMap<String, String>, asked: &BTreeMap<String, String>) -> Vec<String> {
    let keys: BTreeSet<&String> = held.keys().chain(asked.keys()).collect();
    let shown = |value: Option<&String>| value.map_or("its default", |v| v.as_str()).to_string();
    keys.into_iter()
        .filter(|key| key.as_str() != "question" && held.get(*key) != asked.get(*key))
        .map(|key| format!("{key} is {} there and {} here", shown(held.get(key)), shown(asked.get(key))))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differing_keys_are_named() {
        let table = |text: &str| text.parse::<Table>().unwrap();
        let list = differences(&table("[network]\nunits = 32"), &table("[network]\nunits = 64"));
        assert_eq!(list, ["network.units is 32 there and 64 here"]);
    }
}
