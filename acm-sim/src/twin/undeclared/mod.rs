//! Campaigns with undeclared mechanisms, to test searches for effects.
//!
//! ```text
//! seed → deck → kind → draft (all but the size) ─┐
//! seed → design → courses ───────────────────────┼→ size → quiet arm + mechanism → trials, manifest | sealed truth
//! ```
//!
//! The arm is the full campaign's rod without its memory and its wind, so that the mechanism is all that a calibrated
//! nominal model lacks, but for a few millimetres. No mechanism has the formula of the effect that should be found for
//! it: contact is soft, lags have two poles, creep is a power law, jets decay.

mod amiss;
pub mod course;
mod deck;
pub mod design;
mod draft;
mod generate;
mod kind;
mod mechanism;
mod mechanisms;
mod quiet;
mod separable;
mod several;
mod simulate;
mod truth;

pub use deck::draw;
pub use design::Design;
pub use generate::{Undeclared, UndeclaredTrial, generate, generate_without_noise};
pub use kind::{ALL_NULLS, Cause, INSIDE, Kind, MOST, NULLS, Null, OUTSIDE, PAIRS};
pub use truth::{Class, Parameter, Since, TrueEffect, Truth};
