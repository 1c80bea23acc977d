//! Search for effects that a model lacks: candidates, their cross-validated errors, and their acceptance.
//!
//! ```text
//! J = ln(CV / CV₀ + ε) + Σ price,   accepted where J falls, paired t over blocks > t₀, and gain > the 99 % quantile of the
//! largest gain of any candidate on surrogates
//! ```
//!
//! | file | what |
//! | --- | --- |
//! | [`criteria`] | every constant, with what it rests on |
//! | [`candidates`] | effects that may be added, with values to begin with |
//! | [`scan`] | their cross-validated errors |
//! | [`expand`] | all candidates of a state, the best refined |
//! | [`accept`] | when one of them counts |
//! | `accept::imitation` | when one stands for something else |
//! | `accept::start` | what an unknown start of each trial explains by itself |
//! | [`chance`] | what the best of them gains by chance, on residuals with random phases |
//! | [`nuisance`] | degree and ridge of the nominal form |
//! | `nuisance::held` | actuators that are held at a few values |
//! | `smoothed` | what smoother actuators explain |
//! | `scored`, `tried`, `step` | a search on its way, what it tries, what it tells |
//! | [`select`] | the search itself |
//! | `select::pairs` | effects that are proven beside a second one alone |
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
