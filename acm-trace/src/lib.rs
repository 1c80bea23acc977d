//! Traces what a nominal model misses to a physical effect that it lacks.
//!
//! | room | what |
//! | --- | --- |
//! | [`case`], [`prepared`], [`series`], `nominal_fit`, `options` | what is to be explained, made ready |
//! | [`fit`] | effects and nominal form as a regression: variable projection, blocks left out, intervals |
//! | [`search`] | which effects the model lacks: candidates, surrogates, beam, confidence |
//! | [`trace`], `baselines`, `assemble` | from a prepared case to the models that are compared |
//! | [`holdout`] | trials that no search can see, and what they say of the result |
//! | [`diagnose`] | what is left |
//! | [`finding`], [`close`] | the result, in numbers and words |
//! | [`separability`] | what these trials cannot tell apart, and the experiment that would |
//!
//! Arrays in, a finding out: nothing here knows files, tables or pages.

mod assemble;
mod baselines;
pub mod case;
pub mod close;
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
