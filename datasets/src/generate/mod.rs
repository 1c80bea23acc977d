//! Simulated rigs as data sets: what `acm_sim` simulates, with a manifest, in memory or as a folder.

pub mod small_rig;
