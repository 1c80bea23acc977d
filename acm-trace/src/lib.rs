//! Traces what a nominal model misses to a physical effect that it lacks.
//!
//! | module | what |
//! | --- | --- |
//! | [`case`] | what is to be explained: a rig, its nominal model, recordings in three parts |
//! | [`series`], [`setup`], [`evaluate`] | trials, prepared; residuals under effects, and their slopes |
//! | [`normal`], `equations`, `descent`, [`fit`] | fits of effects and calibration, with blocks left out |
//! | [`ground`] | the nominal model before any effect: calibration, static map, precision |
//! | [`prepared`], [`moving`], `moves`, [`rules`], [`search`], [`trace`] | which effects the model lacks |
//! | [`judge`], [`verdict`], [`intervals`], [`experiment`], [`sentence`], [`title`], [`figures`], [`close`] | what may be concluded, and how it is said |
//! | [`remainder`], [`noise_floor`] | what a model leaves, trial by trial |
//! | [`probe`], [`autocorrelation`] | whether inputs predict what is left, and whether it is noise |
//! | [`symbolic`] | a sparse formula for what no known effect explains |
//! | [`events`] | a slip, a spectral line, offsets: what does not carry over between trials |
//! | [`separability`] | what these trials cannot tell apart, and the experiment that would |
//! | [`finding`] | the result, as it is written to `loop.json` |
//!
//! Arrays in, a finding out: nothing here knows files, tables or pages.

pub mod autocorrelation;
pub mod case;
pub mod close;
mod descent;
mod equations;
pub mod evaluate;
pub mod events;
pub mod experiment;
mod features;
pub mod figures;
pub mod finding;
pub mod fit;
mod found;
pub mod ground;
pub mod intervals;
mod joining;
pub mod judge;
mod library;
mod moves;
pub mod moving;
pub mod noise_floor;
pub mod normal;
mod offset;
pub mod prepared;
pub mod probe;
mod random;
pub mod remainder;
pub mod rules;
mod samples;
pub mod search;
pub mod sentence;
pub mod separability;
pub mod series;
pub mod setup;
mod slip;
mod spectral_line;
mod start;
pub mod symbolic;
mod tall;
pub mod title;
pub mod trace;
pub mod verdict;
