//! Diagnosis of the residual: noise level, predictability by inputs, events, autocorrelation, formula.
//!
//! | file | what |
//! | --- | --- |
//! | [`residuals`], [`remainder`] | residuals of a state on blocks left out, trial by trial |
//! | [`noise_floor`], [`autocorrelation`] | level of white noise, and whether the residual is white |
//! | [`probe`], [`recurrent`] | whether recorded inputs with memory predict it: by regression, by a recurrent network |
//! | [`followed`] | whether an effect predicts the residual: then its form is not quite right |
//! | [`events`] | a slip, a spectral line, offsets of trials |
//! | [`symbolic`] | a sparse formula |

pub mod autocorrelation;
pub mod events;
pub mod followed;
mod library;
pub mod noise_floor;
pub mod probe;
mod random;
mod readout;
pub mod recurrent;
pub mod remainder;
pub mod residuals;
mod samples;
mod shifted;
pub mod symbolic;
