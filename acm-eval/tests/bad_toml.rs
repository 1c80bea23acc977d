//! Spoiled questions to the loop: each message names file, line, column and key, says what to do, and is short. The files are
//! spoiled as those of acm-train are (`cargo run -p acm-train --example bad_toml`).

#![allow(missing_docs)]

use std::fs;

use acm_eval::question::config::LoopConfig;
use acm_train::explain;

const WHOLE: &str = r#"question = "What is missing?"
data = "set"
[nominal]
model = "polynomial"
length = 0.62
axis = "-z"
degree = 2
steps = 40
tolerance = 1e-9
comparator_degree = 3
[effects]
only = ["dead_time", "backlash"]
without = ["creep"]
[search]
most = 2
samples = 4000
seed = 1
[networks]
experiment = "net.toml"
"#;

/// Key, what stands in its place, and what the message calls it.
fn cases() -> Vec<(usize, String, String)> {
    let mut cases = vec![];
    for (index, line) in WHOLE.lines().enumerate() {
        let Some((key, value)) = line.split_once(" = ") else {
            let name = line.trim_matches(['[', ']']);
            cases.push((index, format!("[{name}s]"), format!("{name}s")));
            continue;
        };
        let wrong = if value.starts_with('"') { "17" } else { "\"much\"" };
        let mut bad = |text: String, name: &str| cases.push((index, text, name.to_string()));
        bad(format!("{key} = {wrong}"), key);
        bad(format!("{key} = nan"), key);
        bad(format!("{key} = {}", "[".repeat(5000)), key);
        bad(format!("{key} ="), key);
        bad(format!("{key}s = {value}"), &format!("{key}s"));
        let out_of_range: &[&str] = match key {
            "model" => &["\"magic\""],
            "length" => &["0.0", "-1.0", "620.0"],
            "axis" => &["\"up\""],
            "degree" | "comparator_degree" => &["0", "99", "9223372036854775807"],
            "steps" => &["0", "1000000000000"],
            "tolerance" => &["0.0"],
            "only" | "without" => &["[\"magic\"]", "[7]"],
            "most" => &["0", "13", "-2"],
            "samples" => &["10", "-1"],
            "seed" => &["-1", "1.5"],
            _ => &[],
        };
        for value in out_of_range {
            bad(format!("{key} = {value}"), key);
        }
    }
    cases
}

#[test]
fn every_spoiled_question_is_refused_in_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let (file, cases) = (folder.path().join("loop.toml"), cases());
    fs::write(&file, WHOLE).unwrap();
    LoopConfig::read(&file, &[]).unwrap_or_else(|error| panic!("{}", explain(error.into())));
    assert!(cases.len() >= 100, "{}", cases.len());
    let mut wrong = vec![];
    for (index, line, key) in &cases {
        let lines = WHOLE.lines().enumerate().map(|(i, old)| if i == *index { line.as_str() } else { old });
        fs::write(&file, lines.map(|line| format!("{line}\n")).collect::<String>()).unwrap();
        let shown: String = line.chars().take(40).collect();
        match LoopConfig::read(&file, &[]) {
            Ok(_) => wrong.push(format!("{shown}: it was read")),
            Err(error) => {
                let (code, message) = (error.exit_code(), explain(error.into()));
                let head = message.split('╭').next().unwrap_or_default();
                let place = head.contains(&format!("loop.toml:{}:", index + 1));
                let fine = code == 2 && place && head.contains(key.as_str()) && message.contains("help:");
                if !fine || message.len() > 4096 {
                    wrong.push(format!("{shown} (line {}, key {key}): {message:.400}", index + 1));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}
