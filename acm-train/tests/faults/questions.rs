//! Small questions of every engine that leaves a run folder, each with all its files in a temporary folder.

use std::{
    path::{Path, PathBuf},
    process::Command,
};

use crate::campaign::Campaign;

/// A question: its name and its file in the campaign's folder.
pub struct Question {
    /// One of [`NETWORKS`] or [`OTHERS`].
    pub name: &'static str,
    campaign: Campaign,
}

/// Networks.
pub const NETWORKS: [&str; 3] = ["mlp", "gru", "cfc"];
/// Everything else that runs.
pub const OTHERS: [&str; 8] =
    ["ridge", "boosted_trees", "ablation", "sweep", "halving", "sequences", "nominal", "residual"];

impl Question {
    /// The question of that name.
    pub fn new(name: &'static str) -> Self {
        let campaign = Campaign::new();
        let learner = match name {
            "mlp" => "[network]\nkind = \"mlp\"\nhidden = [4]",
            "cfc" => "[network]\nkind = \"cfc\"\nunits = 4\nbackbone_units = 6",
            "ridge" => "[baseline]\nkind = \"ridge\"",
            "boosted_trees" => "[baseline]\nkind = \"boosted_trees\"",
            _ => "[network]\nkind = \"gru\"\nunits = 4",
        };
        let training = if ["ridge", "boosted_trees"].contains(&name) { "" } else { TRAINING };
        // The planted campaign is of no arm, and the nominal model's study is about one.
        let twin = format!("{:?}", std::path::absolute("../datasets/acm-twin").unwrap());
        let head = if name == "nominal" { HEAD.replace("\"data\"", &twin) } else { HEAD.into() };
        campaign.write("base.toml", &format!("{head}\n{learner}\n{training}\n[protocol]\nseeds = [1, 2]\n"));
        let asked = match name {
            "ablation" => ABLATION.into(),
            "sweep" => SWEEP.into(),
            "halving" => SWEEP.replace("\"bayes\"", "\"halving\"\neta = 2"),
            "nominal" | "residual" => format!("study = \"{name}\"\nbase = \"base.toml\"\n"),
            "sequences" => SEQUENCES.into(),
            _ => std::fs::read_to_string(campaign.path("base.toml")).unwrap(),
        };
        campaign.write("asked.toml", &asked);
        Self { name, campaign }
    }

    /// A path below the question's folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.campaign.path(name)
    }

    /// `acm-train --config asked.toml --out <out> …`, not started yet.
    pub fn command(&self, program: &Path, out: &str, arguments: &[&str]) -> Command {
        let mut command = Command::new(program);
        command.current_dir(self.campaign.path("")).args(["--config", "asked.toml", "--out", out]).args(arguments);
        command
    }
}

const HEAD: &str = r#"
question = "Does it survive?"
data     = "data"
[inputs]
domain_filter = "none"
[windows]
length = 5
reach  = 5
"#;

const TRAINING: &str = "[training]\nepochs = 8\nbatch = 16\npatience = 8";

const ABLATION: &str = r#"
study    = "ablation"
question = "What does the wind tell?"
[[base]]
name       = "small"
experiment = "base.toml"
set.training.epochs = 4
[[variant]]
name = "all"
[[variant]]
name = "no wind"
set.inputs.channels = ["q1", "q2"]
"#;

const SWEEP: &str = r#"
study    = "sweep"
question = "Which size?"
[[base]]
name       = "gru"
experiment = "base.toml"
[set]
training.epochs           = 3
protocol.cross_validation = true
protocol.final            = false
protocol.seeds            = [3]
[sweep]
sampler = "bayes"
count   = 4
batch   = 2
[sweep.space]
"network.units"          = [2, 3, 5]
"training.learning_rate" = { low = 1e-4, high = 1e-1, log = true }
"#;

const SEQUENCES: &str = r#"
study    = "sequences"
question = "Is elapsed time at work?"
loss     = "cross_entropy"
seeds    = [1, 2]
[data]
kind     = "bit_stream_xor"
training = 400
test     = 100
length   = 6
step     = 0.5
[control]
epochs = 2
[network]
units          = 4
backbone_units = 6
[training]
epochs   = 6
batch    = 32
patience = 0
"#;
