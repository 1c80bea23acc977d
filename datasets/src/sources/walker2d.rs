//! Rollouts of a walking robot, a benchmark of irregular sequences (raminmh/CfC, folder `data/walker`, Apache-2.0).
//!
//! The repository has a file `rollout_<number>.npy` of states [T×17] each. Its program deals the files out to three parts and drops
//! steps at random, with numpy's generator and fixed seeds ([`FACTS`]); the same is done here:
//!
//! | column    | meaning                                                            |
//! | --------- | ------------------------------------------------------------------ |
//! | `rollout` | number of the file                                                 |
//! | `part`    | training, validation, test                                         |
//! | `k`       | step                                                               |
//! | `kept`    | 1 for what is seen; the last step has no successor and is not      |
//! | `s0…s16`  | state, in single precision as there                                |

mod numpy;

use std::path::{Path, PathBuf};

use serde::Deserialize;

use self::numpy::{RandomState, State, read};
use super::{Imported, Source};
use crate::error::DataError;
use crate::files::owned;
use crate::files::table::{Column, write_parquet};

/// The line of the list.
pub(super) const SOURCE: Source =
    Source { name: "walker2d", about: "rollouts of a walking robot; git clone https://github.com/raminmh/CfC", import };

/// Split, dropped steps and what comes of them.
const FACTS: &str = include_str!("../../walker2d/facts.toml");

/// Where the rollouts lie in the repository.
const FOLDER: &str = "data/walker";

/// The table that is written.
const TABLE: &str = "rollouts.parquet";

#[derive(Deserialize)]
struct Facts {
    rollouts: usize,
    states: usize,
    split: Split,
    drop: Dropped,
    counts: Counts,
}

#[derive(Deserialize)]
struct Split {
    seed: u32,
    test: f64,
    validation: f64,
}

#[derive(Deserialize)]
struct Dropped {
    seed: u32,
    kept: f64,
}

#[derive(Deserialize)]
struct Counts {
    training: Count,
    validation: Count,
    test: Count,
}

#[derive(Deserialize, PartialEq, Debug, Clone, Copy)]
struct Count {
    rollouts: usize,
    rows: usize,
    kept: usize,
}

/// A rollout in its part.
struct Rollout {
    name: String,
    part: &'static str,
    states: State,
    kept: Vec<bool>,
}

fn import(clone: &Path, out: &Path) -> Result<Imported, DataError> {
    let facts: Facts = toml::from_str(FACTS).map_err(|e| DataError::Usage(format!("facts of walker2d: {e}")))?;
    owned::claim(&out.join(TABLE), |_| false)?;
    let rollouts = rollouts(&files(clone, facts.rollouts)?, &facts)?;
    prove(&rollouts, &facts.counts)?;
    let table = table(&rollouts, facts.states);
    let rows = rollouts.iter().map(|rollout| rollout.kept.len()).sum();
    write_parquet(&out.join(TABLE), &table)?;
    Ok(vec![(TABLE.to_string(), rows)])
}

/// The files by name, in the clone or in the given folder.
fn files(clone: &Path, count: usize) -> Result<Vec<PathBuf>, DataError> {
    let places = [clone.join(FOLDER), clone.to_path_buf()];
    let all = |place: &PathBuf| (0..count).map(|n| place.join(format!("rollout_{n:03}.npy"))).collect::<Vec<_>>();
    if let Some(place) = places.iter().find(|place| all(place)[0].is_file()) {
        return Ok(all(place));
    }
    let line = |p: &PathBuf| {
        format!("  {}: {}\n", p.display(), if p.is_dir() { "no rollout_000.npy" } else { "no such folder" })
    };
    let obtain = "to obtain them: git clone https://github.com/raminmh/CfC".to_string();
    Err(DataError::MissingData { name: SOURCE.name.into(), places: places.iter().map(line).collect(), obtain })
}

/// Training rollouts first, in the order in which the files were dealt.
fn rollouts(files: &[PathBuf], facts: &Facts) -> Result<Vec<Rollout>, DataError> {
    let mut order: Vec<usize> = (0..files.len()).collect();
    RandomState::new(facts.split.seed).shuffle(&mut order);
    let count = |share: f64| (share * files.len() as f64) as usize;
    let (tested, both) = (count(facts.split.test), count(facts.split.test + facts.split.validation));
    let mut generator = RandomState::new(facts.drop.seed);
    let mut all = vec![];
    for (part, places) in
        [("training", &order[both..]), ("validation", &order[tested..both]), ("test", &order[..tested])]
    {
        for &place in places {
            let states = read(&files[place], facts.states)?;
            let mut kept: Vec<bool> = (1..states.rows).map(|_| generator.uniform() < facts.drop.kept).collect();
            kept.push(false);
            all.push(Rollout { name: format!("{place:03}"), part, states, kept });
        }
    }
    Ok(all)
}

/// Refuses rollouts that are not those of the benchmark.
fn prove(rollouts: &[Rollout], counts: &Counts) -> Result<(), DataError> {
    for (part, wanted) in [("training", counts.training), ("validation", counts.validation), ("test", counts.test)] {
        let of = || rollouts.iter().filter(|rollout| rollout.part == part);
        let kept = of().flat_map(|rollout| &rollout.kept).filter(|kept| **kept).count();
        let found = Count { rollouts: of().count(), rows: of().map(|rollout| rollout.kept.len()).sum(), kept };
        if found != wanted {
            return Err(DataError::Usage(format!(
                "the {part} part has {found:?}, and that of the benchmark {wanted:?}: take the rollouts as published, at commit 59f6e01f"
            )));
        }
    }
    Ok(())
}

fn table(rollouts: &[Rollout], states: usize) -> Vec<(String, Column)> {
    let text = |of: &dyn Fn(&Rollout) -> String| {
        Column::Text(rollouts.iter().flat_map(|one| std::iter::repeat_n(of(one), one.kept.len())).collect())
    };
    let number = |of: &dyn Fn(&Rollout, usize) -> f64| {
        Column::Number(rollouts.iter().flat_map(|one| (0..one.kept.len()).map(move |k| of(one, k))).collect())
    };
    let mut columns = vec![
        ("rollout".to_string(), text(&|one| one.name.clone())),
        ("part".to_string(), text(&|one| one.part.to_string())),
        ("k".to_string(), number(&|_, k| k as f64)),
        ("kept".to_string(), number(&|one, k| f64::from(u8::from(one.kept[k])))),
    ];
    columns.extend((0..states).map(|s| (format!("s{s}"), number(&|one, k| one.states.values[k * states + s]))));
    columns
}
