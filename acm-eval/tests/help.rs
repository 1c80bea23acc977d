//! Help texts follow the terminal. Oracle: lines are filled greedily, so the first word of a line that goes on would not have
//! fitted into the line before; and the words do not depend on the width.

use std::process::Command;

const HELPS: [&[&str]; 8] = [
    &["--help"],
    &["close-loop", "--help"],
    &["export", "--help"],
    &["import", "--help"],
    &["separability", "--help"],
    &["report", "--help"],
    &["score-loop", "--help"],
    &["stream", "--help"],
];

fn help(arguments: &[&str], columns: usize) -> String {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("acm-eval"));
    let output = command.args(arguments).env("COLUMNS", columns.to_string()).output().unwrap();
    assert!(output.status.success());
    String::from_utf8(output.stdout).unwrap()
}

fn words(text: &str) -> Vec<&str> {
    text.split_whitespace().collect()
}

#[test]
fn help_is_wrapped_once_at_any_width() {
    for arguments in HELPS {
        let widest = help(arguments, 100);
        for columns in [70, 80, 100] {
            let text = help(arguments, columns);
            assert!(text.lines().all(|line| line.chars().count() <= columns), "{arguments:?} at {columns}\n{text}");
            assert_eq!(words(&text), words(&widest), "{arguments:?} at {columns}");
            let lines: Vec<&str> = text.lines().collect();
            for pair in lines.windows(2).filter(|pair| is_prose(pair[0]) && is_prose(pair[1])) {
                let first = pair[1].split_whitespace().next().unwrap_or_default();
                let filled = pair[0].chars().count() + 1 + first.chars().count() > columns;
                assert!(
                    filled || pair[0].ends_with(':'),
                    "{arguments:?} at {columns}: an orphan\n{}\n{}",
                    pair[0],
                    pair[1]
                );
            }
        }
    }
}

/// A line of a paragraph.
fn is_prose(line: &str) -> bool {
    !line.is_empty() && !line.starts_with(' ')
}
