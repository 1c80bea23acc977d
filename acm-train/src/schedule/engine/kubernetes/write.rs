//! Writes the list of open runs and the manifest.

use std::path::Path;

use super::{job::Job, options::Options};
use crate::schedule::engine::slurm::array::list::Entry;
use crate::schedule::engine::slurm::array::submit::list;
use crate::schedule::engine::slurm::options::Options as Limits;
use crate::schedule::error::ScheduleError;
use crate::schedule::open::Planned;
use crate::schedule::request::Request;
use crate::store::{StoreError, atomic};

/// Writes the manifest of the open runs, and returns a text on how to use it.
///
/// # Errors
/// An option is missing, a path is not UTF-8, or the file system refuses.
pub fn write(
    options: &Options,
    limits: &Limits,
    planned: &Planned,
    request: &Request,
) -> Result<String, ScheduleError> {
    let (image, claim) = (needed("--image", &options.image)?, needed("--claim", &options.claim)?);
    let open = planned.open();
    let runs: Vec<Entry> = open.iter().map(|run| Entry::new(run)).collect::<Result<_, _>>()?;
    let folder = std::path::absolute(request.out)
        .map_err(|source| StoreError::io("find", request.out, source))?
        .join("kubernetes");
    atomic::make_folder(&folder)?;
    let number = (1..).find(|number| !folder.join(format!("{number:04}.json")).exists()).unwrap_or(1);
    let (json, yaml) = (folder.join(format!("{number:04}.json")), folder.join(format!("{number:04}.yaml")));
    list(limits.cap(), planned, request, &runs)?.write(&json)?;
    let directory =
        std::env::current_dir().map_err(|source| StoreError::io("find", "the current directory", source))?;
    let cpus = limits.cpus.map_or(1, usize::from);
    let program = limits.program.as_deref().unwrap_or(Path::new("acm-train"));
    let words = [text(program)?, "--task".into(), text(&json)?, "--threads".into(), cpus.to_string()];
    let job = Job {
        name: name(request.out, number),
        runs: runs.len(),
        parallelism: limits.array_limit.map_or(runs.len(), usize::from).min(runs.len()),
        attempts: limits.cap(),
        image,
        command: words.to_vec(),
        directory: text(&directory)?,
        claim,
        cpus,
        memory: limits.memory.clone(),
        queue: options.queue.clone(),
    };
    atomic::write(&yaml, job.yaml().as_bytes())?;
    Ok(format!(
        "{} runs are open. The job: {}\nSubmit it with kubectl apply -f, and call this command again when it has ended: with all \
         records there it prints the tables.",
        runs.len(),
        yaml.display()
    ))
}

fn needed(option: &str, value: &Option<String>) -> Result<String, ScheduleError> {
    value.clone().ok_or_else(|| ScheduleError::Usage {
        what: format!("--engine kubernetes needs {option}"),
        help: "write --image IMAGE, a container with acm-train, and --claim NAME, the volume that holds this directory"
            .into(),
    })
}

fn text(path: &Path) -> Result<String, ScheduleError> {
    path.to_str().map(Into::into).ok_or_else(|| ScheduleError::Usage {
        what: format!("{path:?} cannot stand in a manifest"),
        help: "use a folder whose path is UTF-8".into(),
    })
}

/// Returns a name as Kubernetes takes it: lower-case letters, digits and hyphens, 63 at most.
fn name(out: &Path, number: usize) -> String {
    let stem = out.file_name().map_or_else(String::new, |name| name.to_string_lossy().to_lowercase());
    let plain: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).take(40).collect();
    format!("acm-{}-{number:04}", plain.trim_matches('-'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_kubernetes() {
        assert_eq!(name(Path::new("runs/My sweep_2"), 3), "acm-my-sweep-2-0003");
    }
}
