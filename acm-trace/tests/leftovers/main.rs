//! What a model leaves: planted structure is found, noise is not, and no bit depends on threads.

mod autocorrelation;
mod campaign;
mod events;
mod followed;
mod noise_floor;
mod probe;
mod recurrent;
mod symbolic;
