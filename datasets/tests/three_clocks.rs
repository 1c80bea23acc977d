//! The recordings of the tutorial are those that the example makes, and the draft of `init` for them is accepted as it is.

#![allow(missing_docs)]

#[path = "../examples/three_clocks.rs"]
mod three_clocks;

use assert_cmd::Command;

#[test]
fn the_recordings_in_the_project_are_those_of_the_example() {
    let folder = std::path::absolute("three-clocks").unwrap();
    for (name, bytes) in three_clocks::files().expect("made") {
        let found = std::fs::read(folder.join(&name)).expect("a file");
        assert!(
            found == bytes,
            "{name} is another: make it again by `cargo run -p acm-datasets --example three_clocks`"
        );
    }
}

#[test]
fn the_first_draft_of_a_manifest_is_accepted_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, bytes) in three_clocks::files().expect("made") {
        std::fs::write(folder.path().join(name), bytes).expect("written");
    }
    let run = |command: &str| {
        let done = Command::cargo_bin("acm-data").expect("acm-data").arg(command).arg(folder.path()).assert().success();
        String::from_utf8_lossy(&done.get_output().stdout).into_owned()
    };
    let draft = run("init");
    for part in ["by = [\"mocap.Tip.Position.", "\"motors.q", "\"ulog.vehicle_visual_odometry.position[", "correlation"]
    {
        assert!(draft.contains(part), "{part:?} in\n{draft}");
    }
    assert!(run("check").contains("no problems"));
}
