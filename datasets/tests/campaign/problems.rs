//! What holds of the messages of `acm-data check` as a whole. The messages themselves are those of the spoiled sets of
//! `tests/bad_files.rs`.

use assert_cmd::Command;

use super::set::{self, Set};

/// However the folder is written, also with characters that mean something in a pattern.
#[test]
fn a_folder_may_be_written_in_any_way() {
    let set = Set::new();
    let odd = set.file("a [set]*");
    std::fs::create_dir(&odd).expect("folder");
    for name in ["manifest.toml", "run_a.csv", "run_b.csv", "run_c.csv", "run_d.csv"] {
        std::fs::copy(set.file(name), odd.join(name)).expect("copy");
    }
    for folder in [".", "./", "a [set]*", "./a [set]*/", "a [set]*/..", "a [set]*/../."] {
        let mut command = Command::cargo_bin("acm-data").expect("acm-data");
        command.arg("check").arg(folder).current_dir(set.path()).assert().success();
    }
}

/// Cells that are not numbers, and rows of a wrong length.
#[test]
fn many_problems_of_one_kind_are_one_message_with_their_number() {
    for (spoiled, problem, number) in [
        ("x,13.5,", "is not a number", ", likewise 59 more (rows 3 to 61); correct the cell"),
        (",13,5,", "5 cells under 4 columns", ", so cell 5 has no column, likewise 59 more (rows 3 to 61)"),
    ] {
        let set = Set::new();
        set.write("run_b.csv", &set::csv(&set::rows(1)).replace(",13.5,", spoiled));
        let message = set.error();
        assert_eq!(message.matches(problem).count(), 1, "{message}");
        assert!(message.contains("run_b.csv, row 2") && message.contains(&format!("{problem}{number}")), "{message}");
    }
}

#[cfg(unix)]
#[test]
fn a_file_that_may_not_be_read_is_a_problem_of_the_file_system() {
    use std::os::unix::fs::PermissionsExt;
    let set = Set::new();
    std::fs::set_permissions(set.file("run_b.csv"), std::fs::Permissions::from_mode(0o000)).expect("chmod");
    if std::fs::read(set.file("run_b.csv")).is_ok() {
        return eprintln!("skipped: this user may read every file");
    }
    let error = set.read().expect_err("no permission");
    let message = error.to_string();
    assert_eq!(error.exit_code(), 4, "{message}");
    assert!(message.contains("run_b.csv") && message.contains("permissions"), "{message}");
}

#[test]
fn usage_is_code_two() {
    for arguments in [vec!["check"], vec!["check", ".", "--window", "0"], vec!["fly"]] {
        Command::cargo_bin("acm-data").expect("acm-data").args(&arguments).assert().code(2);
    }
}
