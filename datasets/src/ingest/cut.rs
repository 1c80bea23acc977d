//! `[cut."trial"]`: a trial is cut by time into trials of its own, `trial:head` and `trial:tail`.

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::DataError;
use crate::manifest::{Manifest, Part, Role};
use crate::toml_file::TomlSource;
use crate::trial::Trial;

/// A trial with its role, or the parts that the manifest cuts it into.
pub(crate) fn roles_and_parts(
    manifest: &Manifest,
    source: &TomlSource,
    roles: &BTreeMap<&str, Role>,
    mut trial: Trial,
    problems: &mut Vec<DataError>,
) -> Vec<Trial> {
    let mut all = match manifest.cut.get(&trial.name) {
        Some(parts) => cut(&trial, parts, source, problems),
        None => {
            trial.role = roles.get(trial.name.as_str()).copied().unwrap_or(trial.role);
            problems.extend(check_role(manifest, source, roles, &trial.name, &trial.file));
            vec![trial]
        }
    };
    all.iter_mut().for_each(|trial| set_conditions(manifest, trial));
    all
}

/// A trial that cannot be read needs a role all the same.
pub(crate) fn check_role(
    manifest: &Manifest,
    source: &TomlSource,
    roles: &BTreeMap<&str, Role>,
    trial: &str,
    file: &Path,
) -> Option<DataError> {
    let named = manifest.cut.contains_key(trial) || roles.contains_key(trial);
    let (manifest, file) = (source.path.clone(), file.to_path_buf());
    (!named).then(|| DataError::TrialWithoutRole { manifest, trial: trial.to_string(), file })
}

/// The parts in the order of their ends; a sample at `until` belongs to the next part.
fn cut(
    trial: &Trial,
    parts: &BTreeMap<String, Part>,
    source: &TomlSource,
    problems: &mut Vec<DataError>,
) -> Vec<Trial> {
    let mut parts: Vec<(&String, &Part)> = parts.iter().collect();
    let end = |part: &Part| part.until.unwrap_or(f64::INFINITY);
    parts.sort_by(|a, b| end(a.1).total_cmp(&end(b.1)));
    let mut cut = Vec::new();
    let mut start = 0;
    for (name, part) in parts {
        let stop = start + trial.time[start..].partition_point(|t| *t < end(part));
        if start == stop {
            let at = source.place(&["cut", &trial.name, name]);
            let (from, to) = (trial.time.first().copied().unwrap_or(0.0), trial.time.last().copied().unwrap_or(0.0));
            let (trial, part) = (format!("{}:{name}", trial.name), "in this part");
            problems.push(DataError::EmptyPart { at, trial, samples: 0, part, from, to });
        }
        let mut piece = trial.select_with_past(start..stop);
        piece.name = format!("{}:{name}", trial.name);
        piece.role = part.role.unwrap_or(Role::Excluded);
        if start > 0 {
            piece.dropped.clear(); // counted once, with the first part
        }
        cut.push(piece);
        start = stop;
    }
    cut
}

/// A part has the conditions of its trial, and its own on top.
fn set_conditions(manifest: &Manifest, trial: &mut Trial) {
    let whole = trial.name.rsplit_once(':').map(|(whole, _)| whole).filter(|w| manifest.cut.contains_key(*w));
    for name in whole.into_iter().chain([trial.name.as_str()]) {
        for (condition, quantity) in manifest.conditions.get(name).into_iter().flatten() {
            trial.conditions.insert(condition.clone(), quantity.si());
        }
    }
}
