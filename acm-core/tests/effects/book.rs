//! The book's table of effects holds what the program has: every name with its meaning, and no other.

use std::collections::BTreeSet;

use acm_core::effects::ALL;

/// Name and meaning of each row: its second cell, in backticks, and its third.
fn rows(chapter: &str) -> BTreeSet<(String, String)> {
    let cells = chapter.lines().filter_map(|line| {
        let mut cells = line.strip_prefix('|')?.split('|').map(str::trim).skip(1);
        let name = cells.next()?.strip_prefix('`')?.strip_suffix('`')?;
        Some((name.to_string(), cells.next()?.to_string()))
    });
    cells.collect()
}

#[test]
fn the_book_has_every_effect_with_its_meaning() {
    let path = "../book/src/effects.md";
    let text = std::fs::read_to_string(path).unwrap();
    let written = rows(&text);
    let known = ALL.iter().map(|effect| (effect.name().to_string(), effect.meaning().to_string())).collect();
    assert_eq!(written, known);
    let count = format!("The {} physical effects", ALL.len());
    assert!(text.contains(&count), "{path} does not say: {count}");
}
