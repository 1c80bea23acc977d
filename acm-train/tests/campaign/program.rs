//! The program that is tested, for tests and for the examples that share their code.

use std::{path::PathBuf, process::Command};

/// In a test the program of this build; an example has cargo build it first, so that it is never an old one.
pub fn program() -> PathBuf {
    option_env!("CARGO_BIN_EXE_acm-train").map_or_else(built, PathBuf::from)
}

fn built() -> PathBuf {
    let status = Command::new(env!("CARGO"))
        .args(["build", "--locked", "-p", "acm-train"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .status()
        .unwrap();
    assert!(status.success(), "acm-train cannot be built");
    // <target>/debug/examples/this
    let this = std::env::current_exe().unwrap();
    this.parent().and_then(|examples| examples.parent()).unwrap().join("acm-train")
}
