//! Commands of acm's programs in messages, as the user would type them.

use std::ffi::OsStr;
use std::path::Path;

/// The programs, and the packages that `cargo run` builds them from.
const PROGRAMS: [(&str, &str); 3] =
    [("acm-data", "acm-datasets"), ("acm-eval", "acm-eval"), ("acm-train", "acm-train")];

/// Returns the command `program verb folder rest`, called as this process was: by `cargo run`, by the path of a folder, or by
/// name.
pub fn command(program: &str, verb: &str, folder: &Path, rest: &str) -> String {
    let called = std::env::args_os().next().unwrap_or_default();
    let by_cargo = std::env::var_os("CARGO").is_some();
    let program = called_like(Path::new(&called), program, by_cargo);
    format!("{program} {verb} {}{rest}", argument(folder.display()))
}

/// Returns an argument of a command; a text with other characters than names and paths have is quoted for a shell.
pub fn argument(text: impl std::fmt::Display) -> String {
    let text = text.to_string();
    let is_plain = |c: char| c.is_alphanumeric() || "/\\._-+=:,@%".contains(c);
    match !text.is_empty() && text.chars().all(is_plain) {
        true => text,
        false => format!("'{}'", text.replace('\'', r"'\''")),
    }
}

fn called_like(called: &Path, program: &str, by_cargo: bool) -> String {
    let package = PROGRAMS.iter().find(|(name, _)| *name == program).map_or(program, |(_, package)| package);
    let is_ours = called.file_stem().is_some_and(|stem| PROGRAMS.iter().any(|(name, _)| stem == *name));
    let is_release = called.parent().and_then(Path::file_name) == Some(OsStr::new("release"));
    match (by_cargo, is_ours) {
        (true, _) if is_release => format!("cargo run --release -p {package} --"),
        (true, _) => format!("cargo run -p {package} --"),
        (false, true) => argument(called.with_file_name(program).display()),
        (false, false) => program.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected values written by hand.
    #[test]
    fn a_hint_names_a_program_as_the_caller_did() {
        for (called, by_cargo, expected) in [
            ("acm-data", false, "acm-eval"),
            ("./target/release/acm-data", false, "./target/release/acm-eval"),
            ("/opt/my tools/acm-train", false, "'/opt/my tools/acm-eval'"),
            ("target/debug/acm-data", true, "cargo run -p acm-eval --"),
            ("target/release/acm-data", true, "cargo run --release -p acm-eval --"),
            ("/usr/bin/python3", false, "acm-eval"),
            ("", false, "acm-eval"),
        ] {
            assert_eq!(called_like(Path::new(called), "acm-eval", by_cargo), expected, "{called}");
        }
        assert_eq!(called_like(Path::new("x/acm-eval"), "acm-data", true), "cargo run -p acm-datasets --");
        assert_eq!(["runs/cfc", "", "my robot", "it's"].map(argument), ["runs/cfc", "''", "'my robot'", r"'it'\''s'"]);
    }
}
