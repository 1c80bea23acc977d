//! Marked blocks of a Markdown file.

/// A block that a command printed.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    pub command: String,
    pub is_slow: bool,
    /// Lines between the fences.
    pub lines: Vec<String>,
}

/// Stands for lines that are not shown.
const REST: &str = "…";

/// Returns the blocks of a text, in order.
pub fn all(text: &str) -> Vec<Block> {
    let (mut blocks, mut lines) = (vec![], text.lines());
    while let Some(line) = lines.next() {
        let marker = line.strip_prefix("<!-- ").and_then(|line| line.strip_suffix(" -->"));
        let Some((kind, command)) = marker.and_then(|marker| marker.split_once("example: ")) else { continue };
        let inner = lines.by_ref().take_while(|line| *line != "<!-- /example -->");
        let lines = inner.filter(|line| !line.starts_with("```")).map(str::to_string).collect();
        blocks.push(Block { command: command.into(), is_slow: kind.trim() == "slow", lines });
    }
    blocks
}

impl Block {
    /// Returns the block as it stands in a file, with these lines.
    pub fn text(&self, lines: &[String]) -> String {
        let slow = if self.is_slow { "slow " } else { "" };
        let inner: String = lines.iter().map(|line| format!("{line}\n")).collect();
        format!("<!-- {slow}example: {} -->\n```text\n{inner}```\n<!-- /example -->", self.command)
    }

    /// Returns the lines of an output that stand where the lines of the block stood: each run of lines between two "…" from its first line to its
    /// last one, which are known by their words. None where one is not there.
    pub fn renewed(&self, output: &str) -> Option<Vec<String>> {
        let output: Vec<&str> = output.lines().map(str::trim_end).collect();
        let (mut at, mut renewed) = (0, vec![]);
        for (k, run) in self.lines.split(|line| line == REST).enumerate() {
            renewed.extend((k > 0).then(|| REST.to_string()));
            let (Some(first), Some(last)) = (run.first(), run.last()) else { continue };
            let exact = run.len() - 1;
            let from = at + output[at..].iter().position(|line| words(line) == words(first))?;
            let is_last = |k: &usize| output.get(*k).is_some_and(|line| words(line) == words(last));
            // A table has many lines without words, so the same count goes first.
            let to = Some(from + exact).filter(is_last).or_else(|| (from..output.len()).find(is_last))?;
            renewed.extend(output[from..=to].iter().map(ToString::to_string));
            at = to + 1;
        }
        Some(renewed)
    }
}

/// Returns the words of a line, without its numbers.
fn words(line: &str) -> Vec<&str> {
    line.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# Head\n\n<!-- slow example: a && b -->\n```text\nfirst 1\n…\n│ one 2.5 │\n└─────────┘\nlast: 3\n```\n<!-- /example -->\n";

    /// Oracle: by hand.
    #[test]
    fn a_block_is_found_and_put_back() {
        let [block] = &all(TEXT)[..] else { panic!("{:?}", all(TEXT)) };
        assert_eq!((block.command.as_str(), block.is_slow, block.lines.len()), ("a && b", true, 5));
        assert!(TEXT.contains(&block.text(&block.lines)));
    }

    /// Oracle: by hand.
    #[test]
    fn numbers_are_new_and_what_is_left_out_stays_so() {
        let block = &all(TEXT)[0];
        let output = "noise\nfirst 7\nelse\nand more\n│ one 25.25 │\n└───────────┘\nlast: 4\nend\n";
        let expected = ["first 7", "…", "│ one 25.25 │", "└───────────┘", "last: 4"].map(String::from);
        assert_eq!(block.renewed(output).unwrap(), expected);
        assert_eq!(block.renewed("first 7\nlast: 4\n"), None);
    }
}
