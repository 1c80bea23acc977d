//! Options of the command line for Kubernetes.

use clap::Args;

/// Options of `--engine kubernetes`; those of Slurm for processors, memory, runs at a time and attempts hold here too.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
#[command(next_help_heading = "With --engine kubernetes")]
pub struct Options {
    /// Image of the container, with this program in it.
    #[arg(long, value_name = "IMAGE")]
    pub image: Option<String>,

    /// Claim of the volume that holds the current directory, mounted at its path.
    #[arg(long, value_name = "NAME")]
    pub claim: Option<String>,

    /// Queue of Kueue that admits the job.
    #[arg(long, value_name = "NAME")]
    pub queue: Option<String>,
}

impl Options {
    /// Returns the first option that was given, as it is written.
    pub fn given(&self) -> Option<&'static str> {
        let given =
            [("--image", self.image.is_some()), ("--claim", self.claim.is_some()), ("--queue", self.queue.is_some())];
        given.into_iter().find_map(|(name, given)| given.then_some(name))
    }
}
