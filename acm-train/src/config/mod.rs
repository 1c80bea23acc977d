//! Configuration: experiment files, from text to plain structs, with every fault traced to its place.

mod baseline;
mod complaint;
mod decode;
mod device;
mod error;
mod experiment;
mod fault;
mod loss;
mod network;
mod optimizer;
mod output_layer;
mod question;
mod read;
mod schedule;
mod source;
mod study;
mod text;
mod training;
mod validate;

pub use baseline::{Baseline, RidgeConfig, TreesConfig};
pub use complaint::Complaint;
pub use decode::decode;
pub use device::{DeviceError, NAMES as DEVICES, device};
pub use error::ConfigError;
pub use experiment::{Elapsed, Experiment, Inputs, Nominal, NominalKind, Protocol, Target, Windows};
pub use fault::{Fault, TrainingFault};
pub use loss::Loss;
pub use network::{Corrected, ExperimentNetwork};
pub use optimizer::OptimizerKind;
pub use output_layer::OutputLayer;
pub use question::{
    Control as QuestionControl, Data as QuestionData, Persistence, Question, Scale, read as read_question,
};
pub use read::{find_file, find_folder, name_the_default_network, of_source, read};
pub use schedule::Schedule;
pub use source::{Edits, Source};
pub use study::{Kind, kind};
pub use training::{Imported, TrainingConfig};
pub use validate::{CORRECTS_NO_ARM, CORRECTS_NO_ARM_HELP, network_fault, nominal as nominal_faults};
