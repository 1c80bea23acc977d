//! Small rigs as data sets: what is written is what was simulated, and reads without a warning.

use acm_datasets::generate::small_rig::{campaign, write};
use acm_datasets::{Campaign, Role};
use acm_sim::small_rigs::{Kind, oracle, simulate};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Oracle: the reader, which shares nothing with the writer but the table format.
#[test]
fn written_rigs_are_read_again() -> Outcome {
    for kind in Kind::ALL {
        let (rig, folder) = (simulate(kind, 14_001), tempfile::tempdir()?);
        write(&rig, &oracle(&rig), folder.path())?;
        let (read, made) = (Campaign::read(folder.path(), None)?, campaign(&rig));
        assert_eq!(read.manifest, made.manifest, "{}", rig.name);
        assert_eq!(read.trials, made.trials, "{}", rig.name);
        assert!(read.trials(Role::HeldOut).count() > 0 && read.trials(Role::Calibration).count() == 0);
        let manifest = std::fs::read_to_string(folder.path().join("manifest.toml"))?;
        for cause in &rig.truth.causes {
            assert!(!manifest.contains(&cause.mechanism), "{}: the manifest says {}", rig.name, cause.mechanism);
        }
        let truth: serde_json::Value =
            serde_json::from_str(&std::fs::read_to_string(folder.path().join("sealed/truth.json"))?)?;
        assert_eq!(truth["causes"].as_array().map(Vec::len), Some(rig.truth.causes.len()));
    }
    Ok(())
}

#[test]
fn the_command_writes_a_rig() -> Outcome {
    let folder = tempfile::tempdir()?;
    let run = |arguments: &[&str]| {
        assert_cmd::Command::cargo_bin("acm-data")
            .map(|mut command| command.current_dir(folder.path()).arg("generate").args(arguments).output())
    };
    let done = run(&["--small-rig", "axis", "--undeclared", "14002"])??;
    assert!(done.status.success(), "{done:?}");
    let read = Campaign::read(&folder.path().join("axis-14002"), None)?;
    assert_eq!(read.trials, campaign(&simulate(Kind::Axis, 14_002)).trials);
    assert_eq!(run(&["--small-rig", "axle", "--undeclared", "1"])??.status.code(), Some(2));
    Ok(())
}
