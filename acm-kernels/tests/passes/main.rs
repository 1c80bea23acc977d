//! The passes against equations, finite differences, torch's numbers, and themselves on other levels and threads.

mod around;
mod cases;
mod equations;
mod golden;
mod gradients;
mod steps;
mod threads;
mod values;
