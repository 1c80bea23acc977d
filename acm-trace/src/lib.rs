//! Traces the residual of a nominal model to physical effects that the model lacks.
//!
//! | module | contents |
//! | --- | --- |
//! | [`case`], [`prepared`], [`series`], `covered`, `nominal_fit`, `options` | rig, trials and nominal model, and their preparation |
//! | [`fit`] | variable projection of effects and nominal correction, cross-validation, intervals |
//! | [`search`] | beam search over effects: candidates, surrogates, confidence |
//! | [`trace`], `baselines`, `assemble`, `agreement` | from a prepared case to the models that are compared, and a check of the one that is saved |
//! | [`holdout`] | held-out trials, and the evaluation of the result on them |
//! | [`diagnose`] | diagnosis of the remaining residual |
//! | [`finding`], [`close`] | the whole procedure and its result, in numbers and words |
//! | [`separability`] | effects that the given trials cannot distinguish, and experiments that would |
//!
//! Begin with [`close::close`], which takes a [`case::Case`] and a [`holdout::Holdout`] and returns a [`finding::Finding`]. The
//! crate reads no files and draws no pages.

mod agreement;
mod assemble;
mod baselines;
pub mod case;
pub mod close;
mod covered;
pub mod diagnose;
pub mod finding;
pub mod fit;
pub mod holdout;
mod nominal_fit;
mod options;
pub mod prepared;
pub mod search;
pub mod separability;
pub mod series;
mod tall;
pub mod trace;

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
