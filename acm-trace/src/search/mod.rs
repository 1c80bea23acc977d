//! Search for effects that a model lacks: candidates, their cross-validated errors, and their acceptance.
//!
//! ```text
//! J = ln(CV / CV₀ + ε) + Σ price,   accepted where J falls, paired t over blocks > t₀, and gain > the 99 % quantile of the
//! largest gain of any candidate on surrogates
//! ```
//!
//! | file | what |
//! | --- | --- |
//! | [`criteria`] | criteria for accepting an effect |
//! | [`candidates`] | effects that may be added, with initial values |
//! | [`scan`] | their cross-validated errors |
//! | [`expand`] | all candidates of a state, the best refined |
//! | [`accept`] | tests of a candidate |
//! | `accept::imitation` | whether one imitates something else |
//! | `accept::start` | part that an unknown initial state explains |
//! | [`chance`] | largest gain by chance, on residuals with random phases |
//! | [`nuisance`] | degree and ridge of the nominal form |
//! | `nuisance::held` | actuators that are held at a few values |
//! | `smoothed` | errors with smoother actuators |
//! | `scored`, `tried`, `step` | state of a search, what it tries, its steps |
//! | [`select`] | beam search |
//! | `select::pairs` | effects that are proven only with a second one |
//! | `settle` | drops, exchanges, splits and kinks at its end |
//! | `settle::minor` | effects that predict better beside those that are named |
//! | [`confidence`] | how often an effect is chosen again |

pub mod accept;
pub mod candidates;
pub mod chance;
pub mod confidence;
pub mod criteria;
pub mod expand;
pub mod nuisance;
pub mod scan;
mod scored;
pub mod select;
mod settle;
mod smoothed;
mod step;
mod tried;
