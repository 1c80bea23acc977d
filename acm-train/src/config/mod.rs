//! Configuration: experiment files, from text to plain structs, with every fault traced to its place.

mod baseline;
mod error;
mod experiment;
mod memory;
mod network;
mod parse;
mod question;
mod read;
mod study;
mod training;
mod validate;

/// Devices are those of the networks.
pub use acm_models::{DeviceError, device};

pub use baseline::{Baseline, RidgeConfig, TreesConfig};
pub use error::ConfigError;
pub use experiment::{Elapsed, Experiment, Inputs, Nominal, NominalKind, Protocol, Target, Windows};
pub use memory::{Memory, State};
pub use network::{Corrected, ExperimentNetwork};
pub use parse::complaint::Complaint;
pub use parse::decode::decode;
pub use parse::fault::{Fault, TrainingFault};
pub use parse::source::{Edits, Source};
pub use question::{
    Control as QuestionControl, Data as QuestionData, Persistence, Question, Scale, read as read_question,
};
pub use read::{find_file, find_folder, find_folder_with, name_the_default_network, of_source, read};
pub use study::{Kind, kind};
pub use training::loss::Loss;
pub use training::optimizer::OptimizerKind;
pub use training::output_layer::OutputLayer;
pub use training::schedule::Schedule;
pub use training::{Imported, TrainingConfig};
pub use validate::{CORRECTS_NO_ARM, CORRECTS_NO_ARM_HELP, network_fault, nominal as nominal_faults};
