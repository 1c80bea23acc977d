//! Diagnosis of the residual: noise level, predictability by inputs, events, autocorrelation, formula.
//!
//! | file | what |
//! | --- | --- |
//! | [`residuals`], [`remainder`] | what a state leaves on blocks left out, trial by trial |
//! | [`noise_floor`], [`autocorrelation`] | white noise, and whether it is white |
//! | [`probe`], [`recurrent`] | whether recorded inputs with memory predict it: by regression, by a recurrent network |
//! | [`followed`] | whether the residual follows what an effect does: its form is not quite right |
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
