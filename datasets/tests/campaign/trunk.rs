//! The real trunk, where the shared measurements are at hand.

use std::path::PathBuf;

use acm_datasets::{Campaign, Role};

/// The folder of shared measurements, if there is one.
pub fn shared() -> Option<PathBuf> {
    let root = std::path::absolute("../../shared").unwrap();
    std::env::var_os("ACM_SHARED")
        .map(PathBuf::from)
        .into_iter()
        .chain([root])
        .find(|p| p.join("data/asl-trunk").is_dir())
}

/// Oracle: the files' numbers of lines (3000 rows at 20 Hz), 105 s at 20 Hz, and the first row as it is written.
#[test]
fn the_trunk_is_read() {
    let Some(shared) = shared() else { return eprintln!("skipped: no shared measurements") };
    let folder = std::path::absolute("asl-trunk").unwrap();
    let data = shared.join("data/asl-trunk");
    let campaign = Campaign::check(&folder, Some(&data), 50, 0.5).unwrap_or_else(|e| panic!("{e}"));
    let found: Vec<_> = campaign.trials.iter().map(|t| (t.name.as_str(), t.role, t.samples())).collect();
    assert_eq!(
        found,
        [
            ("run1_0g:head", Role::Calibration, 2100),
            ("run1_0g:tail", Role::Development, 900),
            ("run1_200g", Role::Excluded, 3000),
            ("run2_0g", Role::HeldOut, 3000)
        ]
    );
    let head = &campaign.trials[0];
    assert_eq!((head.time[1], head.actuators.ncols(), head.measured.ncols()), (0.05, 6, 9));
    assert!((head.actuators[(0, 0)] + 1.318f64.to_radians()).abs() < 1e-15);
    assert_eq!(campaign.manifest.output_names(), ["x", "y", "z"]);
    let tip: Vec<f64> = campaign.tip_columns().map(|c| head.measured[(0, c)]).collect();
    assert_eq!(tip, [0.108673, -0.311907, 0.107489]);
    assert_eq!(campaign.folds().validation, [["run1_0g:tail"]]);
    assert_eq!(campaign.trials[2].conditions["payload"], 0.2);
    assert!(campaign.warnings.is_empty(), "{:?}", campaign.warnings);
}
