//! Tasks of this workspace.
//!
//! | `cargo xtask` | does |
//! | --- | --- |
//! | `structure` | checks the structure ([`structure`]) |
//! | `lines [FOLDER]` | counts lines of code ([`lines`]) |
//! | `figures [WORD …]` | prints the examples of README and book anew ([`figures`]) |
//! | `figures --check` | checks those that take seconds |

mod figures;
mod lines;
mod structure;

use std::path::PathBuf;
use std::process::ExitCode;

use figures::Wanted;

fn main() -> ExitCode {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = asked.iter().map(String::as_str).collect();
    let done = match words[..] {
        ["structure"] => structure::complaints(&workspace()),
        ["lines"] => lines::table(&workspace()).map(print),
        ["lines", folder] => lines::table(folder.as_ref()).map(print),
        ["figures"] => figures::renew(&workspace(), &Wanted::Quick, false),
        ["figures", "--check"] => figures::renew(&workspace(), &Wanted::Quick, true),
        ["figures", ref words @ ..] => figures::renew(&workspace(), &Wanted::Of(words), false),
        _ => {
            eprintln!("usage: cargo xtask structure | lines [FOLDER] | figures [--check | WORD …]");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(complaints) if complaints.is_empty() => ExitCode::SUCCESS,
        Ok(complaints) => {
            print(complaints);
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("xtask: {error}");
            ExitCode::from(2)
        }
    }
}

/// Prints lines, and returns no complaint.
fn print(lines: Vec<String>) -> Vec<String> {
    lines.iter().for_each(|line| println!("{line}"));
    vec![]
}

/// Returns the folder above this crate, as cargo says when it runs; else the current one.
fn workspace() -> PathBuf {
    let own = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    own.and_then(|own| own.parent().map(PathBuf::from)).unwrap_or_else(|| ".".into())
}
