//! Campaigns with an undeclared mechanism: bits, silence, sizes, and that they are data sets.

use std::path::Path;

use acm_core::calibration::calibrate;
use acm_datasets::generate::undeclared::{UndeclaredCampaign, generate, write};
use acm_datasets::{Campaign, Role, Trial};
use acm_sim::twin::TwinError;
use acm_sim::twin::undeclared::{Cause, Class, Design, Kind, Null, Since, Truth, draw};
use nalgebra::DMatrix;

type Outcome = Result<(), Box<dyn std::error::Error>>;

const WHITE: Kind = Kind::Null(Null::White);

fn made(design: Design, kind: Kind) -> Result<UndeclaredCampaign, TwinError> {
    generate(7, design, Some(kind))
}

/// RMS distance of the tips of the trials of a role, mm.
fn distance(one: &Campaign, two: &Campaign, role: Role) -> f64 {
    let stack = |campaign: &Campaign| -> Vec<f64> {
        campaign.trials(role).flat_map(|trial| trial.measured.iter().copied().collect::<Vec<_>>()).collect()
    };
    let (one, two) = (stack(one), stack(two));
    let squares: f64 = one.iter().zip(&two).map(|(a, b)| (a - b) * (a - b)).sum();
    1e3 * (3.0 * squares / one.len() as f64).sqrt()
}

/// Oracle: noise is the same in every campaign of a seed, so that it cancels against the campaign where nothing acts; what
/// is left in the held-out trials is what the truth says, to the rounding of a measured micrometre.
#[test]
fn each_kind_moves_the_held_out_tip_as_its_truth_says() -> Outcome {
    for design in Design::ALL {
        let calm = made(design, WHITE)?.campaign;
        for kind in Kind::drawn() {
            let UndeclaredCampaign { campaign, truth } = made(design, kind)?;
            let name = kind.name();
            assert_eq!((&truth.kind, truth.class), (&name, kind.class()));
            let moved = distance(&campaign, &calm, Role::HeldOut);
            let said = truth.held_out_rms_mm;
            match kind {
                Kind::Null(Null::Coloured) => assert!((3.5..5.2).contains(&moved) && said == 0.0, "{name}: {moved}"),
                Kind::Null(Null::Misfit) => assert!(moved > 12.0 && said == 0.0, "{name}: {moved}"),
                Kind::Null(_) => assert!(moved == 0.0 && said == 0.0),
                Kind::One(Cause::Slip | Cause::TrialOffset) => assert!(moved == 0.0 && said == 0.0, "{name}: {moved}"),
                Kind::One(_) => assert!((7.0..25.0).contains(&said), "{design:?} {name}: {said} mm"),
                Kind::Two(..) | Kind::Several(_) => {
                    let parts = truth.effects.iter().map(|effect| effect.held_out_rms_mm);
                    assert!(parts.clone().all(|part| (7.0..17.0).contains(&part)), "{design:?} {name}: {truth:?}");
                    assert!(said < 1.3 * parts.sum::<f64>(), "{design:?} {name}");
                }
            }
            assert!(kind.class() == Class::Null || (moved - said).abs() < 2e-3, "{design:?} {name}: {moved} {said}");
            before_it_began(&campaign, &calm, &truth, &name);
        }
    }
    Ok(())
}

/// Oracle: trials in which nothing acts are those of the campaign where nothing acts, bit for bit.
fn before_it_began(campaign: &Campaign, calm: &Campaign, truth: &Truth, name: &str) {
    let since = |since: Since| !truth.effects.is_empty() && truth.effects.iter().all(|effect| effect.since == since);
    let same = |trial: &Trial| calm.trial(&trial.name).is_some_and(|other| other.measured == trial.measured);
    if since(Since::AfterCalibration) {
        assert!(campaign.trials(Role::Calibration).all(same), "{name}");
        // A third of the payloads weigh nothing.
        let spared = campaign.trials(Role::Development).filter(|trial| same(trial)).count();
        assert_eq!(spared, if name == "payload" { 3 } else { 0 }, "{name}");
    }
    if since(Since::OneTrial) {
        let trial = truth.effects[0].trial.as_deref();
        assert!(campaign.trials.iter().all(|other| same(other) == (trial != Some(other.name.as_str()))), "{name}");
    }
    for (trial, other) in campaign.trials.iter().zip(&calm.trials) {
        let inputs = |t: &Trial| (t.time.clone(), t.actuators.clone(), t.context.clone(), t.vehicle.clone());
        assert_eq!(inputs(trial), inputs(other), "{name}: the inputs tell nothing");
    }
}

/// Golden: hashes over the numbers of campaigns as they were before campaigns of several mechanisms were added.
#[test]
fn kinds_that_were_there_keep_their_bits() -> Outcome {
    for (kind, design, hash) in [
        (WHITE, Design::Rich, "0d4a727f10a718a3"),
        (Kind::One(Cause::Backlash), Design::Paper, "77386f9ade4a24a9"),
        (Kind::Two(Cause::Creep, Cause::MarkerOffset), Design::Rich, "787fd4c5791219b2"),
    ] {
        assert_eq!(&made(design, kind)?.campaign.hash[..16], hash, "{}", kind.name());
    }
    Ok(())
}

/// Oracle: inputs and noise of the campaign where nothing acts; what is there besides is what the truth says.
#[test]
fn nulls_are_amiss_as_their_truth_says() -> Outcome {
    let calm = made(Design::Rich, WHITE)?.campaign;
    let spread = |of: &dyn Fn(&Trial) -> Vec<f64>, made: &Campaign| {
        let pairs = made.trials.iter().zip(&calm.trials);
        let off: Vec<f64> = pairs.flat_map(|(a, b)| of(a).into_iter().zip(of(b)).map(|(a, b)| a - b)).collect();
        (off.iter().map(|d| d * d).sum::<f64>() / off.len() as f64).sqrt()
    };
    let (angles, tips): (&dyn Fn(&Trial) -> Vec<f64>, &dyn Fn(&Trial) -> Vec<f64>) =
        (&|trial| trial.actuators.as_slice().to_vec(), &|trial| trial.measured.as_slice().to_vec());
    let encoder = made(Design::Rich, Kind::Null(Null::Encoder))?;
    let said = encoder.truth.encoder_noise_mrad;
    assert!((0.0..=5.0).contains(&said) && encoder.campaign.trials[0].measured == calm.trials[0].measured);
    let seen = 1e3 * spread(angles, &encoder.campaign);
    assert!((seen / said - 1.0).abs() < 0.15, "{seen} {said} mrad");
    let offsets = made(Design::Rich, Kind::Null(Null::Offsets))?;
    let (said, seen) = (offsets.truth.offset_mm, 1e3 * 3f64.sqrt() * spread(tips, &offsets.campaign));
    assert!(said > 0.0 && (0.6..1.5).contains(&(seen / said)), "{seen} {said} mm of 17 draws");
    for (trial, calm) in offsets.campaign.trials.iter().zip(&calm.trials) {
        let off = &trial.measured - &calm.measured;
        let varies = off.row_iter().map(|row| (row - off.row(0)).amax()).fold(0.0, f64::max);
        assert!(varies < 2e-6, "one shift in a trial: {varies}");
    }
    Ok(())
}

/// Several mechanisms: so many, all of the library, with what else is amiss; the truth says which are separable.
#[test]
fn several_mechanisms_are_drawn_sized_and_judged() -> Outcome {
    let (mut separable, mut all, mut trials) = (0, 0, std::collections::BTreeSet::new());
    for seed in 14_001..14_007 {
        for many in [2, 5] {
            let UndeclaredCampaign { campaign, truth } = generate(seed, Design::Rich, Some(Kind::Several(many)))?;
            assert_eq!((truth.effects.len(), truth.class), (usize::from(many), Class::Several));
            assert_eq!(truth.kind, format!("several{many}"));
            assert!(truth.effects.iter().all(|effect| effect.inside && effect.name.is_some()));
            assert!(truth.effects.iter().all(|effect| (4.0..30.0).contains(&effect.held_out_rms_mm)), "{truth:?}");
            assert!(campaign.trials.iter().all(|trial| trial.time.windows(2).all(|pair| pair[1] > pair[0])));
            separable += truth.effects.iter().filter(|effect| effect.separable).count();
            all += truth.effects.len();
            trials.insert(campaign.trials.len());
        }
    }
    assert!(separable > all / 3 && separable < all, "{separable} of {all}");
    assert!(trials.len() > 3, "{trials:?}");
    Ok(())
}

#[test]
fn one_and_two_threads_give_the_same_bits() -> Outcome {
    for kind in [Kind::Two(Cause::ActuatorLag, Cause::Downwash), Kind::One(Cause::Wandering)] {
        let on = |threads: usize| -> Result<UndeclaredCampaign, Box<dyn std::error::Error>> {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
            Ok(pool.install(|| made(Design::Rich, kind))?)
        };
        assert_eq!(on(1)?, on(2)?);
    }
    let other = generate(8, Design::Rich, Some(WHITE))?;
    assert_ne!(other.campaign.hash, made(Design::Rich, WHITE)?.campaign.hash);
    assert_eq!(generate(12, Design::Paper, None)?.truth.kind, draw(12).name());
    Ok(())
}

#[test]
fn written_campaigns_are_read_again_without_a_warning() -> Outcome {
    for (design, kind) in [(Design::Rich, Kind::One(Cause::Payload)), (Design::Paper, Kind::One(Cause::Backlash))] {
        let (made, folder) = (made(design, kind)?, tempfile::tempdir()?);
        write(&made, folder.path())?;
        let read = Campaign::check(folder.path(), None, 50, 0.7)?;
        assert!(read.warnings.is_empty(), "{:?}", read.warnings);
        assert_eq!((&read.manifest, &read.trials), (&made.campaign.manifest, &made.campaign.trials));
        let truth: Truth = serde_json::from_str(&std::fs::read_to_string(folder.path().join("sealed/truth.json"))?)?;
        assert_eq!(truth, made.truth);
        let again = tempfile::tempdir()?;
        write(&made, again.path())?;
        for name in ["campaign.parquet", "manifest.toml", "sealed/truth.json"] {
            let bytes = |folder: &Path| std::fs::read(folder.join(name));
            assert_eq!(bytes(folder.path())?, bytes(again.path())?, "{name}");
        }
    }
    Ok(())
}

/// What a reader sees but for the measured tip is the same whatever acts; a payload that was weighed is written down.
#[test]
fn nothing_outside_of_the_seal_tells_what_acts() -> Outcome {
    let folder = tempfile::tempdir()?;
    let said = |kind: Kind| -> Result<String, Box<dyn std::error::Error>> {
        write(&made(Design::Rich, kind)?, folder.path())?;
        Ok(std::fs::read_to_string(folder.path().join("manifest.toml"))?)
    };
    let calm = said(WHITE)?;
    for kind in [Cause::Backlash, Cause::TipLoad, Cause::Slip, Cause::Wandering].map(Kind::One) {
        assert_eq!(said(kind)?, calm);
    }
    assert!(said(Kind::One(Cause::Payload))?.contains("payload"));
    let known = ["altitude", "throttle", "scale"];
    for name in Kind::all().into_iter().map(Kind::name).filter(|name| !known.contains(&name.as_str())) {
        assert!(!calm.contains(&name), "the manifest says {name:?}");
    }
    let mut files: Vec<String> = std::fs::read_dir(folder.path())?
        .map(|entry| entry.map(|entry| entry.file_name().to_string_lossy().into_owned()))
        .collect::<Result<_, _>>()?;
    files.sort();
    assert_eq!(files, ["campaign.parquet", "manifest.toml", "sealed"]);
    Ok(())
}

/// What is left of a calibrated nominal model where nothing acts: noise of 2.6 mm and a little; about 16 mm where the
/// null says so, in calibration and in flight alike.
#[test]
fn nominal_misfit_is_small_unless_it_is_the_null() -> Outcome {
    for design in Design::ALL {
        for (null, range) in [(Null::White, 2.6..4.5), (Null::Misfit, 13.0..19.0)] {
            let campaign = made(design, Kind::Null(null))?.campaign;
            let found = calibrate(
                &campaign.nominal_spec(),
                &campaign.observations(&campaign.trials(Role::Calibration).collect::<Vec<_>>()),
            )?;
            for role in [Role::Calibration, Role::HeldOut] {
                let seen = campaign.observations(&campaign.trials(role).collect::<Vec<_>>());
                let left: DMatrix<f64> = found.model.predict(&seen.actuators) - &seen.measured;
                let rms = 1e3 * (left.norm_squared() / left.nrows() as f64).sqrt();
                assert!(range.contains(&rms), "{design:?} {null:?} {role:?}: {rms} mm");
            }
        }
    }
    Ok(())
}

#[test]
fn the_command_writes_a_campaign_and_keeps_silent() -> Outcome {
    let folder = tempfile::tempdir()?;
    let run = |arguments: &[&str]| {
        assert_cmd::Command::cargo_bin("acm-data").map(|mut command| {
            let command = command.current_dir(folder.path()).arg("generate").args(arguments);
            command.output()
        })
    };
    let done = run(&["--undeclared", "5", "--design", "paper"])??;
    let said = String::from_utf8(done.stdout)?;
    assert!(done.status.success() && said.contains("undeclared-5: 17 synthetic trials"), "{said}");
    assert!(!said.contains(&draw(5).name()), "{said}");
    let read = Campaign::read(&folder.path().join("undeclared-5"), None)?;
    assert_eq!(read.trials, generate(5, Design::Paper, None)?.campaign.trials);
    let several = run(&["--undeclared", "14003", "--kind", "several3", "--out", "three"])??;
    assert!(several.status.success(), "{several:?}");
    let made = generate(14_003, Design::Rich, Some(Kind::Several(3)))?;
    assert_eq!(Campaign::read(&folder.path().join("three"), None)?.trials, made.campaign.trials);
    let unknown = ["--undeclared", "5", "--kind", "several7"];
    for refused in [&["--undeclared", "5", "--seed", "3"][..], &["--undeclared", "5", "--design", "poor"], &unknown] {
        assert_eq!(run(refused)??.status.code(), Some(2), "{refused:?}");
    }
    Ok(())
}
