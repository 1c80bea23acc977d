//! The program that is tested, for tests and for the examples that share their code.

use std::{path::PathBuf, process::Command};

/// In a test the program of this build; an example has cargo build it first, so that it is never an old one.
pub fn program() -> PathBuf {
    option_env!("CARGO_BIN_EXE_acm-train").map_or_else(built, PathBuf::from)
}

fn built() -> PathBuf {
    let mut cargo = Command::new(env!("CARGO"));
    // What `cargo run` says of this package would be news to the build scripts of others, and with them half of all
    // dependencies would be built anew.
    let news = |name: &str| name.starts_with("CARGO_PKG_") || name.starts_with("CARGO_MANIFEST_");
    for (name, _) in std::env::vars().filter(|(name, _)| news(name)) {
        cargo.env_remove(name);
    }
    let status = cargo.args(["build", "--locked", "-p", "acm-train"]).status();
    let status = status.unwrap();
    assert!(status.success(), "acm-train cannot be built");
    // <target>/debug/examples/this
    let this = std::env::current_exe().unwrap();
    this.parent().and_then(|examples| examples.parent()).unwrap().join("acm-train")
}
