//! The estimator against the batch path, against its equations, and on samples that cannot be taken.

mod average;
mod batch;
mod by_hand;
mod equations;
mod nominal;
mod refusals;
mod robots;
