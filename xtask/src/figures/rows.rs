//! Rows of tables that repeat what a block holds.

use super::block::Block;

/// Returns the rows of a text that name the command of a block, and have a number with decimals that the block does not hold.
pub fn complaints(text: &str, blocks: &[Block]) -> Vec<String> {
    let rows = text.lines().filter(|line| line.starts_with('|'));
    rows.flat_map(|row| {
        let own = blocks.iter().find(|block| row.contains(&format!("`{}`", block.command)))?;
        let held: Vec<&str> = own.lines.iter().flat_map(|line| numbers(line)).collect();
        let gone: Vec<&str> = numbers(row).into_iter().filter(|number| !held.contains(number)).collect();
        let told =
            || format!("README.md: {} in the row of `{}`, which prints no such number", gone.join(", "), own.command);
        (!gone.is_empty()).then(told)
    })
    .collect()
}

/// Returns the numbers of a line that have decimals.
fn numbers(line: &str) -> Vec<&str> {
    let words = line.split(|c: char| !(c.is_ascii_digit() || c == '.')).map(|word| word.trim_matches('.'));
    words.filter(|word| word.contains('.')).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn a_number_that_nothing_printed_is_told() {
        let lines = ["│ nominal 43.9 │".to_string(), "│ cfc 21.3 ± 1.0. │".to_string()].to_vec();
        let block = Block { command: "cargo run x".into(), is_slow: true, lines };
        let row = |cell: &str| format!("| q | {cell} | `cargo run x` |\n| r | 99.9 | `cargo run y` |");
        let blocks = [block];
        assert!(complaints(&row("43.9 → 21.3 ± 1.0 mm"), &blocks).is_empty());
        assert!(complaints(&row("43.9 → 20.9 ± 1.0 mm"), &blocks)[0].contains("20.9"));
    }
}
