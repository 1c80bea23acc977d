//! `acm-data describe` and `acm-data statistics`.

use assert_cmd::Command;

use super::set::{self, Set};

fn run(arguments: &[&str], set: &Set) -> (i32, String) {
    let mut command = Command::cargo_bin("acm-data").expect("acm-data");
    let output = command.args(arguments).arg(set.path()).output().expect("runs");
    (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned())
}

/// Oracle: the set's rows: 60 samples at 10 Hz, a gap of 2 s put in, 3 lost markers, and values by hand.
#[test]
fn a_set_is_described_and_drawn() {
    let set = Set::new();
    let mut rows = set::rows(1);
    rows[30..].iter_mut().for_each(|r| r[0] += 1900.0);
    rows[40][3] = -250.0;
    let mut text = set::csv(&rows);
    for t in [3, 4, 10] {
        let line = text.lines().nth(t + 1).expect("line").to_string();
        text = text.replacen(&line, &line[..=line.rfind(',').expect("comma")], 1);
    }
    set.write("run_b.csv", &text);
    let (code, shown) = run(&["describe"], &set);
    assert_eq!(code, 0, "{shown}");
    assert!(shown.starts_with("small\n"), "the name stands for a title: {shown}");
    assert_eq!(set.campaign().manifest.title, "small");
    let line = |start: &str| {
        let found = shown.lines().find(|l| l.trim_start_matches(['│', ' ']).starts_with(start));
        found.unwrap_or_else(|| panic!("{start} in\n{shown}")).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert_eq!(line("b "), "│ b development 57 7.8 10.00 1 2.000 3 lost marker │");
    assert_eq!(line("c "), "│ c held out 60 5.9 10.00 0 0.100 – │");
    assert!(line("y ").starts_with("│ y measured m −0.2500"), "{shown}");
    assert!(line("nominal").contains("polynomial"));
    assert_eq!(line("folds"), "folds: one trial left out at a time (2 folds): a | b");
    assert!(shown.contains("b (development, 7.8 s)"), "{shown}");
    let dots = shown.chars().filter(|c| (0x2801..=0x28ff).contains(&(*c as u32))).count();
    assert!(dots > 4 * 3 * 30, "{dots} characters are drawn");
}

/// The hint at the end calls the other program as this one was called.
#[test]
fn the_next_command_is_called_as_this_one() {
    let set = Set::new();
    let said = |cargo: Option<&str>| {
        let mut command = Command::cargo_bin("acm-data").expect("acm-data");
        command.env_remove("CARGO").envs(cargo.map(|cargo| ("CARGO", cargo))).arg("check").arg(set.path());
        String::from_utf8_lossy(&command.output().expect("runs").stdout).into_owned()
    };
    let (folder, installed) =
        (set.path().display(), assert_cmd::cargo::cargo_bin!("acm-data").with_file_name("acm-eval"));
    assert!(said(None).ends_with(&format!("next: {} close-loop {folder}\n", installed.display())), "{}", said(None));
    let by_cargo = said(Some("/usr/bin/cargo"));
    assert!(
        by_cargo.contains("next: cargo run ") && by_cargo.contains(&format!(" -p acm-eval -- close-loop {folder}"))
    );
}

/// The statistics of the synthetic campaign are those of a continuum arm.
#[test]
fn a_set_without_an_arm_has_no_such_statistics() {
    let (code, shown) = run(&["statistics"], &Set::new());
    assert_eq!(code, 2, "{shown}");
    assert!(shown.contains("the manifest has no [arm]"), "{shown}");
}

/// An arm of one actuator, and one without held-out trials.
#[test]
fn statistics_of_another_arm_are_refused() {
    let twin = std::path::absolute("acm-twin").unwrap();
    let manifest = std::fs::read_to_string(twin.join("manifest.toml")).expect("manifest");
    let second = "[[actuator]]   # held in each trial\ncolumn = \"q2\"\nunit   = \"rad\"\n";
    let held_out = "held_out    = [\"10\", \"11\", \"12\"]   # an altitude that is not in development\nexcluded    = [";
    let excluded = "excluded = [\"10\", \"11\", \"12\", ";
    for (from, to, words) in [(second, "", "has 1"), (held_out, excluded, "need held_out trials")] {
        assert!(manifest.contains(from), "{from}");
        let set = Set::new();
        std::fs::copy(twin.join("campaign.parquet"), set.file("campaign.parquet")).expect("copied");
        set.write("manifest.toml", &manifest.replace(from, to));
        let (code, shown) = run(&["statistics"], &set);
        assert!(code == 2 && shown.contains(words), "{shown}");
    }
}
