//! From a case to a finding, on small campaigns whose truth was planted: every verdict, every kind of rig.

mod bench;
mod dynamics;
mod effects;
mod intervals;
mod laboratory;
mod model;
mod motion;
mod own;
mod pairs;
mod plants;
mod rigs;
mod starts;
mod verdicts;
