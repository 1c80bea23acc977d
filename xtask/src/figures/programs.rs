//! Programs of the workspace as a reader runs them, in a folder of their own.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, fs, process};

/// Programs by package.
const PROGRAMS: [(&str, &str); 3] =
    [("acm-datasets", "acm-data"), ("acm-eval", "acm-eval"), ("acm-train", "acm-train")];

/// Folders that commands name.
const NAMED: [&str; 2] = ["datasets", "experiments"];

/// The programs of a checkout; they are built before the first is run.
pub struct Programs<'a> {
    root: &'a Path,
    built: OnceCell<Result<PathBuf, String>>,
}

impl<'a> Programs<'a> {
    pub fn new(root: &'a Path) -> Self {
        Self { root, built: OnceCell::new() }
    }

    /// Returns what a line of a shell prints, on standard output and standard error; `cargo run -p X --` stands for a program.
    pub fn output(&self, line: &str) -> Result<String, String> {
        let folder = self.built.get_or_init(|| self.build()).clone()?;
        let mut line = line.to_string();
        for (package, program) in PROGRAMS {
            let program = folder.join(program);
            line = line.replace(&format!("cargo run -p {package} --"), &format!("'{}'", program.display()));
        }
        let scratch = Scratch::new(self.root).map_err(|error| format!("no folder to work in: {error}"))?;
        let shared = env::var_os("ACM_SHARED").unwrap_or_else(|| self.root.join("../shared").into());
        let mut shell = Command::new("sh");
        shell.args(["-c", &format!("({line}) 2>&1")]).current_dir(&scratch.0).env("ACM_SHARED", shared);
        let done = shell.stdin(Stdio::null()).output().map_err(|error| format!("sh cannot be started: {error}"))?;
        let printed = String::from_utf8_lossy(&done.stdout).into_owned();
        let last = || printed.lines().last().unwrap_or_default().to_string();
        if done.status.success() { Ok(printed) } else { Err(format!("ends with {}: {}", done.status, last())) }
    }

    /// Returns the folder of the programs.
    fn build(&self) -> Result<PathBuf, String> {
        let packages = PROGRAMS.iter().flat_map(|(package, _)| ["-p", package]);
        let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args(["build", "--quiet", "--locked", "--bins"]).args(packages).current_dir(self.root);
        let done = cargo.status().map_err(|error| format!("cargo cannot be started: {error}"))?;
        let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| self.root.join("target"), PathBuf::from);
        let folder = self.root.join(target).join("debug");
        if done.success() { Ok(folder) } else { Err("cargo build fails".into()) }
    }
}

/// A folder that is deleted afterwards; it holds links to what commands name.
struct Scratch(PathBuf);

impl Scratch {
    fn new(root: &Path) -> std::io::Result<Self> {
        let scratch = Self(env::temp_dir().join(format!("acm-figures-{}", process::id())));
        fs::create_dir_all(&scratch.0)?;
        for name in NAMED {
            link(&root.join(name), &scratch.0.join(name))?;
        }
        Ok(scratch)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[cfg(unix)]
fn link(from: &Path, to: &Path) -> std::io::Result<()> {
    std::os::unix::fs::symlink(from, to)
}

#[cfg(not(unix))]
fn link(_: &Path, _: &Path) -> std::io::Result<()> {
    Err(std::io::Error::other("links to folders need Unix"))
}
