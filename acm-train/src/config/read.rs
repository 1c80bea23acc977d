//! Reading of an experiment file to [`Experiment`], or an error that underlines the key.

use std::path::{Path, PathBuf};

use acm_datasets::text::spelling::meant;
use acm_models::NetworkConfig;
use toml::{Table, Value};

use super::error::ConfigError;
use super::experiment::Experiment;
use super::memory::name_the_default_memory;
use super::parse::decode::decode;
use super::parse::source::Source;
use super::validate::faults;

/// Reads an experiment file, applies the edits of the command line, and checks every value.
///
/// # Errors
/// Anything that is unreadable, unknown, of a wrong type, not finite, or out of bounds; with its place and a remedy.
pub fn read(file: &Path, edits: &[String]) -> Result<(Experiment, Source), ConfigError> {
    let mut source = Source::read(file, edits)?;
    Ok((of_source(&mut source)?, source))
}

/// Reads the experiment from `source`, and checks it.
///
/// # Errors
/// As [`read`].
pub fn of_source(source: &mut Source) -> Result<Experiment, ConfigError> {
    name_the_default_network(&mut source.tree);
    name_the_default_memory(&mut source.tree);
    let experiment = decode(source, "acm-train --help")?;
    source.refuse_first(faults(&experiment))?;
    Ok(experiment)
}

/// Finds the folder that `path` names: from the current directory, else from the experiment file's folder or one above
/// it; `~` is the user's home, since no shell puts it in behind `data=`. A folder with a manifest precedes others.
pub fn find_folder(path: &Path, file: &Path) -> Option<PathBuf> {
    find_folder_with(path, file, |folder| folder.join("manifest.toml").exists())
}

/// As [`find_folder`], where a folder that `has` the data precedes others.
pub fn find_folder_with(path: &Path, file: &Path, has: impl Fn(&Path) -> bool) -> Option<PathBuf> {
    find(path, file, |folder| folder.is_dir() && has(folder)).or_else(|| find(path, file, Path::is_dir))
}

/// Finds the file that `path` names, as a folder is found ([`find_folder`]).
pub fn find_file(path: &Path, file: &Path) -> Option<PathBuf> {
    find(path, file, Path::is_file)
}

fn find(path: &Path, file: &Path, there: impl Fn(&Path) -> bool) -> Option<PathBuf> {
    let path = &at_home(path);
    let above = std::path::absolute(file).unwrap_or_else(|_| file.into());
    let places = std::iter::once(Path::new("")).chain(above.ancestors().skip(1));
    places.map(|place| place.join(path)).find(|found| there(found))
}

fn at_home(path: &Path) -> PathBuf {
    let below = path.strip_prefix("~").ok();
    below.zip(std::env::home_dir()).map_or_else(|| path.into(), |(below, home)| home.join(below))
}

/// Names the default kind in a `[network]` without one, like any other field that is left out.
pub fn name_the_default_network(tree: &mut Table) {
    if let Some(Value::Table(network)) = tree.get_mut("network") {
        // a misspelling is reported as such, and not as a field that another network does not have
        if meant("kind", network.keys().map(String::as_str)).is_none() {
            network.insert("kind".into(), Value::String(NetworkConfig::default().kind().into()));
        }
    }
}
