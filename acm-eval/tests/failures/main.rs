//! Black-box tests of the classes of failure that an earlier state of the program (bbce5cc) had, as listed in
//! `book/src/failures.md`. Each test records a small rig by a formula of its own, as CSV with a manifest, runs
//! `acm-eval close-loop` on it, and reads `loop.json`.
//!
//! ```sh
//! cargo test -p acm-eval --test failures                                        # this program
//! ACM_EVAL_UNDER_TEST=/path/to/acm-eval cargo test -p acm-eval --test failures  # another one
//! ```

mod closed;
mod motion;
mod rig;

mod degree;
mod dependence;
mod handed_out;
mod held_out;
mod intervals;
mod joints;
mod lags;
mod memory;
mod noise;
mod nonlinear;
mod offsets;
mod quantised;
mod record;
mod small;
mod times;
