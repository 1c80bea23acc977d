//! Files that a run leaves and a later step reads, each with its reader: what is to be mutated.

use std::{
    fmt::Display,
    fs,
    path::{Path, PathBuf},
};

use acm_models::{Keep, Network};
use acm_train::config::{self, device};
use acm_train::learn::checkpoint::{self, Identity};
use acm_train::learn::{Scalers, Task};
use acm_train::run::data::scored::Scored;
use acm_train::run::nominal::group;
use acm_train::run::progress::Progress;
use acm_train::run::record::{read_nominal, read_record};
use acm_train::run::{sequences, stop};
use acm_train::schedule::ready::{Campaigns, Ready};
use acm_train::schedule::request::{Engine, Request};
use acm_train::schedule::study;
use acm_train::store::hashed;

use crate::faults::questions::{NETWORKS, Question};

/// What a reader makes of a file, in words that differ where the content differs; or its message.
pub type Reader = Box<dyn Fn(&Path) -> Result<String, String>>;

/// A file with its reader.
pub struct Saved {
    /// `cfc checkpoint`.
    pub name: String,
    /// Where it lies in its folder; the reader is given such a path.
    pub file: PathBuf,
    /// As it was written.
    pub bytes: Vec<u8>,
    /// What reads it.
    pub read: Reader,
}

/// Checkpoint, record, calibrations and predictions of each kind of network, and the records of studies and sequences.
pub fn all(program: &Path) -> Vec<Saved> {
    let mut all = vec![];
    for name in NETWORKS {
        let question = run(name, program);
        all.push(checkpoint(&question));
        all.push(saved(&question, "record", "records/final-seed1.json", |path| {
            read_record(path).map(|record| format!("{record:?}"))
        }));
        all.push(saved(&question, "nominal", "nominal.json", |path| {
            read_nominal(path.parent().unwrap()).map(|record| format!("{record:?}"))
        }));
        let table = question.path("out/predictions/final-seed1.parquet");
        let noted = hashed::of_file(&table).unwrap();
        all.push(saved(&question, "predictions", "predictions/final-seed1.parquet", move |path| {
            hashed::same_file(path, &noted, Path::new("records/final-seed1.json")).map(|()| "the same".into())
        }));
    }
    let ablation = run("ablation", program);
    all.push(saved(&ablation, "study", "study.json", |path| {
        let known = acm_train::run::record::FORMAT;
        hashed::read::<study::record::StudyRecord>(path, known).map(|record| format!("{record:?}"))
    }));
    let sequences = run("sequences", program);
    all.push(saved(&sequences, "study", "study.json", |path| {
        sequences::record::read_study(path).map(|record| format!("{record:?}"))
    }));
    all.push(saved(&sequences, "record", "records/measured-seed1.json", |path| {
        sequences::record::read(path).map(|record| format!("{record:?}"))
    }));
    all
}

/// A question whose run has come to its end, in `out`.
fn run(name: &'static str, program: &Path) -> Question {
    let question = Question::new(name);
    let output = question.command(program, "out", &["--quiet"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    question
}

fn saved<E: Display>(
    question: &Question,
    what: &str,
    file: &str,
    read: impl Fn(&Path) -> Result<String, E> + 'static,
) -> Saved {
    let bytes = fs::read(question.path("out").join(file)).unwrap();
    let read = move |path: &Path| read(path).map_err(|error| error.to_string());
    Saved { name: format!("{} {what}", question.name), file: file.into(), bytes, read: Box::new(read) }
}

/// The checkpoint with what a resumed fit holds against it.
fn checkpoint(question: &Question) -> Saved {
    let (experiment, source) = config::read(&question.path("asked.toml"), &[]).unwrap();
    let (progress, stop, out) = (Progress::Quiet, stop::Stop::default(), question.path("out"));
    let (data, jobs, threads) = (None, None, None);
    let request = Request {
        data,
        out: &out,
        resume: true,
        jobs,
        threads,
        engine: &Engine::Local,
        progress: &progress,
        stop: &stop,
    };
    let ready = Ready::new(experiment, &source, &request, &mut Campaigns::default()).unwrap();
    let (plan, asked) = (&ready.plans[0], &ready.experiment.windows);
    let (setting, outputs) = (ready.setting(), ready.data.manifest.output_names().len());
    let pair = &ready.nominal.calibrations[&group(&ready.data.manifest, plan)];
    let training = Scored::new(&setting, pair, &plan.split.training, asked.stride).unwrap();
    let validation = Scored::new(&setting, pair, &plan.split.validation, asked.evaluation_stride).unwrap();
    let scalers = Scalers::of_each(|see| training.each(see)).unwrap();
    let training = training.training_examples(&scalers).unwrap();
    let validation = validation.scored_examples(&scalers).unwrap();
    let device = device("flex").unwrap();
    let task = Task {
        network: &ready.experiment.network,
        training: &ready.experiment.training,
        supervise: Keep::Last,
        seed: plan.seed,
        device: &device,
    };
    let identity = Identity::new(&task, &*training, Some(&*validation));
    let network = Network::new(task.network, ready.channels.len(), outputs, 1, &device);
    let file = format!("checkpoints/{}.safetensors", plan.id);
    saved(question, "checkpoint", &file, move |path| {
        let read = checkpoint::read(path, &identity, &network);
        read.map(|progress| format!("{:?}", progress.expect("there is a file")))
    })
}
